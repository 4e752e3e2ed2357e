#!/usr/bin/env python3
"""The verdict table of the runs below a directory: on standard output, as CSV and as Markdown.

    verdicts.py target/demo

A row tells of the verdict on the whole coil and of one turn of it (--turn). Wire diameters are those of the scene.toml in each folder.
Writes verdicts.csv (SI units, full precision) and verdicts.md into the directory.
"""

import argparse
import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import numpy as np
from failure import Mistake, told
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
    diameter: float
    folder: str

    @classmethod
    def of(cls, run, turn, below):
        place = run.directory.relative_to(below)
        folder = place.as_posix() if place.parts else run.directory.resolve().name
        return cls(run, run.turn(turn), tension(run), run.diameter, folder)

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
    # whether people see it in diameters of the wire
    over_d: bool = False

    def shown(self, row):
        value = self.value(row)
        if value is None:
            return "–"
        if isinstance(value, str):
            return value
        scale = self.scale / row.diameter if self.over_d else self.scale
        # Rounding may leave a zero with a sign.
        return f"{round(value * scale, self.digits) + 0.0:.{self.digits}f}{self.unit}"


def columns(turn):
    """The columns of the table of this turn."""
    of_turn = f"turn {turn}: "
    return [
        Column("folder", "folder", lambda r: r.folder),
        Column("speed_rad_per_s", "rad/s", lambda r: r.run.speed, digits=0),
        Column("diameter_m", "d mm", lambda r: r.diameter, 1e3, 2),
        Column("ending", "run", lambda r: r.run.ending),
        Column("coil_verdict", "coil: verdict", lambda r: r.of_summary("verdict")),
        Column("turn_settled", f"{of_turn}at rest", lambda r: r.turn.get("settled", 0.0), 100, 0, " %"),
        Column("turn_verdict", f"{of_turn}verdict", lambda r: r.verdict),
        Column("claim_of_the_paper", "paper", lambda r: r.claim),
        Column("gap_mean_m", "gap mean/d", lambda r: r.turn.get("gap_mean"), over_d=True),
        Column("gap_max_m", "gap max/d", lambda r: r.turn.get("gap_max"), over_d=True),
        Column("gap_run", "gap run", lambda r: r.turn.get("gap_run"), 100, 0, " %"),
        Column("bulge_max_m", "bulge mm", lambda r: r.turn.get("bulge_max"), 1e3, 2),
        Column("bulge_excess_max_m", "excess/d", lambda r: r.turn.get("bulge_excess_max"), digits=2, over_d=True),
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
coil: the verdict on the whole coil, the worst of its turns. gap, bulge and excess are those of turn {turn},
as far as it is at rest, without the neighbourhood of the clamp; d: outer diameter of the wire. gap: centre
distance to the turn before, less d; run: longest stretch above the scene's defects.gap. bulge: height over
the core; excess: over the quasi-static height of this wire. T: tension at the nozzle after the first
{steady:g} turns (a short run: all of it). depth: deepest contact. energy: what the
energy balance leaves unexplained over what was dissipated. RTF: simulated over wall time."""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=Path, metavar="DIR", help="directory that holds the runs")
    parser.add_argument("--turn", type=int, default=2, metavar="N", help="turn of the table, from 1 (default: 2)")
    arguments = parser.parse_args()
    with told(parser.prog):
        tell(arguments)


def tell(arguments):
    """Prints the table and writes its files."""
    runs = runs_below(arguments.directory)
    if not runs:
        raise Mistake(f"no summary.json below {arguments.directory}; name a folder that holds folders of runs")

    rows = [Row.of(run, arguments.turn, arguments.directory) for run in runs]
    table = columns(arguments.turn)
    note = NOTE.format(turn=arguments.turn, steady=STEADY_TURNS)
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
    print(f"wrote {arguments.directory / 'verdicts.csv'}, {arguments.directory / 'verdicts.md'}")


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
