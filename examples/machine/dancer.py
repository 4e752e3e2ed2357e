"""A dancer as an FMU: a sprung arm that sets the tension, and a reel whose motor holds the arm in its place by PI control."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

SUBSTEP = 2e-5
"""Longest step of the dancer's own equations, s."""


class Dancer(Fmi2Slave):
    """The arm holds a loop of wire: it gives twice its way, and pulls half of its force."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.force, self.stiffness = 30.0, 400.0
        self.gain, self.integral_gain, self.reel_lag = 60.0, 900.0, 5e-3
        self.wire_let_go = 0.0
        self.tension, self.position, self.reel_speed = 15.0, 0.0, 0.0
        self._reeled = self._sum = 0.0
        for name in ("force", "stiffness", "gain", "integral_gain", "reel_lag"):
            self.register_variable(
                Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed)
            )
        self.register_variable(Real("wire_let_go", causality=Fmi2Causality.input, start=0.0))
        for name in ("tension", "position", "reel_speed"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        count = max(1, round(step_size / SUBSTEP))
        dt = step_size / count
        for _ in range(count):
            self.position = 0.5 * (self.wire_let_go - self._reeled)
            self._sum += self.position * dt
            wanted = self.gain * self.position + self.integral_gain * self._sum
            self.reel_speed += dt * (wanted - self.reel_speed) / self.reel_lag
            self._reeled += dt * self.reel_speed
        self.tension = max(0.0, 0.5 * (self.force + self.stiffness * self.position))
        return True
