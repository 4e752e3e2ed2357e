#!/usr/bin/env python3
"""The verdict table of the runs below a directory: on standard output, as CSV and as Markdown.

    verdicts.py target/demo

Writes verdicts.csv (SI units, full precision) and verdicts.md into the directory.
"""

import argparse
import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import numpy as np
from runs import by_speed, open_run, read_columns

# What the source paper says of its Fig. 8, by spindle speed in rad/s.
FIG8_CLAIMS = {30: "aligned", 100: "aligned", 300: "aligned", 500: "gap"}

STEADY_TURNS = 0.5
"""The run-up is not typical of a speed: tensions count from here on."""


@dataclass
class Row:
    """What the table tells of one run. Lengths in m, None where there is nothing to measure."""

    run: object
    turn: dict
    tension: tuple

    @classmethod
    def of(cls, run, turn):
        return cls(run, run.turn(turn), tension(run))

    @property
    def verdict(self):
        return self.turn.get("verdict", "unsettled")

    @property
    def claim(self):
        """What the paper says of this run, if it is one of its own."""
        run = self.run
        if not str(run.summary.get("scene", "")).startswith("fig8") or run.speed is None:
            return None
        return FIG8_CLAIMS.get(round(run.speed, 6))

    def of_summary(self, *keys):
        value = self.run.summary
        for key in keys:
            value = value.get(key) if isinstance(value, dict) else None
        return value


@dataclass
class Column:
    """A column: name and unit in the CSV, heading for people, how to read and how to show it."""

    name: str
    heading: str
    value: Callable
    scale: float = 1.0
    digits: int = 3
    unit: str = ""

    def shown(self, row):
        value = self.value(row)
        if value is None:
            return "–"
        if isinstance(value, str):
            return value
        # Rounding may leave a zero with a sign.
        return f"{round(value * self.scale, self.digits) + 0.0:.{self.digits}f}{self.unit}"


def columns(diameter):
    """The table's columns for a wire of this diameter, m."""
    over_d = 1 / diameter
    return [
        Column("speed_rad_per_s", "rad/s", lambda r: r.run.speed, digits=0),
        Column("ending", "run", lambda r: r.run.ending),
        Column("turn_settled", "at rest", lambda r: r.turn.get("settled", 0.0), 100, 0, " %"),
        Column("verdict", "verdict", lambda r: r.verdict),
        Column("claim_of_the_paper", "paper", lambda r: r.claim),
        Column("gap_mean_m", "gap mean/d", lambda r: r.turn.get("gap_mean"), over_d),
        Column("gap_max_m", "gap max/d", lambda r: r.turn.get("gap_max"), over_d),
        Column("gap_run", "gap run", lambda r: r.turn.get("gap_run"), 100, 0, " %"),
        Column("bulge_max_m", "bulge mm", lambda r: r.turn.get("bulge_max"), 1e3, 2),
        Column("bulge_excess_max_m", "excess/d", lambda r: r.turn.get("bulge_excess_max"), over_d, 2),
        Column("tension_min_N", "T min N", lambda r: r.tension[0], 1, 1),
        Column("tension_mean_N", "T mean N", lambda r: r.tension[1], 1, 1),
        Column("tension_max_N", "T max N", lambda r: r.tension[2], 1, 1),
        Column("penetration_over_d", "depth/d",
               lambda r: r.of_summary("penetration", "largest_over_d"), 100, 1, " %"),
        Column("residual_over_dissipated", "energy",
               lambda r: r.of_summary("energy", "residual_over_dissipated"), 100, 2, " %"),
        Column("wall_s", "wall s", lambda r: r.of_summary("wall_s"), 1, 2),
        Column("real_time_factor", "RTF", lambda r: r.of_summary("real_time_factor"), 1, 2),
    ]


NOTE = """\
Turn {turn}, as far as it is at rest, without the neighbourhood of the clamp; d = {d:g} mm. gap: centre
distance to the turn before, less d; run: longest stretch above 0.15 d, a gap from 10 % on. bulge:
height over the core; excess: over the quasi-static height of this wire. T: tension at the nozzle
after the first {steady:g} turns (a short run: all of it). depth: deepest contact. energy: what the
energy balance leaves unexplained over what was dissipated. RTF: simulated over wall time."""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", type=Path, help="directory that holds the runs")
    parser.add_argument("--turn", type=int, default=2, help="turn of the table, from 1")
    parser.add_argument("--diameter-mm", type=float, default=0.7, help="wire diameter")
    arguments = parser.parse_args()
    runs = runs_below(arguments.directory)
    if not runs:
        raise SystemExit(f"no summary.json below {arguments.directory}")

    rows = [Row.of(run, arguments.turn) for run in runs]
    table = columns(1e-3 * arguments.diameter_mm)
    note = NOTE.format(turn=arguments.turn, d=arguments.diameter_mm, steady=STEADY_TURNS)
    heads = [column.heading for column in table]
    cells = [[column.shown(row) for column in table] for row in rows]
    print("\n".join(aligned(heads, cells)))
    print(f"\n{note}")

    with open(arguments.directory / "verdicts.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(column.name for column in table)
        writer.writerows([column.value(row) for column in table] for row in rows)
    lines = ["|".join(["", *(f" {cell} " for cell in line), ""]) for line in [heads, *cells]]
    rule = "|" + "|".join(["---:"] * len(heads)) + "|"
    text = "\n".join([lines[0], rule, *lines[1:], "", note, ""])
    (arguments.directory / "verdicts.md").write_text(text, encoding="utf-8")


def runs_below(directory):
    """Every run that left a summary below a directory, by speed."""
    return by_speed(open_run(summary) for summary in sorted(directory.rglob("summary.json")))


def tension(run):
    """Least, mean and largest tension at the nozzle, N, after the run-up if there is more."""
    history = run.directory / "history.csv"
    if not history.exists():
        return None, None, None
    names = ["time", "spindle_angle", "wire_tension", "wire_tension_min", "wire_tension_max"]
    data = read_columns(history, names)
    turns = np.abs(data["spindle_angle"]) / (2 * np.pi)
    steady = turns >= STEADY_TURNS if turns[-1] > 1.5 * STEADY_TURNS else turns >= 0
    low, high = data["wire_tension_min"][steady].min(), data["wire_tension_max"][steady].max()
    time, pull = data["time"][steady], data["wire_tension"][steady]
    if len(time) < 2:
        return float(low), float(pull[0]), float(high)
    mean = np.sum(0.5 * (pull[1:] + pull[:-1]) * np.diff(time)) / (time[-1] - time[0])
    return float(low), float(mean), float(high)


def aligned(heads, rows):
    """Lines of a table whose columns are as wide as their widest cell."""
    widths = [max(map(len, column)) for column in zip(heads, *rows)]
    lines = [heads, ["-" * width for width in widths], *rows]
    return ["  ".join(cell.rjust(width) for cell, width in zip(line, widths)) for line in lines]


if __name__ == "__main__":
    main()
