#!/usr/bin/env python3
"""P1 and P2 with PyElastica: a Cosserat rod, explicit in time (position Verlet).

A stiff thin wire is hard for it: shear waves and the small inertia of the sections limit the step to 1e-7 s. Tried,
and the choice:
- shear as soft as stretch or softer, both made softer by `soft`, and sections slower to turn by `heavy`, as far as
  the error bears it: longer steps by the root of their product. P1 is static, so `heavy` costs nothing there.
- the clamp holds the direction of the first element; a rod that begins half an element earlier makes it second order.
- P1: no static solver. Uniform damping of 1.6 to 4 omega_1 over 1.25 to 5 periods: the more load, the stiffer the
  wire and the more damping.
- P2: PositionVerlet. PEFRL was not run: it takes four evaluations a step, and the error comes from the elements and
  from `soft` and `heavy`, not from the step.
- steps of 0.8 of the limit of stability. The first run, which compiles, is not on the clock.
"""

import logging
import math

import elastica as ea
import numpy as np

import peer
from problems import (
    DENSITY, DIAMETER, EA, EI, GJ, LENGTH, MASS, OMEGA, PERIOD, mode_slope, steps_of, tip_error, tip_force,
    vibration_error,
)

# PyElastica warns of sections as small as those of a wire, each time.
logging.getLogger().setLevel(logging.ERROR)

# Of the stability limit.
SHARE = 0.8


class Wire(ea.BaseSystemCollection, ea.Constraints, ea.Forcing, ea.Damping):
    """What PyElastica assembles a simulation from."""


def cantilever(n, soft, heavy):
    """Rod of n elements that is clamped half an element before its length begins, and the length of an element.

    PyElastica clamps the direction of the first element, so bending begins at that element's middle. Stretch and shear are
    `soft` times softer than stretch is, and sections `heavy` times slower to turn.
    """
    h = LENGTH / (n - 0.5)
    rod = ea.CosseratRod.straight_rod(
        n,
        np.array([-0.5 * h, 0.0, 0.0]),
        np.array([1.0, 0.0, 0.0]),
        np.array([0.0, 1.0, 0.0]),
        n * h,
        0.5 * DIAMETER,
        DENSITY,
        youngs_modulus=EA / (math.pi * DIAMETER**2 / 4.0),
    )
    rod.shear_matrix[...] = np.diag([EA / soft] * 3)[..., None]
    rod.bend_matrix[...] = np.diag([EI, EI, GJ])[..., None]
    rod.mass_second_moment_of_inertia *= heavy
    rod.inv_mass_second_moment_of_inertia /= heavy
    wire = Wire()
    wire.append(rod)
    wire.constrain(rod).using(ea.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,))
    return wire, rod, h


def longest_step(n, soft, heavy):
    """Stability limit, s: waves along the wire, shear against the sections' inertia, bending between neighbours."""
    h = LENGTH / (n - 0.5)
    along = h * math.sqrt(MASS * soft / EA)
    shear = 2.0 * math.sqrt(DENSITY * math.pi * DIAMETER**4 / 64.0 * heavy * soft / EA)
    bend = 0.5 * h * h * math.sqrt(MASS / EI)
    return 1.0 / math.hypot(1.0 / along, 1.0 / shear, 1.0 / bend)


def p1(setting):
    n, a = setting["n"], setting["a"]
    dt = setting["dt"] = SHARE * longest_step(n, setting["soft"], setting["heavy"])
    count = round(setting["periods"] * PERIOD / dt)

    def prepare():
        wire, rod, _ = cantilever(n, setting["soft"], setting["heavy"])
        wire.add_forcing_to(rod).using(
            ea.EndpointForces, np.zeros(3), np.array([0.0, tip_force(a), 0.0]), ramp_up_time=0.25 * PERIOD
        )
        wire.dampen(rod).using(
            ea.AnalyticalLinearDamper,
            uniform_damping_constant=setting["damping"] * OMEGA,
            time_step=dt,
        )
        wire.finalize()
        return wire, rod

    def solve(model):
        wire, rod = model
        stepper = ea.PositionVerlet()
        time = 0.0
        for _ in range(count):
            time = stepper.step(wire, time, dt)
        return rod.position_collection[:2, -1]

    def judge(_, tip):
        return {"error": tip_error(a, tip), "steps": count}

    return prepare, solve, judge


def p2(setting):
    n = setting["n"]
    count, dt = steps_of(PERIOD / (SHARE * longest_step(n, setting["soft"], setting["heavy"])))
    setting["dt"] = dt
    every = max(1, count // 2000)

    def prepare():
        wire, rod, h = cantilever(n, setting["soft"], setting["heavy"])
        wire.finalize()
        # released on the mode's shape: elements along its slope at their middles
        for i in range(n):
            slope = mode_slope(i * h / LENGTH)
            t = np.array([1.0, slope, 0.0]) / math.hypot(1.0, slope)
            across = np.array([-t[1], t[0], 0.0])
            rod.director_collection[:, :, i] = [across, np.cross(t, across), t]
            rod.position_collection[:, i + 1] = rod.position_collection[:, i] + h * t
        return wire, rod

    def solve(model):
        wire, rod = model
        stepper = ea.PositionVerlet()
        time = 0.0
        times, heights = [], []
        for step in range(1, count + 1):
            time = stepper.step(wire, time, dt)
            if step % every == 0:
                times.append(time)
                heights.append(rod.position_collection[1, -1])
        return times, heights

    def judge(_, solved):
        return {"error": vibration_error(*solved), "steps": count}

    return prepare, solve, judge


def p1_setting(a, n, soft):
    damping = {1: 2, 5: 3, 10: 4}[a]
    return {"n": n, "a": a, "soft": soft, "heavy": 300, "periods": 2 if a == 1 else 1.5, "damping": damping}


def p2_setting(n, soft, heavy):
    return {"n": n, "soft": soft, "heavy": heavy}


SETTINGS = {
    "P1": [p1_setting(a, *s) for a in (1, 5, 10) for s in ((10, 30), (20, 10), (40, 2), (80, 2))],
    "P2": [p2_setting(*s) for s in ((10, 30, 30), (20, 20, 20), (40, 10, 10))],
}
QUICK = {"P1": [p1_setting(10, 10, 30)], "P2": [p2_setting(10, 30, 30)]}

if __name__ == "__main__":
    peer.main("pyelastica", {"P1": p1, "P2": p2}, SETTINGS, QUICK)
