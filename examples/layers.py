#!/usr/bin/env python3
"""Layers by speed only: the FMU's own traverse winds them, and the master slows down where wire climbs to the next one.

    "$(scripts/venv.sh study)" examples/layers.py [--fmu FILE] [--turns N] [--share S]

The machine sends nothing but its speed. `traverse.mode` makes the nozzle follow the plan of the scene.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from winder import wind

SPEED, RAMP_TURNS, PER_LAYER = 100.0, 0.25, 20   # rad/s; turns of a layer of the scene
SLOW_TURNS = 1.0                                  # from so many turns before a climb to as many after it
OUTPUTS = ["spindle_angle", "layer", "turns_settled", "defect_count"]


def speed_at(turns, share):
    """Allowed speed, rad/s: its square changes evenly over the angle, as at constant acceleration."""
    rise = min(1.0, max(1e-4, turns / RAMP_TURNS))
    layer = round(turns / PER_LAYER)
    off = abs(turns - PER_LAYER * layer) / SLOW_TURNS
    slow = 1.0 if layer == 0 or off >= 1.0 else share**2 + off * (1.0 - share**2)
    return SPEED * np.sqrt(min(rise, slow))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--fmu", default="target/fmu/CoilWinding.fmu")
    parser.add_argument("--turns", type=float, default=24.0)
    parser.add_argument("--share", type=float, default=0.5, help="speed at a climb, as a share of the full one (default 0.5)")
    given = parser.parse_args()
    if not Path(given.fmu).is_file():
        print(f"layers.py: {given.fmu} is missing; build it with scripts/build_fmu.sh", file=sys.stderr)
        sys.exit(2)
    scene = {"scene.file": "bobbin", "traverse.mode": "orthocyclic"}

    def law(angle, time, read):
        return speed_at(angle / (2.0 * np.pi), given.share), 0.0, 15.0

    rows = wind(given.fmu, scene, 5e-4, given.turns, law, OUTPUTS)
    turns = rows["spindle_angle"] / (2.0 * np.pi)
    for layer in range(1, int(rows["layer"].max()) + 1):
        begun = turns[rows["layer"] >= layer].min()
        print(f"layer {layer}: from turn {begun:.1f} on")
    print(f"{rows['turns_settled'][-1]:.1f} turns settled in {rows['time'][-1]:.2f} s, {rows['defect_count'][-1]:.0f} defects")


if __name__ == "__main__":
    main()
