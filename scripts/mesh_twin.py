#!/usr/bin/env python3
"""The scene `tooth` with its core by formula and from STL files: bulge, gap, verdict and CPU time side by side.

    scripts/mesh_twin.py [--command PATH] [--tables docs/validation/tables] [--layers N] [--rounds N]

Writes mesh-twin.md. Takes about ten minutes with all three layers. Let the machine do nothing else.
"""

import argparse
import csv
import json
import math
import os
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import solids
import tables

SCENE = tables.ROOT / "src" / "scene" / "packed" / "tooth.toml"
CHORDS = 16
"""Of a corner of the core."""
FINE = 0.5
"""Longest edge of the fine mesh along and across the core, mm."""


def meshes(core):
    """Name of each STL file, how it is told, its rings, and whether it has the flanges. Lengths in mm."""
    flange = core["flange"]
    face = flange["inner_distance_mm"] / 2
    end, height = face + flange["thickness_mm"], flange["height_mm"]
    size = (core["width_x_mm"], core["height_z_mm"], core["corner_radius_mm"])

    def ring(y, grown, longest=math.inf):
        points = solids.rounded_box(*size, grown, CHORDS)
        return y, solids.divided(points, longest) if math.isfinite(longest) else points

    flanged = [(-end, height), (-face, height), (-face, 0), (face, 0), (face, height), (end, height)]
    levels = math.ceil(2 * end / FINE)
    fine = [ring(-end + 2 * end * k / levels, 0, FINE) for k in range(levels + 1)]
    return [
        ("flanged", "STL with flanges", [ring(*level) for level in flanged], True),
        ("barrel", "STL, flanges by key", [ring(-end, 0), ring(end, 0)], False),
        ("fine", "the same, fine", fine, False),
    ]


def write_scenes(folder, layers):
    """The scenes as files, the one by formula first: name, how its core is told, triangles, path."""
    text = SCENE.read_text(encoding="utf-8").replace("layers = 3", f"layers = {layers}")
    core = tomllib.loads(text)["core"]
    before, _, rest = text.partition("[core]\n")
    keys, _, rest = rest.partition("[core.flange]\n")
    flange, _, after = rest.partition("[nozzle]\n")
    scenes = [("formula", "formula", "-", f"{before}[core]\n{keys}[core.flange]\n{flange}[nozzle]\n{after}")]
    for name, told, rings, has_flanges in meshes(core):
        triangles = solids.write_stl(folder / f"{name}.stl", rings)
        flanges = "" if has_flanges else f"[core.flange]\n{flange}"
        mesh = f'[core]\nshape = "mesh"\nfile = "{name}.stl"\n'
        scenes.append((name, told, triangles, f"{before}{mesh}{flanges}[nozzle]\n{after}"))
    for name, _, _, scene in scenes:
        (folder / f"{name}.toml").write_text(scene, encoding="utf-8")
    return [(name, told, triangles) for name, told, triangles, _ in scenes]


def wind(command, folder, name):
    """Winds a scene; returns the CPU time of the whole process, s."""
    words = [command, "run", folder / f"{name}.toml", "--out", folder / name, "--force", "--quiet", "--no-geometry", "--no-report"]
    done = subprocess.Popen(words)
    _, status, usage = os.wait4(done.pid, 0)
    if status:
        sys.exit(f"mesh_twin.py: coilwind ended with {os.waitstatus_to_exitcode(status)} on {name}")
    return usage.ru_utime + usage.ru_stime


def stations(folder, name):
    with open(folder / name / "stations.csv", newline="", encoding="utf-8") as file:
        return {(row["turn"], row["station"]): row for row in csv.DictReader(file)}


def apart(ours, theirs, column):
    """Root mean square of the difference of a column over the stations of both, um."""
    shared = [(ours[key][column], theirs[key][column]) for key in ours.keys() & theirs.keys()]
    squares = [(float(a) - float(b)) ** 2 for a, b in shared if a and b]
    return f"{1e6 * math.sqrt(sum(squares) / len(squares)):.1f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", default=tables.ROOT / "target" / "release" / "coilwind", type=Path)
    parser.add_argument("--tables", default=tables.TABLES, type=Path)
    parser.add_argument("--layers", default=3, type=int)
    parser.add_argument("--rounds", default=3, type=int, help="runs of each scene, one after the other in turn; the least time counts")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        scenes = write_scenes(folder, args.layers)
        times = {name: math.inf for name, *_ in scenes}
        for _ in range(args.rounds):
            for name, *_ in scenes:
                times[name] = min(times[name], wind(args.command, folder, name))
        exact = stations(folder, "formula")
        rows = []
        for name, told, triangles in scenes:
            found = stations(folder, name)
            verdict = json.loads((folder / name / "summary.json").read_text(encoding="utf-8"))["verdict"]
            off = ["-", "-"] if name == "formula" else [apart(exact, found, column) for column in ("bulge", "gap")]
            rows.append([told, triangles, verdict, *off, f"{times[name]:.2f}", f"{times[name] / times['formula']:.2f}"])
    head = ["core", "triangles", "verdict", "bulge off by um rms", "gap off by um rms", "CPU s", "times the formula's"]
    told = (
        f"`tooth`, {args.layers} layers at 100 rad/s, default tolerance. CPU is that of whole processes, the least of {args.rounds} runs,"
        f" one core after the other in turn; {tables.machine()}."
    )
    title = "The same tooth by formula and from STL files"
    print(tables.write(args.tables, "mesh-twin", "scripts/mesh_twin.py", title, told, tables.table(head, rows)).read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
