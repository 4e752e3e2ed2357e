"""A traverse drive as an FMU: a carriage that lags behind the place which the spindle's angle asks for."""

import math

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class TraverseDrive(Fmi2Slave):
    """Follows `pitch` a turn with a bandwidth and a largest speed."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.pitch, self.start_position = 0.7e-3, 0.0
        self.bandwidth, self.speed_limit = 200.0, 0.2
        self.spindle_angle = 0.0
        self.position = 0.0
        for name in ("pitch", "start_position", "bandwidth", "speed_limit"):
            self.register_variable(
                Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed)
            )
        self.register_variable(Real("spindle_angle", causality=Fmi2Causality.input, start=0.0))
        self.register_variable(Real("position", causality=Fmi2Causality.output))

    def exit_initialization_mode(self):
        self.position = self.start_position

    def do_step(self, current_time, step_size):
        target = self.start_position + self.pitch * self.spindle_angle / (2 * math.pi)
        # a first-order lag over the step, exactly
        way = (target - self.position) * -math.expm1(-self.bandwidth * step_size)
        most = self.speed_limit * step_size
        self.position += max(-most, min(most, way))
        return True
