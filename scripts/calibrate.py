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
squares in the logarithms of the parameters, with derivatives by central differences, then on a quadratic response surface as
wide as the intervals; each run is `coilwind run` and all cores work. Where what is left of a curve is no noise, values are doubtful
and a warning says why. --fit-angle-zero also fits where the angle of each file is zero. DIR gets calibration.json, residuals.csv and residuals.png. After Ctrl-C and SIGTERM they hold the best parameters so far.

Exit codes: 0 fitted, also where values are doubtful, 1 nothing is fitted: a parameter ended at an end of its range, or the measurement
does not determine it; also doubtful values with --fail-on-doubt, 2 a mistake that can be mended, 3 a full disk, 130 stopped.
On a terminal a line tells how many runs are done.
"""

import argparse
import csv
import json
import os
import shlex
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
except ModuleNotFoundError:
    print('calibrate.py: this Python has no numpy; start it with "$(scripts/venv.sh study)" scripts/calibrate.py', file=sys.stderr)
    sys.exit(2)

import folder as folders
from calibration_curves import TURN, ZERO_REACH, read_curves, too_few
from calibration_fit import ANGLES, NEAR, REACH, Fit, calibrate, ends_of, explains_nothing, intervals, warnings_of, zero_intervals
from calibration_rest import rests_of
from calibration_runs import Model
from calibration_zeros import beyond_reach
from failure import Interrupted, Mistake, told


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
    parser.add_argument("--fit-angle-zero", action="store_true", help="fit also where the angle of each file is zero, within 15 degrees")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="as for coilwind run")
    parser.add_argument("--out", type=Path, default=Path("calibration"), metavar="DIR", help="where results go (default: calibration)")
    parser.add_argument("--confidence", type=float, default=0.95, metavar="P", help="of the intervals (default: 0.95)")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), metavar="N", help="runs at a time (default: all cores)")
    parser.add_argument("--fail-on-doubt", action="store_true", help="exit with 1 if what is left of a curve is no noise, so that the values are doubtful")
    parser.add_argument("--force", action="store_true", help="write into a DIR that holds a calibration, a run or a sweep")
    parser.add_argument("--command", type=Path, default=folders.COMMAND, help=argparse.SUPPRESS)
    args = parser.parse_args()
    with told(parser.prog):
        sys.exit(run(args))


# Parameters that count.
COUNTED = ("winding.layers", "winding.turns_per_layer")


def starts_of(model, wanted):
    """Starting values: those given, else those of the scene with its settings."""
    names, starts, scene = [], [], None
    for text in wanted:
        name, _, value = text.partition("=")
        if name in names:
            raise Mistake(f"--fit {name} is given twice; leave one out")
        if name not in model.table:
            raise Mistake(f"--fit {name}: there is no such parameter; `coilwind variables` lists them, without units in their names")
        if name in COUNTED:
            raise Mistake(f"--fit {name}: it is a whole number, and no measured curve changes little with it; set it in the scene")
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
    keys = model.keys_of(name)
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
        try:
            names, starts = starts_of(model, args.fit)
            model.names = names
            if args.fit_angle_zero:
                model.fit_zeros()
            fit = Fit(model, starts, args.threads)
            answer, turned, beyond = searched(args, fit)
        finally:
            model.progress.end()
    return tell(args, model, starts, answer, list(rests_of(curves, answer.computed, answer.slopes, ANGLES, turned)), beyond)


def searched(args, fit):
    """The answer, the curves at turned angles, and zeros of angles out of reach that fit."""
    model = fit.model
    try:
        answer = calibrate(fit)
        # Where zeros are not fitted, it is asked whether others would explain what is left.
        turned = [] if model.zeros else model.turned(fit.values(answer.found.x), ANGLES)
        return answer, turned, beyond_reach(fit, answer)
    except KeyboardInterrupt:
        fit.stop()
        raise Interrupted(keep_best(args, fit)) from None


def tell(args, model, starts, answer, rests, beyond):
    """Prints the outcome, then writes it: a full disk takes nothing from who reads along. The exit code."""
    names, curves = model.names, model.curves
    best, below, above = intervals(starts, answer, args.confidence)
    zeros, zero_below, zero_above = (np.degrees(one) for one in zero_intervals(starts, answer, args.confidence))
    angles = [f"zero of {source}" for source in model.zeros]
    with np.errstate(over="ignore"):
        low, high = best * np.exp(-below), best * np.exp(above)
    zero_low, zero_high = zeros - zero_below, zeros + zero_above
    ends = ends_of([*names, *angles], answer.found)
    reach = np.degrees(ZERO_REACH)
    # Beyond the end of the range there may be a better zero than one whose interval goes there.
    wide = np.maximum([*below / np.log(REACH), *zero_below / reach], [*above / np.log(REACH), *zero_above / reach])
    reaching = {
        name: "lower" if value < 0.0 else "upper"
        for name, value, a, b, share in zip(angles, zeros, zero_low, zero_high, wide[len(names) :]) if name not in ends and share < 1.0 and max(-a, b) > NEAR * reach
    }
    ends = reaching | ends
    open_ = [name for name, share in zip([*names, *angles], wide) if not share < 1.0 and name not in ends]
    doubtful = any(rest.doubtful for rest in rests) or bool(beyond)
    nothing, told_of = explains_nothing(answer, curves), [*warnings_of([*names, *angles], answer), *(text for rest in rests for text in rest.warnings()), *(one.warning() for one in beyond)]

    print(f"{'parameter':32} {'start':>11} {'fitted':>11}   {100 * args.confidence:g} % interval")
    rows = [(name, f"{start:.5g}", f"{value:.5g}", f"{a:.5g} to {b:.5g}") for name, start, value, a, b in zip(names, starts, best, low, high)]
    rows += [(name, "0 deg", f"{value:.3g} deg", f"{a:.3g} to {b:.3g} deg") for name, value, a, b in zip(angles, zeros, zero_low, zero_high)]
    for name, start, value, between in rows:
        interval = f"at the {ends[name]} end of its range" if name in ends else "not determined" if name in open_ else f"{between}{', doubtful' if doubtful else ''}"
        print(f"{name:32} {start:>11} {value:>11}   {interval}")
    for rest in rests:
        print(f"{rest.curve.column}: rms {rest.record()['rms']:.3g} over {np.isfinite(rest.values).sum()} points")
    for sentence in told_of:
        print(f"warning: {sentence}")
    reasons = []
    for name in angles:
        if name in ends:
            reasons.append(f"{name} {'has an interval that reaches' if name in reaching else 'ended at'} the {ends[name]} end of its range of {reach:.0f} degrees; shift the angles of that file")
    if any(name in ends for name in names):
        which = ", ".join(f"{name} ended at the {ends[name]} end of its range" for name in names if name in ends)
        reasons.append(
            f"{which}, a factor of {REACH:g} from its start; do the columns have the units of their names "
            "(angle_deg, angle_rad, turns)? If so, give another start with --fit NAME=START"
        )
    if open_:
        which = ", ".join(open_)
        other = "measure something that depends on it, leave it out, or give another start with --fit NAME=START"
        reasons.append(f"what was measured does not determine {which}; {other}")
    if nothing:
        reasons.insert(0, nothing if reasons else f"{nothing}; mend the scene with --set, or give other starts with --fit NAME=START")
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
    elsewhere = {one.source: float(np.degrees(one.zero)) for one in beyond}
    of_angles = {
        str(source): {
            "value_deg": float(value), "low_deg": finite(a), "high_deg": finite(b), "at_end": ends.get(name),
            "determined": name not in open_ and not nothing, "beyond_deg": elsewhere.get(source),
        }
        for source, name, value, a, b in zip(model.zeros, angles, zeros, zero_low, zero_high)
    }
    result = {
        "fitted": not reasons, "stopped": False, "doubtful": doubtful, "confidence": args.confidence, "warnings": told_of, "parameters": parameters, "angle_zeros": of_angles,
        "correlation": [[finite(cell) for cell in row] for row in answer.correlation],
    }
    write(args, model, result, answer.computed, rests)
    print(f"{model.runs} runs; residuals: {args.out / 'residuals.png'}")
    if doubtful and args.fail_on_doubt and not reasons:
        print("calibrate.py: the fitted values are doubtful; the warnings say why", file=sys.stderr)
        return 1
    return 1 if reasons else 0


def keep_best(args, fit):
    """Writes the best parameters of a fit that was stopped; what there is to tell."""
    if (kept := fit.best()) is None:
        return "interrupted before the first run ended; nothing is kept"
    point, computed = kept
    names, best = fit.model.names, fit.values(point)
    parameters = {
        name: {"start": float(start), "value": float(value), "low": None, "high": None, "at_end": None, "determined": False}
        for name, start, value in zip(names, fit.starts, best)
    }
    write(args, fit.model, {"fitted": False, "stopped": True, "parameters": parameters}, computed, rests_of(fit.model.curves, computed))
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
    words += ["--fit-angle-zero"] if args.fit_angle_zero else []
    words += ["--fail-on-doubt"] if args.fail_on_doubt else []
    return shlex.join([sys.executable, sys.argv[0], *words, "--force"])


def write(args, model, result, computed, rests):
    """The files of a calibration. Others in the folder stay, since the scene may be one of them."""
    folders.make(args.out)
    curves = model.curves
    result = {"scene": args.scene, "runs": model.runs} | result | {
        "curves": {rest.curve.column: rest.record() for rest in rests},
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
