#!/usr/bin/env python3
"""Accuracy and speed of `fig8` by tolerance: the tables of docs/validation/convergence.md.

    scripts/accuracy.py [--command PATH] [--tables docs/validation/tables] [speed | verdict | default | coils | line | paper ...]

speed:    fig8-speed.md, bulge and gap against the converged ensemble and the time a run takes, by speed and tolerance
verdict:  fig8-verdict.md, mean gap and verdicts of ensembles as tolerance and spacing are made finer
default:  fig8-default.md, mean gap of fig8 and fig8_gap at the default and at a quarter of the tolerance with half the spacing
coils:    coils.md, mean gap of other coils, of turn 2 and of those after it, at the default tolerance, a quarter and a sixteenth of it
line:     feed-line.md, extremes of the tension of fig8 with what may stand behind the nozzle
paper:    fig8-paper.md, the paper's explicit method beside the production method

Without a name all are written (twelve minutes). Let the machine do nothing else: speed and paper tell times.
"""

import argparse
import csv
import json
import math
import statistics
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import fig8
import tables

SPEEDS = (30, 100, 300, 500)
# speed
TOLERANCES = (2e-6, 1e-5, 1.4e-5, 2e-5)
REPEAT = 5
ROUNDS = 4
"""Medians of REPEAT runs each; the real-time factor is told as the least and the largest of them."""

# verdict: rad/s, tolerance m, spacing mm (None: the default, which goes with the tolerance)
HALF_AT_5, HALF_AT_2_5 = 0.342, 0.2714
VERDICTS = [
    (30, 1e-5, None),
    (30, 5e-6, HALF_AT_5),
    (30, 1e-6, 0.2),
    (100, 1e-5, None),
    (100, 5e-6, HALF_AT_5),
    (100, 1e-6, 0.2),
    (300, 1e-5, None),
    (300, 5e-6, HALF_AT_5),
    (300, 5e-6, None),
    (300, 2.5e-6, HALF_AT_2_5),
    (300, 1e-6, 0.2),
    (500, 1e-5, None),
    (500, 5e-6, HALF_AT_5),
    (500, 5e-6, None),
    (500, 2.5e-6, HALF_AT_2_5),
    (500, 2e-6, None),
    (500, 1e-6, 0.2),
]
MEMBERS = 8
TURNS = 3.5

# default: tolerance m, spacing mm
FINENESS = [(2e-6, 0.3), (5e-7, 0.15)]
MANY = 16

# coils: label, rad/s, diameter mm, settings of a scene of defaults
SHARES = (1.0, 0.25, 0.0625)
LONGER = 6.5
LATER = (3, 4, 5)
COILS = [
    ("aluminium 1.5 mm on 40 x 60 mm", 20, 1.5, "wire.material=aluminium core.width_x_mm=40 core.height_z_mm=60 core.length_y_mm=50"
     " core.corner_radius_mm=6 nozzle.distance_mm=150 tensioner.tension=30 traverse.per_turn_mm=1.65"),
    ("copper 0.4 mm on 14 x 20 mm", 150, 0.4, "wire.material=copper core.width_x_mm=14 core.height_z_mm=20 core.length_y_mm=20"
     " core.corner_radius_mm=1.5 nozzle.distance_mm=70 tensioner.tension=6 traverse.per_turn_mm=0.42"),
    ("copper 0.05 mm on 4 x 6 mm", 500, 0.05, "wire.material=copper core.width_x_mm=4 core.height_z_mm=6 core.length_y_mm=6"
     " core.corner_radius_mm=0.2 nozzle.distance_mm=20 tensioner.tension=0.12 tensioner.mass_g=0.02 traverse.per_turn_mm=0.055"),
    ("copper 0.7 mm on 16 x 40 mm", 100, 0.7, "wire.material=copper core.width_x_mm=16 core.height_z_mm=40 core.corner_radius_mm=3 nozzle.distance_mm=80"),
    ("copper 0.3 mm on a cylinder of 18 mm", 300, 0.3, "wire.material=copper core.shape=cylinder core.radius_mm=9 core.length_y_mm=20"
     " nozzle.distance_mm=55 tensioner.tension=3 traverse.per_turn_mm=0.32"),
]
COILS.insert(1, (COILS[0][0], 40, *COILS[0][2:]))

# line: what stands behind the nozzle, its settings
LINES = [
    ("default", []),
    ("`tensioner.line_inertia=true`", ["tensioner.line_inertia=true"]),
    ("`tensioner.pulley_friction=3`", ["tensioner.pulley_friction=3"]),
    (
        "the same, line inertia and `tensioner.pulley_mass=2e-3`",
        ["tensioner.pulley_friction=3", "tensioner.line_inertia=true", "tensioner.pulley_mass=2e-3"],
    ),
]
LINE_SPEEDS = (100, 500)

# paper: label, words of `coilwind bench W`
PAPER = [
    ("2.5 turns, 500 rad/s", ["--omega", "500"]),
    ("0.4 turns, 30 rad/s", ["--omega", "30", "--set", "spindle.turns=0.4"]),
]
METHODS = [("rk4, 0.5 mm", ["--integrator", "rk4"]), ("implicit, 1e-5 m", ["--tol", "1e-5"])]


def bench(command, words):
    words = [command, "bench", "W", "--scene", "fig8", *words]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if not done.stdout.strip():
        raise SystemExit(f"{' '.join(words)}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def micro(value):
    return "-" if value is None else f"{value * 1e6:.0f}"


def plain(tolerance):
    """A power of ten as people write it: 1e-5, not 1e-05."""
    return f"{tolerance:g}".replace("e-0", "e-")


def speed(args):
    rows = []
    for tolerance in TOLERANCES:
        for omega in SPEEDS:
            words = ["--omega", str(omega), "--tol", repr(tolerance), "--repeat", str(REPEAT)]
            found = [bench(args.command, words) for _ in range(ROUNDS)]
            line = found[0]
            factors = [f"{choose(f['rtf'] for f in found):.3g}" for choose in (min, max)]
            row = [omega, plain(tolerance), micro(line["bulge_error_m"]), micro(line["gap_error_m"])]
            row += [f"{min(f['cpu_s'] for f in found):.3f}", " to ".join(factors)]
            row += [f"{1e3 * min(f['worst_ms_cpu_s'] for f in found):.0f}", line["steps"], line["iterations"]]
            rows.append(row)
    return write_speed(args.tables, tables.machine(), rows)


def write_speed(folder, where, rows):
    head = ["rad/s", "tolerance m", "bulge off by um", "gap off by um", "CPU s, least", "real-time factor"]
    head += ["slowest millisecond, CPU ms", "steps", "solves"]
    told = (
        f"`coilwind bench W --scene fig8 --omega W --tol TOL --repeat {REPEAT}`, 2.5 turns; {where}. Bulge and gap: rms over the stations of turn 2"
        f" against the converged ensemble packed with the scene. The real-time factor is the median of {REPEAT} runs, least and largest of {ROUNDS} medians."
    )
    return tables.write(folder, "fig8-speed", "scripts/accuracy.py speed", "`fig8` by tolerance: accuracy and speed", told, tables.table(head, rows))


def verdict(args):
    rows = []
    for omega, tolerance, spacing in VERDICTS:
        found = [fig8.wind(args.command, {"set": settings}) for settings in ensemble(omega, tolerance, spacing, MEMBERS)]
        ended = [member for member in found if member["status"] == "done" and member["gap_mean"] is not None]
        row = [omega, plain(tolerance), spacing or f"{default_spacing(tolerance):.2f} (default)"]
        row += [micro(statistics.fmean(member["gap_mean"] for member in ended))]
        row += [f"{statistics.fmean(member['gap_over'] for member in ended):.2f}"]
        rows.append([*row, f"{sum(member['verdict'] == 'gap' for member in ended)} of {len(found)}"])
    head = ["rad/s", "tolerance m", "spacing mm", "mean gap um", "share above the limit", "runs with a gap"]
    told = (
        f"Turn 2 of ensembles of {MEMBERS} runs of {TURNS} turns, nozzle at +-{fig8.SPREAD:g} mm about the scene's distance. A run is `coilwind run fig8"
        " --set spindle.speed=W --set spindle.turns=3.5 --set solver.tolerance=TOL --set solver.spacing_near=S --set nozzle.distance_mm=D`."
        " The limit is 0.15 d, 105 um. Results do not depend on the machine."
    )
    title = "`fig8` as tolerance and spacing are made finer: gaps and verdicts"
    return tables.write(args.tables, "fig8-verdict", "scripts/accuracy.py verdict", title, told, tables.table(head, rows))


def default(args):
    rows = []
    for scene in ("fig8", "fig8_gap"):
        for omega in SPEEDS:
            gaps = [mean_gaps(args.command, scene, omega, *fineness) for fineness in FINENESS]
            means = [statistics.fmean(found) for found in gaps]
            error = math.hypot(*(statistics.stdev(found) / math.sqrt(len(found)) for found in gaps))
            apart = f"{(means[1] - means[0]) / fig8.DIAMETER:+.4f} +- {error / fig8.DIAMETER:.4f}"
            rows.append([scene, omega, *(f"{mean / fig8.DIAMETER:.4f}" for mean in means), apart])
    head = ["scene", "rad/s", "default: mean gap / d", "a quarter of the tolerance, half the spacing", "apart, and standard error"]
    told = (
        f"Turn 2 of ensembles of {MANY} runs of {TURNS} turns, nozzle at +-{fig8.SPREAD:g} mm about the scene's distance. Default: tolerance"
        " 2e-6 m, spacing 0.3 mm; finer: 5e-7 m and 0.15 mm. Results do not depend on the machine."
    )
    title = "What tolerance and spacing leave of the gaps of `fig8` and `fig8_gap`"
    return tables.write(args.tables, "fig8-default", "scripts/accuracy.py default", title, told, tables.table(head, rows))


def coils(args):
    rows = []
    with tempfile.NamedTemporaryFile("w", suffix=".toml", encoding="utf-8") as scene:
        scene.write('preset = "default"\n')
        scene.flush()
        for label, omega, diameter, words in COILS:
            given = [word.split("=") for word in words.split()]
            settings = dict(given) | {"wire.diameter_mm": diameter, "spindle.speed": omega, "spindle.turns": LONGER}
            rows.append([label, omega, *(of_coil(args.command, scene.name, diameter, settings, share) for share in SHARES)])
    head = ["wire and core", "rad/s", *("default" if share == 1.0 else f"{share:g} of it" for share in SHARES)]
    told = (
        f"Mean gap over the diameter of turn 2, of turns {LATER[0]} to {LATER[-1]}, and verdict on turn 2, of ensembles of {MEMBERS} runs of {LONGER} turns,"
        " nozzle at +-0.5 d about the scene's distance. The default spacing throughout. Results do not depend on the machine."
    )
    return tables.write(args.tables, "coils", "scripts/accuracy.py coils", "What the tolerance leaves of the gaps of other coils", told, tables.table(head, rows))


def of_coil(command, scene, diameter, settings, share):
    """Mean gap and verdicts of an ensemble at this share of the default tolerance, in words."""
    middle = float(settings["nozzle.distance_mm"] if "nozzle.distance_mm" in settings else 60.0)
    found = []
    for k in range(MEMBERS):
        distance = middle + 0.5 * diameter * (2 * k / (MEMBERS - 1) - 1)
        own = settings | {"nozzle.distance_mm": f"{distance:.6g}", "solver.tolerance": share * 2e-6 * diameter / 0.7}
        found.append(fig8.wind(command, {"scene": scene, "set": own.items()}))
    counts = Counter(member["verdict"] for member in found)
    gap, later = (
        statistics.fmean(member["gaps"][turn] for member in found for turn in turns) / (1e-3 * diameter) for turns in ((2,), LATER)
    )
    return f"{gap:.3f}, {later:.3f}; " + ", ".join(f"{count} {verdict}" for verdict, count in counts.most_common())


def mean_gaps(command, scene, omega, tolerance, spacing):
    """Mean gap of turn 2 of each member, m."""
    found = [fig8.wind(command, {"scene": scene, "set": settings}) for settings in ensemble(omega, tolerance, spacing, MANY)]
    return [member["gap_mean"] for member in found]


def default_spacing(tolerance):
    """What the scene takes near the core where no spacing is given, mm."""
    return 0.3 * max(1.0, (tolerance / 2e-6) ** (1 / 3))


def ensemble(omega, tolerance, spacing, members):
    for k in range(members):
        offset = fig8.SPREAD * (2 * k / (members - 1) - 1)
        settings = [("spindle.speed", omega), ("spindle.turns", TURNS), ("solver.tolerance", tolerance)]
        settings += [("solver.spacing_near", spacing * 1e-3)] if spacing else []
        yield [*settings, ("nozzle.distance_mm", f"{60 + offset:.6g}")]


def line(args):
    rows = [[label, *(extremes(args.command, omega, settings) for omega in LINE_SPEEDS)] for label, settings in LINES]
    head = ["behind the nozzle", *(f"{omega} rad/s: least, largest" for omega in LINE_SPEEDS)]
    told = "Tension of `fig8` at the nozzle after the first third of the run, by `coilwind run fig8 --set spindle.speed=W` with these settings."
    title = "What stands behind the nozzle, and the tension there"
    return tables.write(args.tables, "feed-line", "scripts/accuracy.py line", title, told, tables.table(head, rows))


def extremes(command, omega, settings):
    """Least and largest tension at the nozzle after the first third of the rows of a run of `fig8`, in words."""
    with tempfile.TemporaryDirectory() as folder:
        words = [command, "run", "fig8", "--quiet", "--no-geometry", "--out", folder]
        for setting in (f"spindle.speed={omega}", *settings):
            words += ["--set", setting]
        subprocess.run(words, check=True)
        with (Path(folder) / "history.csv").open(encoding="utf-8", newline="") as file:
            lines = csv.DictReader(line for line in file if not line.startswith("#"))
            tensions = [float(row["wire_tension"]) for row in lines]
    late = tensions[len(tensions) // 3 :]
    return f"{min(late):.1f}, {max(late):.1f} N"


def paper(args):
    rows = []
    for label, words in PAPER:
        lines = [bench(args.command, [*words, *method]) for _, method in METHODS]
        for (name, _), line in zip(METHODS, lines):
            ratio = lines[0]["cpu_s"] / line["cpu_s"]
            rows.append([label, name, f"{line['cpu_s']:.3g}", f"{float(f'{ratio:.2g}'):.0f}", micro(line.get("bulge_error_m"))])
    return write_paper(args.tables, tables.machine(), rows)


def write_paper(folder, where, rows):
    told = f"`coilwind bench W --scene fig8`, one run each; {where}. A run of 0.4 turns has no turn 2 to be compared."
    head = ["run", "method", "CPU s", "times less", "bulge off by um"]
    title = "The paper's explicit method beside the production method"
    return tables.write(folder, "fig8-paper", "scripts/accuracy.py paper", title, told, tables.table(head, rows))


def main():
    every = {"speed": speed, "verdict": verdict, "default": default, "coils": coils, "line": line, "paper": paper}
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("which", nargs="*", metavar="speed | verdict | default | coils | line | paper")
    parser.add_argument("--command", default="target/release/coilwind")
    parser.add_argument("--tables", type=Path, default=tables.TABLES)
    args = parser.parse_args()
    unknown = [name for name in args.which if name not in every]
    if unknown:
        parser.error(f"{unknown[0]}: allowed: {', '.join(every)}")
    for name in args.which or every:
        print(every[name](args).read_text(encoding="utf-8"), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
