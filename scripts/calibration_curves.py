"""Measured curves for scripts/calibrate.py: how they are read, and what is wrong with them."""

import csv
import functools
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from failure import Mistake

TURN = 2.0 * np.pi
ANGLES = {"angle_deg": np.radians(1.0), "angle_rad": 1.0, "turns": TURN}
# Between columns, where tables are not exported as CSV with commas.
SEPARATORS = {";": "semicolons", "\t": "tabs"}
LENGTHS = {"m": 1.0, "mm": 1e-3, "um": 1e-6}
UNITS = {
    "tension": {"N": 1.0, "mN": 1e-3, "cN": 1e-2},
    "coil_width": LENGTHS,
    "height": LENGTHS,
    "resistance": {"ohm": 1.0, "mohm": 1e-3},
}
# How far the zero of a measured angle is looked for, both ways: less than half the way between corners of a core, which are then not
# taken for one another.
ZERO_REACH = np.radians(15.0)
# Measured and computed levels that differ by more than this factor are of other units.
FOREIGN = 8.0
# Measured values that each parameter takes, so that noise can be told from a fit.
LEAST = 5


@dataclass
class Curve:
    """A measured quantity over the angle of the spindle (rad), in SI units."""

    source: Path
    column: str
    quantity: str
    unit: float
    angle: np.ndarray
    values: np.ndarray
    # standard deviation of the noise
    sigma: float = 1.0
    # of the turns of the run
    share: float = 1.0


def value_of(cell, column, where):
    """The number in a cell of a measured file; NaN where nothing was measured."""
    if not cell.strip():
        if column in ANGLES:
            raise Mistake(f"{where}: {column} is empty; give each row its angle")
        return np.nan
    try:
        value = float(cell)
    except ValueError:
        raise Mistake(f"{where}: {column} is {cell!r}, which is not a number") from None
    if not np.isfinite(value):
        raise Mistake(f"{where}: {column} is {cell!r}, which is not a finite number; leave the cell empty where nothing was measured")
    return value


def read_curves(path):
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            reader = csv.reader("\n" if line.startswith("#") else line for line in file)
            rows = [(reader.line_num, row) for row in reader if row]
    except UnicodeDecodeError:
        raise Mistake(f"{path} is no text in UTF-8; save it as CSV in UTF-8") from None
    except (OSError, csv.Error) as error:
        raise Mistake(f"{path} cannot be read: {error}") from None
    if len(rows) < 2:
        raise Mistake(f"{path} holds no measurement: give a header and a row for each angle")
    # A comma at the end of each line makes a last column of nothing.
    if not any(row[-1].strip() for _, row in rows) and len({len(row) for _, row in rows}) == 1:
        rows = [(line, row[:-1]) for line, row in rows]
    header = [name.strip() for name in rows[0][1]]
    if (foreign := next((name for mark, name in SEPARATORS.items() if mark in rows[0][1][0]), None)) is not None:
        raise Mistake(f"{path} has {foreign} between columns; save it with commas between columns and points in numbers")
    angles = [name for name in header if name in ANGLES]
    if len(angles) != 1:
        raise Mistake(f"{path} has {len(angles)} columns of the angle; give one, named {', '.join(ANGLES)}")
    numbers = {name: [] for name in header}
    for line, row in rows[1:]:
        if len(row) != len(header):
            raise Mistake(f"{path}:{line} has {len(row)} cells, the header has {len(header)}")
        for name, cell in zip(header, row):
            numbers[name].append(value_of(cell, name, f"{path}:{line}"))
    angle = ANGLES[angles[0]] * np.array(numbers.pop(angles[0]))
    if not np.all(np.diff(angle) > 0.0):
        raise Mistake(f"{path}: {angles[0]} has to rise from row to row")
    curves = []
    for column, values in numbers.items():
        quantity, _, unit = column.rpartition("_")
        if quantity not in UNITS:
            known = ", ".join(f"{name}_{'|'.join(units)}" for name, units in UNITS.items())
            raise Mistake(f"{path}: column {column} is none of {known}")
        if unit not in UNITS[quantity]:
            raise Mistake(f"{path}: column {column} has the unit {unit}; {quantity} takes {', '.join(UNITS[quantity])}")
        factor, values = UNITS[quantity][unit], np.array(values)
        there = np.isfinite(values)
        curves.append(Curve(path, column, quantity, factor, angle[there], factor * values[there]))
    if not curves or any(curve.angle.size == 0 for curve in curves):
        raise Mistake(f"{path} has a column without a measurement")
    return curves


@functools.lru_cache(maxsize=64)
def columns(path, *names):
    with open(path, newline="", encoding="utf-8") as file:
        reader = csv.reader(file)
        header = next(reader)
        places = [header.index(name) for name in names]
        rows = [[float(row[place]) for place in places] for row in reader]
    return np.array(rows).reshape(-1, len(names)).T


def too_few(points, parameters):
    return Mistake(f"{points} measured values are too few for {parameters} parameters; measure at {LEAST * parameters} angles or more")


def check_levels(curves, computed):
    """A mistake where a measured curve is so far from the first run that its unit must be another."""
    for curve, values in zip(curves, computed):
        measured, expected = np.median(np.abs(curve.values)), np.nanmedian(np.abs(values))
        if expected > 0.0 and not 1.0 / FOREIGN < measured / expected < FOREIGN:
            raise Mistake(
                f"{curve.source}: {curve.column} is {measured / expected:.3g} times what the scene gives ({expected / curve.unit:.3g}); "
                "is its unit the one in its name? If so, give starts nearer to the machine with --fit NAME=VALUE or --set"
            )


def rms(residual):
    return float(np.sqrt(np.nanmean(residual**2)))
