"""Reading what `coilwind run` leaves behind, shared by the plot scripts."""

import csv
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    import tomli as tomllib

from failure import Mistake

# Calm to alarming: runs are plotted in the order of their speed.
COLOURS = ["#33658a", "#2a9d8f", "#e0a030", "#c8442d", "#7a3b69", "#555b6e"]

STYLE = {
    "figure.dpi": 150,
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#8a8f98",
    "axes.labelcolor": "#30343b",
    "axes.titlesize": 9.5,
    "axes.grid": True,
    "figure.constrained_layout.h_pad": 0.08,
    "figure.constrained_layout.w_pad": 0.08,
    "grid.color": "#e6e8eb",
    "grid.linewidth": 0.7,
    "axes.axisbelow": True,
    "xtick.color": "#5b616b",
    "ytick.color": "#5b616b",
    "legend.frameon": False,
}


@dataclass
class Run:
    """One run: its directory, its summary (empty if there is none) and its spindle speed."""

    directory: Path
    summary: dict

    @property
    def speed(self):
        """Spindle speed in rad/s, None if nothing tells.

        The demonstration names its directories by it; the summary knows the last speed, which is
        a lower one where a run ended in the ramp. Members of ensembles have numbers as names too.
        """
        speed = self.summary.get("speed_rad_per_s")
        try:
            named = float(self.directory.resolve().name)
        except ValueError:
            named = None
        if named is not None and abs(speed or 0.0) <= named * (1 + 1e-6):
            return named
        # Held inputs are means over a step, and their rounding should not show.
        return None if speed is None else float(f"{speed:.9g}")

    @property
    def label(self):
        if self.speed is None:
            return self.directory.name or str(self.directory)
        return f"{self.speed:g} rad/s"

    @property
    def ending(self):
        """`done`, `interrupted` or `failed`; `no results` without a summary."""
        return self.summary.get("status", "no results")

    @property
    def scene(self):
        """The scene that was wound, SI units, its default values filled in: a dictionary for each table of the file."""
        path = self.directory / "scene.toml"
        try:
            return tomllib.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            raise Mistake(f"{path} is missing; it says what was wound, so wind the scene again") from None
        except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
            raise Mistake(f"{path} is not whole ({error}); wind the scene again") from None

    @property
    def diameter(self):
        """Outer diameter of the wire, m."""
        try:
            wire = self.scene["wire"]
            # Zero stands for bare wire.
            return wire["enamelled_diameter"] or wire["diameter"]
        except (KeyError, TypeError) as error:
            raise Mistake(f"{self.directory / 'scene.toml'} has no {error}; it has to be the file that a run leaves") from None

    def turn(self, number):
        """Measures of a turn (from 1), empty if it has not settled."""
        turns = self.summary.get("turns", [])
        return next((turn for turn in turns if turn.get("turn") == number), {})


def open_run(path):
    """The run that a directory, or a file in it, belongs to."""
    path = Path(path)
    directory = path if path.is_dir() else path.parent
    summary = directory / "summary.json"
    return Run(directory, json.loads(summary.read_text()) if summary.exists() else {})


def find_file(path, name):
    """A file given itself, or by its directory."""
    path = Path(path)
    return path / name if path.is_dir() else path


def by_speed(runs):
    """Runs in the order of their speed; those without one come last, by name."""
    return sorted(runs, key=lambda run: (run.speed is None, run.speed or 0, str(run.directory)))


def read_columns(path, needed):
    """Columns of a table of a run as arrays; an empty cell is NaN, and a last row that a kill has cut is left out. Exits with a message on bad input."""
    try:
        with open(path, newline="") as file:
            lines = file.read().splitlines(keepends=True)
            rows = list(csv.DictReader(line for line in lines if line.endswith("\n")))
    except OSError as error:
        raise SystemExit(f"cannot read {path}: {error.strerror}") from error
    if not rows:
        raise SystemExit(f"{path} has no rows")
    missing = [name for name in needed if name not in rows[0]]
    if missing:
        raise SystemExit(f"{path} has no column {', '.join(missing)}")
    try:
        return {
            name: np.array([float(row[name]) if row[name] else np.nan for row in rows])
            for name in needed
        }
    except ValueError as error:
        raise SystemExit(f"{path}: {error}") from error
