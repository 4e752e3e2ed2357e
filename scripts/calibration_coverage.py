#!/usr/bin/env python3
"""How often the intervals of scripts/calibrate.py hold the value that a measurement was made with.

    scripts/calibration_coverage.py [--draws N] [--threads N] [--write]

The Python is that of `scripts/venv.sh study`. A run with another value than the scene's, with noise of its own in each draw,
stands for a machine. Noise of a sensor with a filter correlates from degree to degree. Takes some 20 minutes of processor time.
Exit code 1 where fewer intervals hold the value than nominal ones would in one of a thousand tables. --write writes
docs/validation/tables/calibration-coverage.md.
"""

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

import folder as folders
import tables
from calibration_curves import TURN, Curve
from calibration_fit import Fit, calibrate, intervals
from calibration_runs import Model

CONFIDENCE, NOISE, CORRELATED = 0.95, 0.2, 0.4
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
# Parameter, value of the machine, start, correlation of the noise from degree to degree.
CASES = [
    ("tensioner.line_damping_ratio", 0.35, 0.2, 0.0),
    ("nozzle.exit_friction", 0.08, 0.05, 0.0),
    ("nozzle.exit_friction", 0.08, 0.05, CORRELATED),
]
ANGLES = TURN * np.arange(0.3, 1.4, 1.0 / 360.0)
# A table of right intervals is refused so rarely.
RARE = 1e-3


def noise(random, correlation):
    """Normal noise of a standard deviation of `NOISE`."""
    fresh = random.normal(0.0, NOISE, ANGLES.size)
    for k in range(1, fresh.size):
        fresh[k] = correlation * fresh[k - 1] + np.sqrt(1.0 - correlation**2) * fresh[k]
    return fresh


def draws(command, scene, folder, case, count, threads):
    """Logarithms of fitted over true value, and half widths of the intervals."""
    name, truth, start, correlation = case
    curve = Curve(Path("machine"), "tension_N", "tension", 1.0, ANGLES, np.zeros(ANGLES.size))
    model = Model(command, scene, [], [name], [curve], folder)
    exact, = model.wind([truth])
    off, wide = [], []
    for seed in range(count):
        curve.values = exact + noise(np.random.default_rng(seed), correlation)
        answer = calibrate(Fit(model, [start], threads))
        (value,), (width,) = intervals([start], answer, CONFIDENCE)
        off.append(np.log(value / truth))
        wide.append(width)
        print(f"{name} {correlation:g}: {value:.4g}, interval {100.0 * width:.1f} %, off by {100.0 * off[-1]:.1f} %", flush=True)
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
            rows.append([f"`{case[0]}`", f"{case[3]:g}", f"{inside} of {args.draws}", f"{100.0 * error:.1f}", f"{100.0 * np.median(wide):.1f}"])
    head = ["parameter", "correlation of the noise", "intervals that hold it", "fitted value off by, rms %", "half an interval, median %"]
    table = tables.table(head, rows)
    print(table)
    if args.write:
        tables.write(
            tables.TABLES, "calibration-coverage", "scripts/calibration_coverage.py --write", "Coverage of calibrated intervals", f"{tables.machine()}.",
            f"Intervals of {100 * CONFIDENCE:g} % from a tension with {NOISE:g} N of noise over {np.ptp(ANGLES) / TURN:.1f} turns, a draw of noise each:", table,
        )
    return 0 if right else 1


if __name__ == "__main__":
    sys.exit(main())
