"""Winds long, and holds what must hold over time: see endurance.sh."""

import csv
import json
import math
import subprocess
import sys
from pathlib import Path

COMMAND, OUT = sys.argv[1], Path(sys.argv[2])
SHARE = 0.01 if "--short" in sys.argv else 1.0
SPEED = 100.0  # rad/s
PITCH = 0.56e-3  # m a turn
# 0.5 mm copper on a small cylinder: a turn costs little, and frozen wire is near at all times
SCENE = """
[core]
shape = "cylinder"
radius_mm = 4
length_y_mm = {length}
[wire]
diameter_mm = 0.5
[nozzle]
distance_mm = 30
y_start_mm = {start}
[start]
clamp_y_mm = {start}
[tensioner]
tension = 8
[spindle]
speed = 100
turns = 2
"""


def wind(name, samples, step, turns=6):
    """Winds samples of spindle speed, held over `step` (s) each; returns the table of the run and its summary."""
    folder = OUT / name
    folder.mkdir(parents=True, exist_ok=True)
    half = 500.0 * PITCH * turns
    (folder / "in.toml").write_text(SCENE.format(length=2 * half + 20, start=-half))
    with open(folder / "in.csv", "w") as file:
        file.write("time,spindle_speed,nozzle_position,tension_setpoint\n")
        angle = 0.0
        for k, speed in enumerate([*samples, samples[-1]]):
            angle += speed * step
            nozzle = -1e-3 * half + PITCH * angle / (2 * math.pi)
            file.write(f"{k * step!r},{speed!r},{nozzle!r},8.0\n")
    done = subprocess.run(
        [COMMAND, "run", folder / "in.toml", "--inputs", folder / "in.csv", "--step", repr(step),
         "--no-geometry", "--quiet", "--force", "--out", folder / "out"],
        capture_output=True, text=True,
    )
    if done.returncode != 0:
        return None, {"error": done.stderr.strip()}
    with open(folder / "out" / "history.csv") as file:
        rows = list(csv.DictReader(file))
    return rows, json.loads((folder / "out" / "summary.json").read_text())


def ramp(turns, step):
    """Speeds of a run of so many turns that starts within a quarter of one."""
    angle, speeds = 0.0, []
    while angle < 2 * math.pi * turns:
        speeds.append(min(SPEED, SPEED * (len(speeds) + 1) * step / 0.03))
        angle += speeds[-1] * step
    return speeds




def many_turns():
    turns = max(3, 2000 * SHARE)
    rows, summary = wind("turns", ramp(turns, 1e-3), 1e-3, turns)
    if rows is None:
        return False, summary["error"]
    wound = float(rows[-1]["turns_wound"])
    tension = [float(r["wire_tension"]) for r in rows[len(rows) // 2 :]]
    text = f"{wound:.1f} turns wound, tension {min(tension):.3f} to {max(tension):.3f} N"
    return wound > turns - 1 and 7.0 < min(tension) and max(tension) < 9.0, text


def many_steps():
    count = int(1_000_000 * SHARE)
    speeds = [SPEED * min(1.0, (k + 1) * 1e-6 / 0.01) for k in range(count)]
    rows, summary = wind("steps", speeds, 1e-6, max(2, count * 1e-6 * SPEED / 6))
    if rows is None:
        return False, summary["error"]
    wound = float(rows[-1]["spindle_angle"])
    due = sum(speeds) * 1e-6
    # every step rounds its angle once: a random walk of the last digit
    return abs(wound / due - 1) < 1e-9, f"{count} steps, angle off by {wound - due:.1e} rad"


def standstill():
    speeds = ramp(2, 1e-3)
    still = int(100 * SHARE / 1e-2)
    before = wind("before", [*speeds, *[0.0] * 200], 1e-3)[0]
    rows, summary = wind("still", [*speeds, *[0.0] * (200 + 10 * still)], 1e-3)
    if rows is None or before is None:
        return False, summary.get("error", "the run before")
    names = ["layon_position", "free_length", "fed_length"]
    creep = [abs(float(rows[-1][n]) - float(before[-1][n])) for n in names]
    return max(creep) < 1e-6, f"creep of {names} over {10 * still * 1e-3:.0f} s: {creep} m"


def stops():
    cycles = max(2, round(10 * max(SHARE, 0.2)))
    up = [SPEED * (k + 1) / 30 for k in range(30)]
    cycle = [*up, *[SPEED] * 40, *reversed(up), *[0.0] * 30]
    rows, summary = wind("stops", cycle * cycles, 1e-3, 10)
    if rows is None:
        return False, summary["error"]
    end = [float(r["wire_tension"]) for r in rows[-10:]]
    return max(end) < 8.5 and min(end) > 7.5, f"{cycles} cycles, {min(end):.3f} to {max(end):.3f} N at the end"


def rewind():
    forth = ramp(4, 1e-3)
    back = [-s for s in reversed(forth)]
    cut, angle = [], 0.0
    for s in back:
        if angle < -3 * 2 * math.pi:
            break
        cut.append(s)
        angle += s * 1e-3
    rows, summary = wind("rewind", [*forth, *[0.0] * 50, *cut, *[0.0] * 50, *forth], 1e-3, 8)
    if rows is None:
        return False, summary["error"]
    wound = float(rows[-1]["turns_wound"])
    return wound > 4.5, f"{wound:.2f} turns after 4 forth, 3 back and 4 forth"


def main():
    bad = 0
    for run in (many_turns, many_steps, standstill, stops, rewind):
        holds, text = run()
        bad += not holds
        print(f"{run.__name__:12} {'holds' if holds else 'DOES NOT HOLD'}: {text}", flush=True)
    sys.exit(bad > 0)


main()
