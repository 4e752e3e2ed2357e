"""Reading what `coilwind run` leaves behind, shared by the plot scripts."""

import csv
import json
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    import tomli as tomllib

import folder as folders
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
    directory = path.parent if path.is_file() else path
    if directory == path:
        folders.refuse_without_run(path)
    summary = directory / "summary.json"
    if not summary.exists():
        return Run(directory, {})
    try:
        return Run(directory, dict(json.loads(summary.read_text(encoding="utf-8"))))
    except (ValueError, TypeError) as error:
        raise broken(summary, error) from None


def broken(path, reason):
    """The mistake that a file of a run is not whole, as `coilwind report` tells it."""
    return Mistake(f"{path.parent}: {path.name} is not whole ({reason}); {folders.wind_again(path.parent)}")


def find_file(path, name):
    """A file given itself, or by its directory."""
    path = Path(path)
    return path / name if path.is_dir() else path


def by_speed(runs):
    """Runs in the order of their speed; those without one come last, by name."""
    return sorted(runs, key=lambda run: (run.speed is None, run.speed or 0, str(run.directory)))


def read_columns(path, needed):
    """Columns of a table of a run as arrays; an empty cell is NaN. Raises `Mistake` where the table has no rows or is not whole."""
    columns = table(path, needed)
    if not columns[needed[0]].size:
        raise Mistake(f"{path} has no rows; wind for longer")
    return columns


def table(path, needed):
    """As `read_columns`, of a table that may have no rows."""
    path = Path(path)
    try:
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    except FileNotFoundError:
        raise Mistake(f"{path} is missing; name the folder of a run (coilwind run SCENE --out DIR)") from None
    except UnicodeDecodeError as error:
        raise broken(path, error) from None
    if lines and not lines[-1].endswith("\n"):
        # The history of a run grows as long as the run goes on, and a kill may cut its last row.
        if (path.parent / "summary.json").exists() and not folders.is_under_way(path.parent):
            raise broken(path, f"line {len(lines)} is cut")
        print(f"warning: {path}: line {len(lines)} is cut and left out, as the run has not ended", file=sys.stderr)
        del lines[-1]
    header, *rows = csv.reader(lines) if lines else [[]]
    for line, row in enumerate(rows, 2):
        if len(row) != len(header):
            raise broken(path, f"line {line} has {len(row)} cells, the header has {len(header)}")
    try:
        places = {name: header.index(name) for name in needed}
        return {name: np.array([float(row[place]) if row[place] else np.nan for row in rows]) for name, place in places.items()}
    except ValueError as error:
        missing = [name for name in needed if name not in header]
        raise broken(path, f"column {missing[0]} is missing" if missing else error) from None
