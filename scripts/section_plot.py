#!/usr/bin/env python3
"""Sections through the settled coil, and the gap round the core.

    section_plot.py target/demo/* -o target/demo/sections.png

Each argument is the folder of a run, or its stations.csv. Wire, core and limits are those of the scene.toml in the
folder. A row for each run shows the wire cut at eight angles round the core, along the core (to the right) and away
from it (up): to one scale where all wires are as thick, else each row to its own. The panel below shows the gap to the neighbour one turn back over the polar angle.
"""

import argparse
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import folder as folders
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from failure import Mistake, told
from matplotlib.patches import Circle
from runs import COLOURS, STYLE, Run, by_speed, find_file, open_run, read_columns

COLUMNS = ["turn", "angle", "polar", "y", "height", "gap", "measured"]


@dataclass
class Section:
    """What is drawn of a run. Lengths in mm; the diameter is that over the enamel, `places` are names and polar angles (rad)."""

    run: Run
    label: str
    stations: dict
    colour: str
    diameter: float
    gap_limit: float
    places: list
    faces: tuple | None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", metavar="DIR", help="folder of a run, or its stations.csv")
    parser.add_argument("-o", "--output", type=Path, default=Path("sections.png"), metavar="FILE", help="picture to write")
    parser.add_argument("--turn", type=int, default=2, metavar="N", help="turn of the gap panel, from 1 (default: 2)")
    arguments = parser.parse_args()
    with told(parser.prog):
        draw(arguments)
        print(f"wrote {arguments.output}")


def draw(arguments):
    sections = sections_of(arguments.runs)
    plt.rcParams.update(STYLE)
    alike = len({section.diameter for section in sections}) == 1
    windows = [section_window(sections if alike else [section]) for section in sections]
    # A cell is about 1.15 inches wide; the label beside it takes some height too.
    rows = [max(1.25, 1.15 * (top - bottom) / (right - left) + 0.25) for (left, right), (bottom, top) in windows]
    figure = plt.figure(figsize=(11, 3.4 + sum(rows)), layout="constrained")
    grid = figure.add_gridspec(len(sections) + 1, 8, height_ratios=[*rows, 3.2])
    before = None
    for row, section in enumerate(sections):
        for column, (name, polar) in enumerate(section.places):
            axis = figure.add_subplot(grid[row, column])
            draw_section(axis, section, polar, windows[row])
            # Cores of other shapes are cut at other places.
            if section.places != before:
                axis.set_title(name)
            if column == 0:
                words = section.label.replace(", ", "\n") + f"\n{section.diameter:g} mm wire"
                axis.set_ylabel(words, color=section.colour, fontweight="bold", fontsize=8)
        before = section.places
    draw_gaps(figure.add_subplot(grid[-1, :]), sections, arguments.turn)
    folders.write_whole(arguments.output, figure.savefig)


def sections_of(paths):
    """What is drawn of every run, in the order of their speed."""
    files = {}
    for path in paths:
        run = open_run(path)
        files[run.directory] = (run, find_file(path, "stations.csv"))
    runs = by_speed(run for run, _ in files.values())
    shared = Counter(run.label for run in runs)
    sections = []
    for number, run in enumerate(runs):
        scene = run.scene
        try:
            limit = scene["defects"]["gap"]
            places = section_places(scene["core"])
        except (KeyError, TypeError) as error:
            raise Mistake(f"{run.directory / 'scene.toml'} has no {error}; it has to be the file that a run leaves") from None
        window = run.summary.get("product", {}).get("window")
        name = run.directory.name or str(run.directory)
        sections.append(Section(
            run=run, label=run.label if shared[run.label] == 1 else f"{run.label}, {name}",
            stations=read_columns(files[run.directory][1], COLUMNS), colour=COLOURS[number % len(COLOURS)],
            diameter=1e3 * run.diameter, gap_limit=limit, places=places,
            faces=tuple(1e3 * y for y in window["faces_m"]) if window else None,
        ))
    return sections


def section_places(core):
    """Names and polar angles (rad) of the places that are cut: faces and corners of a box, every 45 degrees of other cores."""
    if core["shape"] != "rounded-box":
        return [(f"{45 * k}° from +x", k * np.pi / 4) for k in range(8)]
    corner = np.arctan2(core["height_z"], core["width_x"])
    return [
        ("face +x", 0.0),
        ("corner +x +z", corner),
        ("face +z", np.pi / 2),
        ("corner −x +z", np.pi - corner),
        ("face −x", np.pi),
        ("corner −x −z", np.pi + corner),
        ("face −z", 1.5 * np.pi),
        ("corner +x −z", 2 * np.pi - corner),
    ]


def cut(stations, polar):
    """Turn, y and height (mm) of every wire nearest to a polar angle, within a degree."""
    aside = np.abs((stations["polar"] - polar + np.pi) % (2 * np.pi) - np.pi)
    wires = []
    near = aside < np.radians(1.0)
    # Wire passes the angle once per turn of its winding angle, at any phase to it.
    passes = np.round((stations["angle"] - polar_phase(stations, polar)) / (2 * np.pi))
    for number in np.unique(passes[near]):
        at = np.flatnonzero(near & (passes == number))
        k = at[np.argmin(aside[at])]
        turn = int(stations["turn"][k])
        wires.append((turn, 1e3 * stations["y"][k], 1e3 * stations["height"][k]))
    return wires


def polar_phase(stations, polar):
    """Winding angle from the clamp at which wire first passes a polar angle."""
    first, second = stations["polar"][0], stations["polar"][min(1, len(stations["polar"]) - 1)]
    forward = (second - first + np.pi) % (2 * np.pi) >= np.pi
    return ((polar - first) if forward else (first - polar)) % (2 * np.pi)


def section_window(sections):
    """Limits along y and of height that show these runs to one scale, mm."""
    left, right, top, bottom = np.inf, -np.inf, -np.inf, np.inf
    for section in sections:
        y, height = 1e3 * section.stations["y"], 1e3 * section.stations["height"]
        diameter = section.diameter
        # One wire alone would look as thick as a coil.
        middle, half = (y.min() + y.max()) / 2, max((y.max() - y.min()) / 2 + 0.9 * diameter, 4 * diameter)
        left, right = min(left, middle - half), max(right, middle + half)
        bottom, top = min(bottom, -0.6 * diameter), max(top, height.max() + 1.6 * diameter)
    return (left, right), (bottom, top)


def draw_section(axis, section, polar, window):
    (left, right), (bottom, top) = window
    diameter = section.diameter
    axis.axhspan(bottom, 0, color="#c9ced6", linewidth=0)
    if section.faces:
        axis.axvspan(left, max(left, section.faces[0]), color="#c9ced6", linewidth=0)
        axis.axvspan(min(right, section.faces[1]), right, color="#c9ced6", linewidth=0)
    # Numbers that would be wider than their wire are of no use.
    numbered = (right - left) / diameter < 14 and (top - bottom) / diameter < 10
    for turn, y, height in cut(section.stations, polar):
        wire = Circle(
            (y, height + diameter / 2), diameter / 2, facecolor=section.colour, edgecolor="white",
            linewidth=0.6 if numbered else 0.0, alpha=0.55 + 0.45 * (turn % 2),
        )
        axis.add_patch(wire)
        if numbered:
            axis.text(
                y, height + diameter / 2, str(turn), ha="center", va="center_baseline", fontsize=6.5, color="white",
            )
    axis.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", xticks=[], yticks=[])
    axis.grid(False)
    for spine in axis.spines.values():
        spine.set_visible(False)


def draw_gaps(axis, sections, turn):
    limits = sorted({section.gap_limit for section in sections})
    low, high = -0.5 * limits[0], 2 * limits[-1]
    for section in sections:
        stations = section.stations
        of_turn = stations["turn"] == turn
        angle = np.degrees(stations["angle"][of_turn] - 2 * np.pi * (turn - 1))
        gap = stations["gap"][of_turn] * 1e3 / section.diameter
        judged = stations["measured"][of_turn] > 0
        seen = gap[~np.isnan(gap)]
        low, high = min([low, *seen]), max([high, *seen])
        label = section.label if of_turn.any() else f"{section.label}: no turn {turn}"
        axis.plot(angle, np.where(judged, gap, np.nan), color=section.colour, label=label, linewidth=1.4)
        axis.plot(angle, np.where(judged, np.nan, gap), color=section.colour, linewidth=0.8, alpha=0.35)
    for limit in limits:
        # Runs of one limit share a line; others have theirs, in their colour.
        colour = "#c8442d" if len(limits) == 1 else next(s.colour for s in sections if s.gap_limit == limit)
        axis.axhline(limit, color=colour, linewidth=0.8, linestyle=(0, (4, 3)))
        axis.annotate(
            f"gap limit {limit:g}", (0, limit), xytext=(3, 3), textcoords="offset points", fontsize=7.5, color=colour,
        )
    marked = mark_corners(axis, sections)
    axis.set(
        xlim=(0, 360),
        ylim=(low - 0.05 * (high - low), high + 0.05 * (high - low)),
        xticks=range(0, 361, 45),
        xlabel=f"polar angle from the clamp in turn {turn} (degrees); {marked}pale: not judged",
        ylabel="gap over diameter",
    )
    axis.legend(ncols=len(sections), loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2)


def mark_corners(axis, sections):
    """Marks the corners of boxes: grey where all runs have them there, else in the colour of each. Says so, in words."""
    corners = [
        [round(np.degrees(polar_phase(section.stations, polar)), 6) for name, polar in section.places if name.startswith("corner")]
        for section in sections
    ]
    alike = all(places == corners[0] for places in corners)
    for section, places in zip(sections[:1] if alike else sections, corners):
        for place in places:
            axis.axvline(place, color="#c9ced6" if alike else section.colour, alpha=1.0 if alike else 0.35, linewidth=1.2, zorder=0)
    return "corners marked, " if any(corners) else ""


if __name__ == "__main__":
    main()
