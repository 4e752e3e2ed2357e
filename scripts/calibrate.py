#!/usr/bin/env python3
"""Fits parameters of a scene to what was measured on a machine.

    calibrate.py SCENE.toml --measured FILE.csv --fit tensioner.mass=0.002 --fit wire.yield_stress=1e8 --out DIR

The Python is that of `scripts/venv.sh study`. A measured file has a column of the spindle's angle (angle_deg, angle_rad or
turns) and one or more of

    tension_N      wire tension at the nozzle (also _mN, _cN)
    coil_width_mm  width of the settled wire along the core (also _m, _um)
    height_mm      height of the settled wire over the core, over the angle from the clamp (also _m, _um)
    resistance_ohm of the wire from the clamp on, at 20 degC (also _mohm)

Every parameter starts from the value behind its name, or from the scene's, and stays within a factor of ten of it. Least
squares in the logarithms of the parameters, with derivatives by central differences; each run is `coilwind run` and all
cores work. DIR gets calibration.json, residuals.csv and residuals.png. After Ctrl-C and SIGTERM they hold the best parameters so far.

Exit codes: 0 fitted, 1 nothing is fitted: a parameter ended at an end of its range, or the measurement does not determine it,
2 a mistake that can be mended, 3 a full disk, 130 stopped.
"""

import argparse
import csv
import json
import os
import shlex
import subprocess
import sys
import tempfile
import tomllib
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import folder as folders
from failure import Interrupted, Mistake, told

TURN = 2.0 * np.pi
ANGLES = {"angle_deg": np.radians(1.0), "angle_rad": 1.0, "turns": TURN}
LENGTHS = {"m": 1.0, "mm": 1e-3, "um": 1e-6}
UNITS = {
    "tension": {"N": 1.0, "mN": 1e-3, "cN": 1e-2},
    "coil_width": LENGTHS,
    "height": LENGTHS,
    "resistance": {"ohm": 1.0, "mohm": 1e-3},
}
# Differences of the logarithm of a parameter, both ways: large against what a run's adaptive steps scatter by.
DIFFERENCE = 0.03
# How far around a solution is looked for a better one, in the logarithms, and how often.
LOOKS = (0.01, 0.03, 0.06)
ROUNDS = 4
# A parameter may go as far from its start, as a factor.
REACH = 10.0
# Of the way there, in the logarithm: from here on it is at the end of its range.
NEAR = 0.99
# Share of measured heights that has to lie on settled wire.
SETTLED = 0.8
# Measured and computed levels that differ by more than this factor are of other units.
FOREIGN = 8.0
# Shares of the run's turns: a curve over less than the first is told of, over less than the second its angle has another unit (1/57).
SHORT, FOREIGN_ANGLE = 0.25, 0.04
# Measured values that each parameter takes, so that noise can be told from a fit.
LEAST = 5
# Of 1: above it, residuals are not noise, or two parameters cannot be told apart.
CORRELATED, AUTOCORRELATED = 0.95, 0.5
# Of the sum of squares: less than this is no gain over the start.
GAIN = 0.01
# Rest over variation of a curve from which on a solution is none; one that hardly varies counts as varying by this share of its level.
FAR_MORE, LEVEL = 3.0, 0.1


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


def read_curves(path):
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            rows = list(csv.reader(line for line in file if not line.startswith("#")))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise Mistake(f"{path} cannot be read: {error}") from None
    if len(rows) < 2:
        raise Mistake(f"{path} holds no measurement: give a header and a row for each angle")
    header = [name.strip() for name in rows[0]]
    angles = [name for name in header if name in ANGLES]
    if len(angles) != 1:
        raise Mistake(f"{path} has {len(angles)} columns of the angle; give one, named {', '.join(ANGLES)}")
    numbers = {name: [] for name in header}
    for line, row in enumerate(rows[1:], 2):
        if len(row) != len(header):
            raise Mistake(f"{path}:{line} has {len(row)} cells, the header has {len(header)}")
        for name, cell in zip(header, row):
            try:
                numbers[name].append(float(cell) if cell.strip() else np.nan)
            except ValueError:
                raise Mistake(f"{path}:{line}: {name} is {cell!r}, which is not a number") from None
    angle = ANGLES[angles[0]] * np.array(numbers.pop(angles[0]))
    if not np.all(np.diff(angle) > 0.0):
        raise Mistake(f"{path}: {angles[0]} has to rise from row to row")
    curves = []
    for column, values in numbers.items():
        quantity, _, unit = column.rpartition("_")
        if quantity not in UNITS:
            known = ", ".join(f"{name}_{next(iter(units))}" for name, units in UNITS.items())
            raise Mistake(f"{path}: column {column} is none of {known}")
        if unit not in UNITS[quantity]:
            raise Mistake(f"{path}: column {column} has the unit {unit}; {quantity} takes {', '.join(UNITS[quantity])}")
        factor, values = UNITS[quantity][unit], np.array(values)
        there = np.isfinite(values)
        curves.append(Curve(path, column, quantity, factor, angle[there], factor * values[there]))
    if not curves or any(curve.angle.size == 0 for curve in curves):
        raise Mistake(f"{path} has a column without a measurement")
    return curves


class Model:
    """Runs of the scene, as measured."""

    def __init__(self, command, scene, sets, names, curves, folder):
        self.command, self.scene, self.sets = command, scene, sets
        self.names, self.curves, self.folder = names, curves, Path(folder)
        self.runs = 0
        self.going, self.stopped, self.lock = set(), False, threading.Lock()
        listed = subprocess.run([command, "variables", "--json"], capture_output=True, text=True, check=True).stdout
        self.table = {row["name"]: row for row in json.loads(listed)}

    def wind(self, values):
        """Computed curves with these values of the parameters."""
        out = self.run(values)
        return [self.compare(curve, out) for curve in self.curves]

    def settings(self):
        """The scene with its settings, as a run leaves it."""
        return tomllib.loads((self.run([]) / "scene.toml").read_text(encoding="utf-8"))

    def run(self, values):
        """The folder of a run."""
        out = Path(tempfile.mkdtemp(dir=self.folder))
        words = [f"{name}={value!r}" for name, value in zip(self.names, map(float, values))]
        words = [word for setting in [*self.sets, *words] for word in ("--set", setting)]
        files = ["--no-geometry", "--no-report", "--quiet", "--force", "--out", out]
        code, said = self.start([self.command, "run", self.scene, *words, *files])
        self.runs += 1
        if code:
            reason = (said.strip().splitlines() or ["the run failed"])[0]
            raise Mistake(f"with {', '.join(words[1::2]) or self.scene}: {reason}")
        return out

    def start(self, line):
        """Exit code of a command and what it said. `stop` ends it."""
        with self.lock:
            if self.stopped:
                raise Mistake("stopped")
            # In a session of its own: Ctrl-C on a terminal would have it write its results, which nobody reads.
            child = subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True)
            self.going.add(child)
        try:
            said = child.communicate()[1]
        except BaseException:
            child.kill()
            raise
        with self.lock:
            self.going.remove(child)
        return child.returncode, said

    def stop(self):
        """Ends the runs that go on; none begins after it."""
        with self.lock:
            self.stopped = True
            for child in self.going:
                child.kill()

    def compare(self, curve, out):
        if curve.quantity == "height":
            angle, values = columns(out / "stations.csv", "angle", "height")
        else:
            column = {"tension": "wire_tension", "coil_width": "coil_width", "resistance": "wire_length"}[curve.quantity]
            angle, values = columns(out / "history.csv", "spindle_angle", column)
            if curve.quantity == "resistance":
                product = json.loads((out / "summary.json").read_text(encoding="utf-8"))["product"]
                if not product["wire_length_m"]:
                    raise Mistake("no wire has settled; wind more turns to compare resistances")
                values = values * product["resistance_ohm"] / product["wire_length_m"]
        angle = np.abs(angle)
        covered = (curve.angle >= angle[0] - 1e-6) & (curve.angle <= angle[-1] + 1e-6) if angle.size > 1 else np.zeros(1, bool)
        # How much wire settles depends on the parameters a little; what has not counts for nothing.
        if np.mean(covered) < (SETTLED if curve.quantity == "height" else 1.0):
            low, high = (angle[0], angle[-1]) if angle.size else (0.0, 0.0)
            raise Mistake(
                f"{curve.source}: {curve.column} is measured from {curve.angle[0] / TURN:.2f} to {curve.angle[-1] / TURN:.2f} turns, "
                f"{'settled wire of the run goes' if curve.quantity == 'height' else 'the run goes'} from {low / TURN:.2f} to "
                f"{high / TURN:.2f}; wind more with --set spindle.turns=N, or cut the file"
            )
        curve.share = np.ptp(curve.angle) / np.ptp(angle)
        if curve.share < FOREIGN_ANGLE:
            raise Mistake(
                f"{curve.source}: {curve.column} is measured over {np.ptp(curve.angle) / TURN:.3g} of the {np.ptp(angle) / TURN:.3g} turns of the run; "
                "is the angle in the unit of its column (angle_deg, angle_rad, turns)? If so, wind less with --set spindle.turns=N"
            )
        return np.where(covered, np.interp(curve.angle, angle, values), np.nan)


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


class Fit:
    """Least squares over the logarithms of the parameters, relative to where they start."""

    def __init__(self, model, starts, threads):
        self.model, self.starts = model, np.array(starts)
        self.pool = ThreadPoolExecutor(threads)
        self.seen = {}

    def computed(self, points):
        """Curves at several points at once."""
        keys = [tuple(point) for point in points]
        fresh = [key for key in dict.fromkeys(keys) if key not in self.seen]
        # Kept as they come, so that a fit that is stopped has them.
        for key in self.pool.map(self.look, fresh):
            assert key in self.seen
        return [self.seen[key] for key in keys]

    def look(self, key):
        self.seen[key] = self.model.wind(self.starts * np.exp(key))
        return key

    def stop(self):
        """Ends the runs that go on, and waits for their end."""
        self.model.stop()
        self.pool.shutdown(cancel_futures=True)

    def best(self):
        """The best point so far and its curves; `None` before the first run has ended."""
        return min(self.seen.items(), key=lambda item: np.sum(self.weighed(item[1]) ** 2), default=None)

    def weighed(self, computed):
        pieces = [np.nan_to_num((values - curve.values) / curve.sigma) for curve, values in zip(self.model.curves, computed)]
        return np.concatenate(pieces)

    def residuals(self, point):
        return self.weighed(self.computed([point])[0])

    def jacobian(self, point):
        steps = DIFFERENCE * np.eye(len(point))
        points = [point + sign * step for step in steps for sign in (1, -1)]
        found = [self.weighed(computed) for computed in self.computed(points)]
        return np.column_stack([(found[2 * k] - found[2 * k + 1]) / (2 * DIFFERENCE) for k in range(len(point))])

    def solve(self, point):
        from scipy import optimize

        reach = np.log(REACH)
        return optimize.least_squares(
            self.residuals, point, self.jacobian, bounds=(-reach, reach), xtol=2e-3, ftol=1e-5, gtol=1e-10, max_nfev=25
        )

    def settle(self, found):
        """Looks past the dips that ringing and adaptive steps leave in the sum of squares: along the axes of the valley."""
        for _ in range(ROUNDS):
            _, axes = np.linalg.eigh(found.jac.T @ found.jac)
            points = [found.x + reach * sign * axis for axis in axes.T for reach in LOOKS for sign in (1, -1)]
            points = [np.clip(point, -np.log(REACH), np.log(REACH)) for point in points]
            costs = [0.5 * np.sum(self.weighed(computed) ** 2) for computed in self.computed(points)]
            best = int(np.argmin(costs))
            if costs[best] > (1.0 - 1e-3) * found.cost:
                break
            found = self.solve(points[best])
        return found


@dataclass
class Answer:
    """What a fit says: the solution, and standard deviations and correlations of the logarithms."""

    found: object
    deviation: np.ndarray
    correlation: np.ndarray
    freedom: int
    computed: list
    # sum of squares at the start over that at the solution
    gain: float


def calibrate(fit):
    model, parameters = fit.model, len(fit.starts)
    start = fit.computed([np.zeros(parameters)])[0]
    check_levels(model.curves, start)
    if (points := sum(curve.angle.size for curve in model.curves)) < LEAST * parameters:
        raise too_few(points, parameters)
    for curve in model.curves:
        curve.sigma = np.std(curve.values) or 1.0
    found = fit.settle(fit.solve(np.zeros(parameters)))
    if len(model.curves) > 1:
        # Each curve counts by its own noise, which is known once it has been fitted.
        for curve, values in zip(model.curves, fit.computed([found.x])[0]):
            curve.sigma = max(rms(values - curve.values), 1e-9 * curve.sigma)
        found = fit.settle(fit.solve(found.x))
    freedom = np.count_nonzero(found.fun) - parameters
    jacobian = fit.jacobian(found.x)
    square = np.sum(found.fun**2)
    covariance = np.linalg.pinv(jacobian.T @ jacobian) * square / freedom
    deviation = np.sqrt(np.diag(covariance))
    blind = np.linalg.norm(jacobian, axis=0) < 1e-9
    deviation[blind] = np.inf
    with np.errstate(invalid="ignore"):
        correlation = covariance / np.outer(deviation, deviation)
    gain = np.sum(fit.weighed(start) ** 2) / square if square > 0.0 else np.inf
    return Answer(found, deviation, correlation, freedom, fit.computed([found.x])[0], gain)


def rms(residual):
    return float(np.sqrt(np.nanmean(residual**2)))


def autocorrelation(residual):
    residual = residual[np.isfinite(residual)]
    residual = residual - np.mean(residual)
    power = np.sum(residual**2)
    return float(np.sum(residual[1:] * residual[:-1]) / power) if power > 0.0 else 0.0


def ends_of(names, found):
    """The parameters that ended at an end of their range, and which end: there is no minimum within the range."""
    reach = np.log(REACH)
    at = {name: x for name, x, active in zip(names, found.x, found.active_mask) if active or abs(x) > NEAR * reach}
    return {name: "lower" if x < 0.0 else "upper" for name, x in at.items()}


def explains_nothing(answer, curves):
    """Why the solution is no fit: it leaves as much as was measured, which is no noise, and is no better than its start or leaves far more."""
    left = [curve.values - values for curve, values in zip(curves, answer.computed)]
    if not all(autocorrelation(rest) > AUTOCORRELATED for rest in left):
        return None
    varies = [np.std(curve.values) for curve in curves]
    if all(rms(rest) > FAR_MORE * max(by, LEVEL * rms(curve.values)) for curve, rest, by in zip(curves, left, varies)):
        return "what the solution leaves is far more than what was measured varies by"
    if all(rms(rest) >= by for rest, by in zip(left, varies)) and answer.gain < 1.0 + GAIN:
        return "the solution is no better than its start, and what it leaves is as large as what was measured"
    return None


def warnings_of(names, answer, curves):
    found, deviation, correlation, computed = answer.found, answer.deviation, answer.correlation, answer.computed
    for k, name in enumerate(names):
        if not deviation[k] < 0.5:
            yield f"{name} hardly shows in what was measured: measure something else, or leave it out"
        for other in range(k):
            if abs(correlation[k, other]) > CORRELATED:
                yield f"{names[other]} and {name} cannot be told apart (correlation {correlation[k, other]:.2f}): fit one of them"
    for curve, values in zip(curves, computed):
        if (along := autocorrelation(curve.values - values)) > AUTOCORRELATED:
            yield f"what is left of {curve.column} is no noise (autocorrelation {along:.2f}): the scene differs from the machine in something else, and the intervals are too narrow"
        if curve.share < SHORT:
            yield f"{curve.column} is measured over {curve.share:.0%} of the turns of the run: see that the angle is in the unit of its column"
    if not found.success:
        yield "the search ended before it converged; start again from these values"


def draw(path, curves, computed):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from runs import COLOURS, STYLE

    plt.rcParams.update(STYLE)
    figure, axes = plt.subplots(2, len(curves), figsize=(5.2 * len(curves) + 1, 4.6), squeeze=False, sharex="col", layout="constrained", height_ratios=[2, 1])
    for (above, below), curve, values in zip(axes.T, curves, computed):
        turns = curve.angle / TURN
        above.plot(turns, curve.values / curve.unit, ".", color=COLOURS[0], markersize=2.5, label="measured")
        above.plot(turns, values / curve.unit, color=COLOURS[3], linewidth=1.1, label="fitted")
        above.set_ylabel(curve.column)
        above.legend(frameon=False, fontsize=8)
        below.axhline(0.0, color="#5b616b", linewidth=0.7)
        below.plot(turns, (curve.values - values) / curve.unit, ".", color=COLOURS[0], markersize=2.5)
        below.set_ylabel("measured - fitted")
        below.set_xlabel("turns of the spindle")
    figure.savefig(path, format="png")
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help="scene file, or the name of a packed scene")
    parser.add_argument("--measured", action="append", required=True, type=Path, metavar="FILE.csv", help="may be given several times")
    parser.add_argument("--fit", action="append", required=True, metavar="NAME[=START]", help="parameter, in SI; starts from START, else from --set, else from the scene; may be given several times")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="as for coilwind run")
    parser.add_argument("--out", type=Path, default=Path("calibration"), metavar="DIR", help="where results go (default: calibration)")
    parser.add_argument("--confidence", type=float, default=0.95, metavar="P", help="of the intervals (default: 0.95)")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), metavar="N", help="runs at a time (default: all cores)")
    parser.add_argument("--force", action="store_true", help="write into a DIR that holds a calibration, a run or a sweep")
    parser.add_argument("--command", type=Path, default=folders.COMMAND, help=argparse.SUPPRESS)
    args = parser.parse_args()
    with told(parser.prog):
        sys.exit(run(args))


def starts_of(model, wanted):
    """Starting values: those given, else those of the scene with its settings."""
    names, starts, scene = [], [], None
    for text in wanted:
        name, _, value = text.partition("=")
        if name in names:
            raise Mistake(f"--fit {name} is given twice; leave one out")
        if name not in model.table:
            raise Mistake(f"--fit {name}: there is no such parameter; `coilwind variables` lists them, without units in their names")
        if value and (twice := set_of(model, name)):
            raise Mistake(f"--fit {text} and --set {twice} both say where {name} starts; leave one out")
        if not value:
            scene = scene or model.settings()
            value = scene
            for key in name.split("."):
                value = value.get(key, {}) if isinstance(value, dict) else {}
            value = value if value != {} else model.table[name]["start"]
        try:
            start = float(value)
        except (TypeError, ValueError):
            raise Mistake(f"--fit {text}: {value} is not a number") from None
        if not start > 0.0:
            raise Mistake(f"--fit {name}: it starts from {start:g}; give a start above zero: --fit {name}=VALUE")
        names.append(name)
        starts.append(start)
    return names, starts


def set_of(model, name):
    """The --set of this parameter, in whatever unit; `None` without one."""
    keys = {name, *(f"{name}_{unit}" for unit in model.table[name]["keySuffixes"])}
    return next((text for text in model.sets if text.partition("=")[0] in keys), None)


def run(args):
    """Fits, tells and writes; the exit code."""
    folders.need(args.command, folders.COMMAND_BUILD)
    if not 0.5 <= args.confidence < 1.0:
        raise Mistake(f"--confidence {args.confidence:g} has to be at least 0.5 and below 1")
    if args.threads < 1:
        raise Mistake(f"--threads {args.threads} has to be at least 1")
    folders.refuse_occupied(args.out, args.force)
    curves = [curve for path in args.measured for curve in read_curves(path)]
    points = sum(curve.angle.size for curve in curves)
    if points <= len(args.fit):
        raise too_few(points, len(args.fit))
    with tempfile.TemporaryDirectory() as folder:
        model = Model(args.command, args.scene, args.set, [], curves, folder)
        names, starts = starts_of(model, args.fit)
        model.names = names
        fit = Fit(model, starts, args.threads)
        try:
            answer = calibrate(fit)
        except KeyboardInterrupt:
            fit.stop()
            raise Interrupted(keep_best(args, fit)) from None
    return tell(args, model, starts, answer)


def tell(args, model, starts, answer):
    """Prints the outcome, then writes it: a full disk takes nothing from who reads along. The exit code."""
    from scipy import stats

    names, curves, computed = model.names, model.curves, answer.computed
    best = np.array(starts) * np.exp(answer.found.x)
    width = stats.t.ppf(0.5 + 0.5 * args.confidence, answer.freedom) * answer.deviation
    with np.errstate(over="ignore"):
        low, high = best * np.exp(-width), best * np.exp(width)
    ends = ends_of(names, answer.found)
    open_ = [name for name, wide in zip(names, width) if not wide < np.log(REACH) and name not in ends]
    nothing, told_of = explains_nothing(answer, curves), list(warnings_of(names, answer, curves))

    print(f"{'parameter':32} {'start':>11} {'fitted':>11}   {100 * args.confidence:g} % interval")
    for name, start, value, a, b in zip(names, starts, best, low, high):
        interval = f"at the {ends[name]} end of its range" if name in ends else "not determined" if name in open_ else f"{a:.5g} to {b:.5g}"
        print(f"{name:32} {start:11.5g} {value:11.5g}   {interval}")
    for curve, values in zip(curves, computed):
        print(f"{curve.column}: rms {rms(curve.values - values) / curve.unit:.3g} over {values.size} points")
    for sentence in told_of:
        print(f"warning: {sentence}")
    reasons = []
    if ends:
        which = ", ".join(f"{name} ended at the {end} end of its range" for name, end in ends.items())
        reasons.append(
            f"{which}, a factor of {REACH:g} from its start; do the columns have the units of their names "
            "(angle_deg, angle_rad, turns)? If so, give another start with --fit NAME=START"
        )
    if open_:
        which = ", ".join(open_)
        other = "measure something that depends on it, leave it out, or give another start with --fit NAME=START"
        reasons.append(f"what was measured does not determine {which}; {other}")
    if nothing and not reasons:
        reasons.append(f"{nothing}; mend the scene with --set, or give other starts with --fit NAME=START")
    if reasons:
        print(f"calibrate.py: no fit: {'; '.join(reasons)}", file=sys.stderr)
    else:
        print(f"wind with: {' '.join(f'--set {name}={value:.6g}' for name, value in zip(names, best))}", flush=True)

    finite = lambda value: float(value) if np.isfinite(value) else None
    parameters = {
        name: {
            "start": start, "value": float(value), "low": finite(a), "high": finite(b), "at_end": ends.get(name),
            "determined": name not in open_ and not nothing,
        }
        for name, start, value, a, b in zip(names, starts, best, low, high)
    }
    result = {
        "fitted": not reasons, "stopped": False, "confidence": args.confidence, "warnings": told_of, "parameters": parameters,
        "correlation": [[finite(cell) for cell in row] for row in answer.correlation],
    }
    write(args, model, result, computed)
    print(f"{model.runs} runs; residuals: {args.out / 'residuals.png'}")
    return 1 if reasons else 0


def keep_best(args, fit):
    """Writes the best parameters of a fit that was stopped; what there is to tell."""
    if (kept := fit.best()) is None:
        return "interrupted before the first run ended; nothing is kept"
    point, computed = kept
    names, best = fit.model.names, fit.starts * np.exp(point)
    parameters = {
        name: {"start": float(start), "value": float(value), "low": None, "high": None, "at_end": None, "determined": False}
        for name, start, value in zip(names, fit.starts, best)
    }
    write(args, fit.model, {"fitted": False, "stopped": True, "parameters": parameters}, computed)
    return f"interrupted after {len(fit.seen)} runs; the best values so far are in {args.out / 'calibration.json'}; go on from them with: {go_on(args, fit.model, best)}"


def go_on(args, model, best):
    """The command that starts from these values."""
    started = {set_of(model, name) for name in model.names}
    words = [args.scene]
    for option, values in (
        ("--measured", args.measured), ("--set", [text for text in args.set if text not in started]),
        ("--fit", [f"{name}={value:.6g}" for name, value in zip(model.names, best)]), ("--out", [args.out]),
        ("--confidence", [args.confidence]), ("--threads", [args.threads]),
    ):
        words += [str(word) for value in values for word in (option, value)]
    return shlex.join([sys.executable, sys.argv[0], *words, "--force"])


def write(args, model, result, computed):
    """The files of a calibration. Others in the folder stay, since the scene may be one of them."""
    folders.make(args.out)
    curves = model.curves
    result = {"scene": args.scene, "runs": model.runs} | result | {
        "curves": {
            curve.column: {"rms": rms(curve.values - values) / curve.unit, "autocorrelation": autocorrelation(curve.values - values)}
            for curve, values in zip(curves, computed)
        },
    }

    def table(path):
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(["column", "angle_rad", "measured", "fitted"])
            for curve, values in zip(curves, computed):
                writer.writerows(zip([curve.column] * values.size, curve.angle, curve.values / curve.unit, values / curve.unit))

    folders.write_whole(args.out / "calibration.json", lambda path: path.write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8"))
    folders.write_whole(args.out / "residuals.csv", table)
    folders.write_whole(args.out / "residuals.png", lambda path: draw(path, curves, computed))


if __name__ == "__main__":
    main()
