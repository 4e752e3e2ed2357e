#!/usr/bin/env python3
"""Sections through the settled coil, and the gap round the core.

    section_plot.py target/demo/* -o target/demo/sections.png

Each argument is a run's directory or its stations.csv. A row per run shows the wire cut at the
middle of each face and at each corner, along the core (to the right) and away from it (up); the
panel below shows the gap to the neighbour one turn back over polar angle.
"""

import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Circle
from runs import COLOURS, STYLE, by_speed, find_file, open_run, read_columns

COLUMNS = ["turn", "angle", "polar", "y", "height", "gap", "measured"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="+", help="directory of a run, or its stations.csv")
    parser.add_argument("-o", "--output", default="sections.png", help="picture to write")
    parser.add_argument("--diameter-mm", type=float, default=0.7, help="wire diameter")
    parser.add_argument(
        "--core-mm", default="12x30", metavar="XxZ", help="width along x and height along z"
    )
    parser.add_argument("--turn", type=int, default=2, help="turn of the gap panel, from 1")
    parser.add_argument("--gap-limit", type=float, default=0.15, help="limit in diameters")
    arguments = parser.parse_args()
    try:
        width, height = (float(number) for number in arguments.core_mm.split("x"))
    except ValueError:
        parser.error(f"--core-mm {arguments.core_mm}: two numbers with an x between, as 12x30")

    files = {}
    for path in arguments.runs:
        run = open_run(path)
        files[run.directory] = (run, find_file(path, "stations.csv"))
    runs = by_speed(run for run, _ in files.values())
    data = [read_columns(files[run.directory][1], COLUMNS) for run in runs]
    places = section_places(width, height)

    plt.rcParams.update(STYLE)
    figure = plt.figure(figsize=(11, 3.4 + 0.95 * len(runs)), layout="constrained")
    grid = figure.add_gridspec(
        len(runs) + 1, len(places), height_ratios=[1.0] * len(runs) + [3.2]
    )
    window = section_window(data, arguments.diameter_mm)
    for row, (run, stations) in enumerate(zip(runs, data)):
        colour = COLOURS[row % len(COLOURS)]
        for column, (name, polar) in enumerate(places):
            axis = figure.add_subplot(grid[row, column])
            draw_section(axis, stations, polar, arguments.diameter_mm, colour, window)
            if row == 0:
                axis.set_title(name)
            if column == 0:
                axis.set_ylabel(run.label, color=colour, fontweight="bold")
    draw_gaps(figure.add_subplot(grid[-1, :]), runs, data, places, arguments)
    figure.savefig(arguments.output)
    print(f"wrote {arguments.output}")


def section_places(width, height):
    """Names and polar angles (rad) of the middles of the faces and of the corners between."""
    corner = np.arctan2(height, width)
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


def section_window(data, diameter):
    """Limits along y and of height that show every run to one scale, mm."""
    y = np.concatenate([stations["y"] for stations in data]) * 1e3
    height = np.concatenate([stations["height"] for stations in data]) * 1e3
    margin = 0.9 * diameter
    return (y.min() - margin, y.max() + margin), (-0.6 * diameter, height.max() + 1.6 * diameter)


def draw_section(axis, stations, polar, diameter, colour, window):
    (left, right), (bottom, top) = window
    axis.axhspan(bottom, 0, color="#c9ced6", linewidth=0)
    for turn, y, height in cut(stations, polar):
        wire = Circle(
            (y, height + diameter / 2),
            diameter / 2,
            facecolor=colour,
            edgecolor="white",
            linewidth=0.6,
            alpha=0.55 + 0.45 * (turn % 2),
        )
        axis.add_patch(wire)
        axis.text(
            y, height + diameter / 2, str(turn), ha="center", va="center_baseline",
            fontsize=6.5, color="white",
        )
    axis.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", xticks=[], yticks=[])
    axis.grid(False)
    for spine in axis.spines.values():
        spine.set_visible(False)


def draw_gaps(axis, runs, data, places, arguments):
    low, high = -0.5 * arguments.gap_limit, 2 * arguments.gap_limit
    for number, (run, stations) in enumerate(zip(runs, data)):
        of_turn = stations["turn"] == arguments.turn
        angle = np.degrees(stations["angle"][of_turn] - 2 * np.pi * (arguments.turn - 1))
        gap = stations["gap"][of_turn] * 1e3 / arguments.diameter_mm
        judged = stations["measured"][of_turn] > 0
        seen = gap[~np.isnan(gap)]
        low, high = min([low, *seen]), max([high, *seen])
        colour = COLOURS[number % len(COLOURS)]
        axis.plot(angle, np.where(judged, gap, np.nan), color=colour, label=run.label, linewidth=1.4)
        axis.plot(angle, np.where(judged, np.nan, gap), color=colour, linewidth=0.8, alpha=0.35)
    axis.axhline(arguments.gap_limit, color="#c8442d", linewidth=0.8, linestyle=(0, (4, 3)))
    axis.annotate(
        "gap limit", (0, arguments.gap_limit), xytext=(3, 3), textcoords="offset points",
        fontsize=7.5, color="#c8442d",
    )
    for name, polar in places:
        if name.startswith("corner"):
            axis.axvline(np.degrees(polar_phase(data[0], polar)), color="#c9ced6", linewidth=1.2, zorder=0)
    axis.set(
        xlim=(0, 360),
        ylim=(low - 0.05 * (high - low), high + 0.05 * (high - low)),
        xticks=range(0, 361, 45),
        xlabel=f"polar angle from the clamp in turn {arguments.turn} (degrees); corners marked, "
        "pale: near the clamp, not judged",
        ylabel="gap over diameter",
    )
    axis.legend(ncols=len(runs), loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2)


if __name__ == "__main__":
    main()
