#!/usr/bin/env python3
"""Wire tension over spindle angle, one panel per run.

    plot_tension.py target/demo/* -o target/demo/tension.png

Each argument is a run's directory or its history.csv.
"""

import argparse
from pathlib import Path

import folder as folders
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from failure import told
from runs import COLOURS, STYLE, by_speed, find_file, open_run, read_columns
from verdicts import STEADY_TURNS

COLUMNS = ["spindle_angle", "wire_tension", "wire_tension_min", "wire_tension_max"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="+", help="directory of a run, or its history.csv")
    parser.add_argument("-o", "--output", type=Path, default=Path("tension.png"), help="picture to write")
    arguments = parser.parse_args()

    with told(parser.prog):
        plot(arguments)
        print(f"wrote {arguments.output}")


def plot(arguments):
    files = {}
    for path in arguments.runs:
        run = open_run(path)
        files[run.directory] = (run, find_file(path, "history.csv"))
    runs = by_speed(run for run, _ in files.values())

    plt.rcParams.update(STYLE)
    height = 0.6 + 1.75 * len(runs)
    figure, axes = plt.subplots(
        len(runs), 1, figsize=(8, height), sharex=True, sharey=True, squeeze=False,
        layout="constrained",
    )
    low, high, spans = 0.0, 0.0, []
    for number, (axis, run) in enumerate(zip(axes[:, 0], runs)):
        data = read_columns(files[run.directory][1], COLUMNS)
        draw(axis, titled(run), data, COLOURS[number % len(COLOURS)])
        low = min(low, data["wire_tension_min"].min())
        high = max(high, data["wire_tension_max"].max())
        spans.append(data["spindle_angle"][[0, -1]] / (2 * np.pi))
    # One scale for all runs, from zero, so that swings compare by eye.
    axes[0, 0].set_ylim(1.1 * low, 1.12 * max(high, 1e-9))
    axes[0, 0].set_xlim(np.min(spans), np.max(spans))
    axes[-1, 0].set_xlabel("turns of the spindle from the start position")
    figure.supylabel("wire tension at the nozzle (N)", fontsize=9, color="#30343b")
    folders.write_whole(arguments.output, figure.savefig)


def titled(run):
    """Speed and folder: runs of one speed are told apart."""
    folder = run.directory.resolve().name
    if run.speed is None:
        return folder
    # (a folder may be named by the speed)
    return run.label if run.label.startswith(f"{folder} ") else f"{run.label}, {folder}"


def draw(axis, title, data, colour):
    turns, tension = data["spindle_angle"] / (2 * np.pi), data["wire_tension"]
    low, high = data["wire_tension_min"], data["wire_tension_max"]
    # Between communication points the wire swings faster than the line can show.
    axis.fill_between(turns, low, high, color=colour, alpha=0.25, linewidth=0)
    axis.plot(turns, tension, color=colour, linewidth=0.9)
    # The run-up is not typical of the speed.
    steady = np.abs(turns) >= STEADY_TURNS
    note = f"after {STEADY_TURNS:g} turns: "
    if np.abs(turns[-1]) <= 1.5 * STEADY_TURNS:
        steady, note = np.full(len(turns), True), ""
    mean = np.mean(tension[steady])
    axis.axhline(mean, color="#5b616b", linewidth=0.7, linestyle=(0, (4, 3)))
    axis.set_title(title, loc="left", fontweight="bold", color=colour)
    note += f"mean {mean:.1f} N, {low[steady].min():.1f} to {high[steady].max():.1f} N"
    axis.set_title(note, loc="right", color="#5b616b", fontsize=8)


if __name__ == "__main__":
    main()
