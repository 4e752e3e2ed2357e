"""A spindle drive as an FMU: inertia, a torque limit, and a PI controller of the speed."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

SUBSTEP = 2e-5
"""Longest step of the drive's own equation, s."""


class SpindleDrive(Fmi2Slave):
    """Turns the core up an even ramp to `top_speed`, against the moment of the wire."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.top_speed, self.ramp_time = 100.0, 0.06
        self.inertia, self.torque_limit = 2e-4, 0.5
        self.gain, self.integral_gain = 0.05, 2.0
        self.wire_torque = 0.0
        self.speed = self.torque = self.setpoint = 0.0
        self._sum = 0.0
        for name in ("top_speed", "ramp_time", "inertia", "torque_limit", "gain", "integral_gain"):
            self.register_variable(
                Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed)
            )
        self.register_variable(Real("wire_torque", causality=Fmi2Causality.input, start=0.0))
        for name in ("speed", "torque", "setpoint"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        count = max(1, round(step_size / SUBSTEP))
        dt = step_size / count
        for k in range(1, count + 1):
            self.setpoint = self.top_speed * min((current_time + k * dt) / self.ramp_time, 1.0)
            error = self.setpoint - self.speed
            wanted = self.gain * error + self.integral_gain * (self._sum + error * dt)
            self.torque = max(-self.torque_limit, min(self.torque_limit, wanted))
            # at its limit the controller does not wind up
            if self.torque == wanted:
                self._sum += error * dt
            self.speed += dt * (self.torque + self.wire_torque) / self.inertia
        return True
