"""Input signals of a winding run, shared by tests and scripts."""

import math

import numpy as np

RAMP_TURNS = 0.25
"""Turns over which the spindle speed rises."""


def core_angle(time, speed, ramp_turns=RAMP_TURNS):
    """Core angle, rad, at a time, s: constant acceleration over `ramp_turns`, then `speed`, rad/s."""
    ramp_angle = 2 * math.pi * ramp_turns
    ramp_time = 2 * ramp_angle / speed
    if time < ramp_time:
        return ramp_angle * (time / ramp_time) ** 2
    return ramp_angle + speed * (time - ramp_time)


def duration(speed, turns, ramp_turns=RAMP_TURNS):
    """Time, s, until `turns` turns of the core are done."""
    ramp_angle = 2 * math.pi * ramp_turns
    return 2 * ramp_angle / speed + (2 * math.pi * turns - ramp_angle) / speed


def winding_signals(speed, turns, pitch, y0, n, tension=None):
    """`n` equal steps of a winding run: speed ramp over a quarter turn, then `speed`, rad/s; the
    nozzle advances by `pitch`, m, per turn of the core from `y0`, m. With a `tension`, N, there is a
    constant setpoint too.

    Returns a structured array of n + 1 samples with the fields time (s), spindle_speed (rad/s),
    nozzle_position (m), and tension_setpoint (N) if there is one. Time is k * step exactly, so that
    a sample lies on every communication point of that step. A value is held over the step that
    starts at its sample; the speed is therefore the mean over the step, which keeps the core angle
    at the end of each step exact, and the nozzle position is the one to be reached at the step's
    end.
    """
    step = duration(speed, turns) / n
    time = np.arange(n + 1) * step
    angle = np.array([core_angle(t, speed) for t in np.append(time, time[-1] + step)])
    names = ["time", "spindle_speed", "nozzle_position"]
    if tension is not None:
        names.append("tension_setpoint")
    signals = np.zeros(n + 1, dtype=[(name, float) for name in names])
    signals["time"] = time
    signals["spindle_speed"] = np.diff(angle) / step
    signals["nozzle_position"] = y0 + pitch * angle[1:] / (2 * math.pi)
    if tension is not None:
        signals["tension_setpoint"] = tension
    return signals


def write_csv(signals, path):
    """Writes signals for `coilwind run --inputs`, every number in its shortest exact form."""
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write(",".join(signals.dtype.names) + "\n")
        for row in signals:
            file.write(",".join(repr(float(value)) for value in row) + "\n")
