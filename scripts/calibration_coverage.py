#!/usr/bin/env python3
"""How often the intervals of scripts/calibrate.py hold the value that a measurement was made with.

    scripts/calibration_coverage.py [--draws N] [--threads N] [--write]

The Python is that of `scripts/venv.sh study`. A run with another value than the scene's, with noise of its own in each draw,
stands for a machine. Noise of a sensor with a filter correlates from degree to degree. Takes some 30 minutes of processor time.
Exit code 1 where fewer intervals hold the value than nominal ones would in one of a thousand tables. --write writes
docs/validation/tables/calibration-coverage.md.
"""

import argparse
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

import folder as folders
import tables
from calibration_curves import TURN, Curve
from calibration_fit import Fit, calibrate, intervals
from calibration_runs import Model

CONFIDENCE, CORRELATED = 0.95, 0.4
SCENE = """[wire]
diameter_mm = 0.6
[core]
width_x_mm = 12
height_z_mm = 22
corner_radius_mm = 3
[nozzle]
distance_mm = 45
[tensioner]
tension = 11
line_damping_ratio = 0.2
[spindle]
speed = 150
turns = 1.4
[traverse]
per_turn_mm = 1.2
"""
TENSION = Curve(Path("machine"), "tension_N", "tension", 1.0, TURN * np.arange(0.3, 1.4, 1.0 / 360.0), np.zeros(0))
HEIGHT = Curve(Path("machine"), "height_mm", "height", 1e-3, TURN * np.arange(0.05, 0.9, 1.0 / 360.0), np.zeros(0))
# Standard deviation of the noise, in SI.
NOISE = {"tension": 0.2, "height": 3e-6}
# Parameter, value of the machine, start, what is measured, correlation of the noise from degree to degree.
CASES = [
    ("tensioner.line_damping_ratio", 0.35, 0.2, TENSION, 0.0),
    ("nozzle.exit_friction", 0.08, 0.05, TENSION, 0.0),
    ("nozzle.exit_friction", 0.08, 0.05, TENSION, CORRELATED),
    ("wire.yield_stress", 1.25e8, 1e8, HEIGHT, 0.0),
]
# A table of right intervals is refused so rarely.
RARE = 1e-3


def noise(random, curve, correlation):
    """Normal noise of the standard deviation in `NOISE`."""
    size = NOISE[curve.quantity]
    fresh = random.normal(0.0, size, curve.angle.size)
    for k in range(1, fresh.size):
        fresh[k] = correlation * fresh[k - 1] + np.sqrt(1.0 - correlation**2) * fresh[k]
    return fresh


def draws(command, scene, folder, case, count, threads):
    """Logarithms of fitted over true value, and how far intervals go towards the truth."""
    name, truth, start, measured, correlation = case
    curve = replace(measured, values=np.zeros(measured.angle.size))
    model = Model(command, scene, [], [name], [curve], folder)
    exact, = model.wind([truth])
    off, wide = [], []
    for seed in range(count):
        curve.values = exact + noise(np.random.default_rng(seed), curve, correlation)
        answer = calibrate(Fit(model, [start], threads))
        (value,), *ends = intervals([start], answer, CONFIDENCE)
        off.append(np.log(value / truth))
        # the half that the truth lies in, since halves may differ
        wide.append(ends[0 if off[-1] > 0.0 else 1][0])
        print(f"{name} {correlation:g}: {value:.4g}, interval {100.0 * wide[-1]:.1f} %, off by {100.0 * off[-1]:.1f} %", flush=True)
    return np.array(off), np.array(wide)


def main():
    from scipy import stats

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draws", type=int, default=24, metavar="N")
    parser.add_argument("--threads", type=int, default=1, metavar="N")
    parser.add_argument("--write", action="store_true", help="write the table of the documentation")
    args = parser.parse_args()
    rows, right = [], True
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder, "machine.toml")
        scene.write_text(SCENE, encoding="utf-8")
        for case in CASES:
            off, wide = draws(folders.COMMAND, scene, folder, case, args.draws, args.threads)
            inside = int(np.sum(np.abs(off) <= wide))
            right &= stats.binom.cdf(inside, args.draws, CONFIDENCE) > RARE
            error = np.sqrt(np.mean(off**2))
            rows.append([f"`{case[0]}`", case[3].quantity, f"{case[4]:g}", f"{inside} of {args.draws}", f"{100.0 * error:.1f}", f"{100.0 * np.median(wide):.1f}"])
    head = ["parameter", "measured", "correlation of the noise", "intervals that hold it", "fitted value off by, rms %", "half an interval, median %"]
    table = tables.table(head, rows)
    print(table)
    told = ", ".join(f"{curve.quantity} over {np.ptp(curve.angle) / TURN:.2g} turns with {NOISE[curve.quantity] / curve.unit:g} {curve.column.rpartition('_')[2]} of noise" for curve in (TENSION, HEIGHT))
    if args.write:
        tables.write(
            tables.TABLES, "calibration-coverage", "scripts/calibration_coverage.py --write", "Coverage of calibrated intervals", f"{tables.machine()}.",
            f"Intervals of {100 * CONFIDENCE:g} %, a draw of noise each; {told}:", table,
        )
    return 0 if right else 1


if __name__ == "__main__":
    sys.exit(main())
