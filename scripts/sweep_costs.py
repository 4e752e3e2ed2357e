#!/usr/bin/env python3
"""What bisection saves against winding everything, and what a process map costs.

    scripts/sweep_costs.py [--write]

Looks for the highest speed of `bobbin` without a defect by bisection and by brute force, and winds a sample of the process map of
`tooth`. Takes some six minutes of processor time. Exit code 1 where bisection is more than 5 rad/s off or winds more than a
tenth of the runs. --write writes docs/validation/tables/sweeps.md.
"""

import argparse
import csv
import os
import subprocess
import sys
from pathlib import Path

import tables

# A look at a value of the speed, rad/s, is worth this much.
NEAR = 5.0
SHARE = 0.1
MEMBERS = 4
# Coarse, and the turns in which the first layer has its largest gap. As it is the scene has none at any speed: here its wire trails, from farther
# away and with less tension.
TRAILS = ["traverse.trail=free", "traverse.crossover_deg=60", "traverse.crossover_delay=0", "traverse.advance_deg=120"]
FAR = ["nozzle.distance_mm=30", "tensioner.tension=8"]
COARSE = ["spindle.turns=6", "solver.tolerance=2e-5"]
BOBBIN = ["bobbin", *(word for setting in TRAILS + FAR + COARSE for word in ("--set", setting))]
BRACKET = (1100, 1500)
# As it is the scene has hardly a defect: here its nozzle stands twice as far away.
TOOTH = ["tooth", "--set", "winding.layers=1", "--set", "nozzle.distance_mm=60", "--set", "traverse.advance_deg=130"]
SPEEDS, TENSIONS, MAP_MEMBERS = (60, 340, 8), (10, 35, 6), 8
SAMPLE = 3


def sweep(command, out, *words):
    """The rows of a sweep."""
    line = [command, "sweep", *map(str, words), "--out", out, "--quiet", "--force"]
    subprocess.run(line, check=True)
    with open(out / "sweep.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def over(name, low, high, count):
    return ["--over", f"{name}={low:g}:{high:g}:{count}"]


def cpu(rows):
    return sum(float(row["cpu_s"]) for row in rows)


def highest(rows):
    """The highest speed below the first at which a run has a defect or fails, rad/s."""
    bad = [float(row["spindle.speed"]) for row in rows if row["defect"] == "true" or row["outcome"] != "done"]
    good = {float(row["spindle.speed"]) for row in rows} - set(bad)
    return max((speed for speed in good if speed < min(bad, default=float("inf"))), default=float("nan"))


def find_max(command, out):
    """Rows of the table: how, values looked at, runs, answer, processor time; and whether bisection keeps its word."""
    low, high = BRACKET
    ensemble = ["--ensemble", MEMBERS]
    every = sweep(command, out / "brute", *BOBBIN, *over("spindle.speed", low, high, round((high - low) / NEAR) + 1), *ensemble)
    some = sweep(command, out / "bisection", *BOBBIN, *over("spindle.speed", low, high, 2), "--find-max", "spindle.speed", *ensemble)
    lines = [
        [how, len(rows) // MEMBERS, len(rows), f"{highest(rows):g}", f"{cpu(rows):.0f}"]
        for how, rows in (("every 5 rad/s", every), ("`--find-max`", some))
    ]
    return lines, abs(highest(some) - highest(every)) <= NEAR and len(some) <= SHARE * len(every)


def process_map(command, out):
    """Processor time of a sample of the map, and what follows for the whole, s."""
    ends = [over("spindle.speed", *SPEEDS[:2], SAMPLE), over("tensioner.tension", *TENSIONS[:2], SAMPLE)]
    rows = sweep(command, out / "map", *TOOTH, *ends[0], *ends[1])
    times = [float(row["cpu_s"]) for row in rows]
    # Rows go through the tensions first. Between the values of the sample times are taken as linear.
    across = [mean_between(times[SAMPLE * k : SAMPLE * (k + 1)], TENSIONS[2]) for k in range(SAMPLE)]
    return times, SPEEDS[2] * TENSIONS[2] * MAP_MEMBERS * mean_between(across, SPEEDS[2])


def mean_between(values, count):
    """Mean of `count` numbers, evenly spread, of the line through `values`."""
    total = 0.0
    for k in range(count):
        place = k / (count - 1) * (len(values) - 1)
        left = min(int(place), len(values) - 2)
        total += values[left] + (place - left) * (values[left + 1] - values[left])
    return total / count


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    target = Path(os.environ.get("CARGO_TARGET_DIR", tables.ROOT / "target"))
    parser.add_argument("--command", default=os.environ.get("COILWIND_COMMAND", target / "release" / "coilwind"))
    parser.add_argument("--out", type=Path, default=target / "sweep-costs")
    parser.add_argument("--write", action="store_true", help="write the table of the documentation")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    looks, right = find_max(args.command, args.out)
    head = ["how", "speeds", "runs", "highest speed without a defect rad/s", "processor time s"]
    found = tables.table(head, looks)
    times, whole = process_map(args.command, args.out)
    costs = tables.table(
        ["runs of the sample", "processor time of one s", "384 runs, min", "on two cores, min"],
        [[len(times), f"{min(times):.1f} to {max(times):.1f}", f"{whole / 60:.0f}", f"{whole / 120:.0f}"]],
    )
    print(f"{found}\n\n{costs}")
    if args.write:
        words = f"`coilwind sweep {' '.join(BOBBIN)} --over spindle.speed={BRACKET[0]}:{BRACKET[1]}:N --ensemble {MEMBERS}`"
        grid = f"--over spindle.speed={':'.join(map(str, SPEEDS))} --over tensioner.tension={':'.join(map(str, TENSIONS))}"
        tables.write(
            tables.TABLES, "sweeps", "scripts/sweep_costs.py --write", "Costs of sweeps", f"{tables.machine()}.",
            f"The highest speed without a defect, {words}:", found,
            f"A process map, `coilwind sweep {' '.join(TOOTH)} {grid} --ensemble {MAP_MEMBERS}`, judged by runs at three speeds and three"
            " tensions from end to end of the map:", costs,
        )
    return 0 if right else 1


if __name__ == "__main__":
    sys.exit(main())
