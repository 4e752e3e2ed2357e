#!/usr/bin/env python3
"""Winds scenes whose defects are known from how they are made, and compares what the simulator says.

    labelled.py [--command PATH] [--out DIR] [--sample] [--refined N] [--jobs N] [--only WORD] [--write]

A scene has a label before anything is computed: the nozzle skips a groove, stands back for a turn or turns too early, the
tension falls or rises at a turn, the coil has no room below the nozzle. --sample winds every sixth scene. --refined winds N
scenes again with half the tolerance and half the spacing. --write puts the table into docs/validation/tables/labelled.md.
Exits with 1 if a nominal scene has a defect, fewer than 95 % of the scenes are right, or a refined one says otherwise.
"""

import argparse
import csv
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import tables
from labelled_scenes import SCENES

ROOT = Path(__file__).resolve().parents[1]
SHARE = 0.95
"""Share of the scenes that has to be right."""
SAMPLE = 6
"""One scene in so many is in the sample."""
SAME_PLACE = 0.5
"""Turns by which a defect may move in a refined run."""
TOLERANCE_UM = 5.0
SPACING_MM = 0.4
"""Tolerance and spacing of a scene with wire of 0.7 mm: the default spacing at this tolerance, rounded."""


@dataclass
class Found:
    """What a run says: its defects as kind and place in turns from the clamp, its verdict, and how it ended."""

    defects: list = field(default_factory=list)
    verdict: str = "none"
    status: str = "none"
    unexplained: float = 0.0  # by the energy balance, as a share of what spindle and feed did
    deepest: float = 0.0  # contact, diameters

    @classmethod
    def of(cls, folder):
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        with open(folder / "defects.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        defects = [(row["kind"], int(row["turn"]) - 1 + float(row["angle_deg"]) / 360) for row in rows]
        energy = summary["energy"]
        through = abs(energy["spindle_work_J"]) + abs(energy["nozzle_work_J"])
        return cls(defects, summary["verdict"], summary["status"], abs(energy["residual_J"]) / through,
                   summary["penetration"]["largest_over_d"])

    def in_words(self):
        seen = [f"{kind} {place + 1:.1f}" for kind, place in self.defects]
        return ", ".join(seen) or self.verdict


def wind(scene, command, folder, share):
    """Winds a scene with this share of its tolerance and spacing."""
    folder.mkdir(parents=True, exist_ok=True)
    scene.write(folder)
    arguments = [command, "run", "scene.toml", "--out", "run", "--force", "--quiet", "--no-geometry"]
    finer = share * scene.scale
    arguments += ["--set", f"solver.tolerance_um={finer * TOLERANCE_UM}"]
    arguments += ["--set", f"solver.spacing_near_mm={finer * SPACING_MM}"]
    if scene.tension is not None:
        motion = [command, "motion", "scene.toml", "--step", str(scene.step), "--out", "motion.csv"]
        subprocess.run(motion, cwd=folder, check=True, capture_output=True)
        scene.write_inputs(folder / "motion.csv", folder / "inputs.csv")
        arguments += ["--inputs", "inputs.csv", "--step", str(scene.step)]
    done = subprocess.run(arguments, cwd=folder, capture_output=True, text=True, check=False)
    if not (folder / "run" / "summary.json").exists():
        return Found(status=done.stderr.strip() or "no results")
    return Found.of(folder / "run")


def complaints(scene, found):
    """What is wrong about what was found."""
    wrong = []
    if found.status != "done":
        wrong.append(f"ended as {found.status}")
    for label in scene.labels:
        if not any(label.holds(*defect) for defect in found.defects):
            wrong.append(f"no {label}")
    for kind, place in found.defects:
        known = kind in scene.follows or any(label.holds(kind, place) for label in scene.labels)
        if not known:
            wrong.append(f"{kind} at turn {place + 1:.1f}")
    if not scene.labels and found.verdict not in ("single", "aligned", "marginal"):
        wrong.append(f"verdict {found.verdict}")
    return wrong


def differences(scene, found, refined):
    """In what the labelled defects of a refined run differ."""
    wrong = complaints(scene, refined)
    for kind, place in refined.defects:
        if kind in scene.follows:
            continue
        places = [p for k, p in found.defects if k == kind]
        if not any(abs(p - place) < SAME_PLACE for p in places):
            wrong.append(f"{kind} at turn {place + 1:.1f}, not at {', '.join(f'{p + 1:.1f}' for p in places)}")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    command = os.environ.get("COILWIND_COMMAND", target / "release" / "coilwind")
    parser.add_argument("--command", type=Path, default=command)
    parser.add_argument("--out", type=Path, default=target / "labelled")
    parser.add_argument("--sample", action="store_true", help="every sixth scene only")
    parser.add_argument("--refined", type=int, default=0, help="wind so many scenes again, refined")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="runs side by side")
    parser.add_argument("--only", default="", help="scenes whose name has this word")
    parser.add_argument("--write", action="store_true", help="write the table of the documentation")
    arguments = parser.parse_args()
    command = str(arguments.command.resolve())
    scenes = [scene for scene in SCENES if arguments.only in scene.name]
    if arguments.sample:
        scenes = scenes[::SAMPLE]
    again = scenes[:: max(1, len(scenes) // arguments.refined)][: arguments.refined] if arguments.refined else []

    with ThreadPoolExecutor(arguments.jobs) as pool:
        runs = pool.map(lambda scene: wind(scene, command, arguments.out / scene.name, 1.0), scenes)
        results = {}
        for scene, found in zip(scenes, runs):
            results[scene.name] = found
            wrong = complaints(scene, found)
            print(f"{'WRONG' if wrong else 'right'}  {scene.name:32} {found.in_words()}"
                  + (f"   <- {'; '.join(wrong)}" if wrong else ""), flush=True)
        refined = pool.map(lambda scene: wind(scene, command, arguments.out / "refined" / scene.name, 0.5), again)
        changed = []
        for scene, found in zip(again, refined):
            wrong = differences(scene, results[scene.name], found)
            changed += [scene.name] if wrong else []
            print(f"{'OTHER' if wrong else 'same '}  {scene.name:32} {found.in_words()}"
                  + (f"   <- {'; '.join(wrong)}" if wrong else ""), flush=True)

    right = [scene for scene in scenes if not complaints(scene, results[scene.name])]
    alarms = [scene for scene in scenes if not scene.labels and scene not in right]
    fast = sum(scene.speed >= 300 for scene in scenes)
    total = (f"{len(right)} of {len(scenes)} scenes are right with place; {len(alarms)} of "
             f"{sum(not scene.labels for scene in scenes)} nominal scenes have a false alarm; {fast} turn at 300 rad/s or more")
    if again:
        total += f"; {len(again) - len(changed)} of {len(again)} say the same at half the tolerance and half the spacing"
    print(total)
    if arguments.write:
        write_table(scenes, results, f"{total}. {in_doubt(scenes, results)}")
    return 1 if alarms or changed or len(right) < SHARE * len(scenes) else 0


def in_doubt(scenes, results):
    """What the energy balances leave unexplained and how deep contacts are, at most."""
    def most(chosen):
        found = [results[scene.name] for scene in chosen]
        return 100 * max(each.unexplained for each in found), max(each.deepest for each in found)
    steady = [scene for scene in scenes if all(label.kind != "runaway" for label in scene.labels)]
    (share, depth), (share_of_all, depth_of_all) = most(steady), most(scenes)
    return (f"The energy balance leaves at most {share:.2g} % of what spindle and feed did unexplained, and wire is up to {depth:.2g} diameters "
            f"deep in what it touches. With wire that runs away it is {share_of_all:.2g} % and {depth_of_all:.2g} diameters")


def write_table(scenes, results, total):
    head = ["scene", "made by", "core", "layers", "rad/s", "label: kind and turn", "found: kind and turn", "right"]
    rows = []
    for scene in scenes:
        found = results[scene.name]
        label = ", ".join(map(str, scene.labels)) or "none"
        wrong = complaints(scene, found)
        rows.append([scene.name, scene.made, scene.core, scene.layers, f"{scene.speed:g}", label,
                     found.in_words(), "; ".join(wrong) or "yes"])
    tables.write(tables.TABLES, "labelled", "scripts/labelled.py --refined 88 --write",
                 "Scenes with a known defect", total + ".", tables.table(head, rows))


if __name__ == "__main__":
    sys.exit(main())
