#!/usr/bin/env python3
"""Makes a measurement out of a run: chosen columns at chosen angles, with noise. For trying scripts/calibrate.py.

    measure.py DIR --noise tension_N=0.02 --noise height_mm=0.002 -o measured.csv

DIR is the folder of a run. Noise is normal, with the given standard deviation; --seed chooses it.
"""

import argparse
import csv
from pathlib import Path

import numpy as np
from calibration_curves import UNITS, columns

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
    random, measured = np.random.default_rng(args.seed), {}
    for text in args.noise:
        column, _, sigma = text.partition("=")
        quantity, _, unit = column.rpartition("_")
        if quantity not in WHERE or unit not in UNITS[quantity]:
            parser.error(f"--noise {text}: the column is none of tension_N, coil_width_mm, height_mm")
        file, over, of = WHERE[quantity]
        angle, values = columns(args.run / file, over, of)
        turns = np.abs(angle) / (2.0 * np.pi)
        values = values / UNITS[quantity][unit]
        at = np.arange(args.from_turn, turns[-1], 1.0 / 360.0)
        measured[column] = (at, np.interp(at, turns, values) + random.normal(0.0, float(sigma), at.size))
    longest = max((at for at, _ in measured.values()), key=len)
    with open(args.output, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["turns", *measured])
        for row, turn in enumerate(longest):
            cells = [f"{values[row]:.6g}" if row < len(at) else "" for at, values in measured.values()]
            writer.writerow([f"{turn:.6f}", *cells])
    print(f"wrote {args.output}")


if __name__ == "__main__":
    main()
