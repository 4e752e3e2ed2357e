#!/usr/bin/env python3
"""Makes a measurement out of a run: chosen columns at chosen angles, with noise. For trying scripts/calibrate.py.

    measure.py DIR --noise tension_N=0.02 --noise height_mm=0.002 -o measured.csv

DIR is the folder of a run. Noise is normal, with the given standard deviation; --seed chooses it.
"""

import argparse
import csv
from pathlib import Path

import folder as folders
import numpy as np
from calibration_curves import UNITS
from failure import Mistake, told
from runs import broken, table

WHERE = {
    "tension": ("history.csv", "spindle_angle", "wire_tension"),
    "coil_width": ("history.csv", "spindle_angle", "coil_width"),
    "height": ("stations.csv", "angle", "height"),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path, metavar="DIR")
    parser.add_argument("--noise", action="append", required=True, metavar="COLUMN=SIGMA", help="a column to measure, such as tension_N=0.02")
    parser.add_argument("--from-turn", type=float, default=0.3, metavar="N", help="first turn measured (default: 0.3)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-o", "--output", type=Path, default=Path("measured.csv"))
    args = parser.parse_args()
    with told(parser.prog):
        measured = {}
        random = np.random.default_rng(seed_of(args.seed))
        for text in args.noise:
            column, values = measure(args, text, random)
            measured[column] = values
        folders.write_whole(args.output, lambda path: write(path, measured))
        print(f"wrote {args.output}")


def seed_of(seed):
    if seed < 0:
        raise Mistake(f"--seed {seed} has to be at least 0")
    return seed


def measure(args, text, random):
    """The name of a column, and its turns and values."""
    column, _, sigma = text.partition("=")
    quantity, _, unit = column.rpartition("_")
    if quantity not in WHERE or unit not in UNITS[quantity]:
        raise Mistake(f"--noise {text}: the column is none of tension_N, coil_width_mm, height_mm")
    try:
        sigma = float(sigma)
    except ValueError:
        raise Mistake(f"--noise {text}: expected COLUMN=SIGMA, such as {column}=0.02") from None
    if not 0.0 <= sigma < np.inf:
        raise Mistake(f"--noise {text}: the standard deviation has to be at least 0")
    file, over, of = WHERE[quantity]
    angle, values = table(args.run / file, [over, of]).values()
    if np.isnan([angle, values]).any():
        raise broken(args.run / file, f"{over} or {of} has an empty cell")
    turns = np.abs(angle) / (2.0 * np.pi)
    if not (turns.size and 0.0 <= args.from_turn < turns[-1]):
        there = f"goes to turn {turns[-1]:.2f}" if turns.size else "has no rows"
        raise Mistake(f"--from-turn {args.from_turn:g}: {column} of {args.run} {there}; begin before that, or wind more turns")
    at = np.arange(args.from_turn, turns[-1], 1.0 / 360.0)
    return column, (at, np.interp(at, turns, values / UNITS[quantity][unit]) + random.normal(0.0, sigma, at.size))


def write(path, measured):
    longest = max((at for at, _ in measured.values()), key=len)
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["turns", *measured])
        for row, turn in enumerate(longest):
            cells = [f"{values[row]:.6g}" if row < len(at) else "" for at, values in measured.values()]
            writer.writerow([f"{turn:.6f}", *cells])


if __name__ == "__main__":
    main()
