"""The short wind that every importer drives: a ramp to 30 rad/s, the nozzle following the turns.

The step is a power of two and a whole number of nanoseconds, so that communication points are the
same in importers that count time in seconds and in those that count nanoseconds.
"""

STEP = 2.0**-9
STEPS = 40
SCENE = "fig8"
OUTPUTS = (
    "spindle_angle",
    "wire_tension",
    "wire_tension_min",
    "wire_tension_max",
    "spindle_torque",
    "fed_length",
    "feed_speed",
    "free_length",
    "layon_position",
    "layon_angle",
    "turns_wound",
)
"""Outputs of type Real that move during the wind."""

RAMP_STEPS = 54
"""Steps of the quarter turn over which the speed rises."""
SPEED = 30.0
PITCH = 0.7e-3


def inputs_at(k):
    """Inputs held over step k, from 0: mean speed, rad/s, and nozzle position at its end, m."""
    share = min((k + 0.5) / RAMP_STEPS, 1.0)
    turns = 0.25 * min((k + 1) / RAMP_STEPS, 1.0) ** 2
    return {"spindle_speed": SPEED * share, "nozzle_position": PITCH * turns}


def as_text(value):
    """A float with all its bits."""
    return float(value).hex()
