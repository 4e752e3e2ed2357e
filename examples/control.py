#!/usr/bin/env python3
"""Three controllers in the loop with the FMU, through fmpy: tension, speed, traverse.

    examples/control.py --out target/control

The Python is that of `scripts/venv.sh study`. Each controller reads outputs and sets inputs every 0.1 ms, and is compared with
the same machine without it. Leaves a picture each and control.json.
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np
from winder import wind

ROOT = Path(__file__).resolve().parents[1]
STEP = 1e-4
TURN = 2.0 * np.pi
PITCH = 0.8e-3
# A spool with a brake: what moves weighs half a kilogram along the wire, which a line of 5 m takes up. On a rectangular core the wire's
# speed swings threefold every quarter turn, and the spool resists.
SCENE = {
    "scene.file": "fig8", "wire.material": "copper", "core.corner_radius": 5e-3, "tensioner.tension": 10.0,
    "tensioner.mass": 0.5, "tensioner.line_length": 5.0, "tensioner.line_damping_ratio": 0.05,
}
TENSION = 10.0
SPEED = 30.0
BRAKE = 60.0
TURNS = 2.5
OUTPUTS = ["spindle_angle", "wire_tension", "wire_tension_min", "wire_tension_max", "feed_speed", "layon_position"]


def ramp(time, speed, rise=0.05):
    """A run-up without a jump of acceleration, rad/s."""
    share = min(time / rise, 1.0)
    return speed * share * share * (3.0 - 2.0 * share)


class Pi:
    """Proportional and integral control with limits; at a limit the integral stands still."""

    def __init__(self, proportional, integral, low, high):
        self.proportional, self.integral, self.low, self.high = proportional, integral, low, high
        self.sum = 0.0

    def __call__(self, error, base):
        more = self.sum + self.integral * error * STEP
        wanted = base + self.proportional * error + more
        if self.low < wanted < self.high:
            self.sum = more
        return min(max(wanted, self.low), self.high)


def settled(run, turns=1.0):
    return run["spindle_angle"] > TURN * turns


def deviation(run):
    """Largest share that the tension is off by after a turn, between communication points too."""
    on = settled(run)
    return float(max(run["wire_tension_max"][on].max() - TENSION, TENSION - run["wire_tension_min"][on].min()) / TENSION)


def nozzle(angle):
    return PITCH * angle / TURN


def tension_loop(fmu):
    """The brake follows a PI controller that reads the tension at the nozzle."""

    def wound(control):
        def law(angle, time, read):
            pull = control(TENSION - read["wire_tension"], TENSION) if control and time else TENSION
            return ramp(time, SPEED), nozzle(angle), pull

        return wind(fmu, SCENE, STEP, TURNS, law, OUTPUTS)

    runs = {"open loop": wound(None), "closed loop": wound(Pi(60.0, 3000.0, 0.0, BRAKE))}
    return runs, {name: deviation(run) for name, run in runs.items()}


def speed_profile(fmu):
    """The spindle slows down where the core draws wire fast: a profile over the angle, learnt from one turn at constant speed."""

    def wound(speed_at):
        def law(angle, time, read):
            return ramp(time, speed_at(angle)), nozzle(angle), TENSION

        return wind(fmu, SCENE, STEP, TURNS, law, OUTPUTS)

    constant = wound(lambda angle: SPEED)
    # Wire drawn per angle, m, over one turn. Its few lowest harmonics are what a spindle can follow.
    on = settled(constant)
    angle, speed = constant["spindle_angle"][on], constant["feed_speed"][on]
    harmonics = np.arange(1, 9)
    basis = np.column_stack([np.ones_like(angle), *(f(k * angle) for k in harmonics for f in (np.cos, np.sin))])
    factors, *_ = np.linalg.lstsq(basis, speed / SPEED, rcond=None)

    def arm(at):
        return factors[0] + sum(factors[2 * k - 1] * np.cos(k * at) + factors[2 * k] * np.sin(k * at) for k in harmonics)

    turn = np.linspace(0.0, TURN, 720, endpoint=False)
    # Turns as long as before: the mean of 1/speed stays.
    level = SPEED * np.mean(arm(turn))
    runs = {"constant speed": constant, "profile over the angle": wound(lambda at: level / arm(at))}
    return runs, {name: deviation(run) for name, run in runs.items()}


def traverse_loop(fmu):
    """The nozzle leads such that the wire meets the coil where it is to lie; the integral of what it is off by says how far."""
    scene = {**SCENE, "tensioner.mass": 1e-3, "tensioner.line_damping_ratio": 0.3, "start.clamp_y": 0.0}

    def wound(control):
        def law(angle, time, read):
            where = nozzle(angle)
            lead = control(where - read["layon_position"], 0.0) if control and time else 0.0
            return ramp(time, SPEED), where + lead, TENSION

        return wind(fmu, scene, STEP, TURNS, law, OUTPUTS)

    runs = {"nozzle at the place": wound(None), "nozzle led by layon_position": wound(Pi(1.0, 40.0, -5e-3, 5e-3))}
    for run in runs.values():
        run["off"] = run["layon_position"] - nozzle(run["spindle_angle"])
    return runs, {name: float(np.sqrt(np.mean(run["off"][settled(run)] ** 2)) / PITCH) for name, run in runs.items()}


STUDIES = {
    "tension": (tension_loop, "wire_tension", 1.0, "tension (N)"),
    "speed": (speed_profile, "wire_tension", 1.0, "tension (N)"),
    "traverse": (traverse_loop, "off", 1e3, "lay-on point off its place (mm)"),
}


def draw(path, runs, column, factor, label):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    sys.path.insert(0, str(ROOT / "scripts"))
    from runs import COLOURS, STYLE

    plt.rcParams.update(STYLE)
    figure, axis = plt.subplots(figsize=(8, 3), layout="constrained")
    if column == "wire_tension":
        axis.axhspan(0.95 * TENSION, 1.05 * TENSION, color="#d8dde2", label="within 5 %")
    else:
        axis.axhline(0.0, color="#5b616b", linewidth=0.7)
    for colour, (name, run) in zip((COLOURS[3], COLOURS[0]), runs.items()):
        axis.plot(run["spindle_angle"] / TURN, factor * run[column], color=colour, linewidth=1.0, label=name)
    axis.set_xlabel("turns of the spindle")
    axis.set_ylabel(label)
    axis.legend(frameon=False, fontsize=8, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3)
    figure.savefig(path)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("studies", nargs="*", metavar="STUDY", help="tension, speed, traverse (default: all)")
    parser.add_argument("--fmu", default=str(ROOT / "target/fmu/CoilWinding.fmu"))
    parser.add_argument("--out", type=Path, default=Path("control"))
    args = parser.parse_args()
    mistake = None
    if unknown := set(args.studies) - set(STUDIES):
        mistake = f"there is no study {', '.join(sorted(unknown))}; there are {', '.join(STUDIES)}"
    elif not Path(args.fmu).is_file():
        mistake = f"{args.fmu} is missing; build it with scripts/build_fmu.sh"
    if mistake:
        print(f"control.py: {mistake}", file=sys.stderr)
        sys.exit(2)
    args.out.mkdir(parents=True, exist_ok=True)
    found = {}
    for name in args.studies or STUDIES:
        study, column, factor, label = STUDIES[name]
        runs, found[name] = study(args.fmu)
        draw(args.out / f"control-{name}.png", runs, column, factor, label)
        for run, off in found[name].items():
            print(f"{name}: {run}: off by {100.0 * off:.1f} % {'of the pitch (rms)' if name == 'traverse' else 'of the set value'}")
    (args.out / "control.json").write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        print(f"control.py: cannot write: {error.strerror or error}", file=sys.stderr)
        sys.exit(3)
