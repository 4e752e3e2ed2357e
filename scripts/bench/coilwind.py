"""What coilwind is asked for: settings of `coilwind bench`, one JSON line each."""

import json
import math
import subprocess

from problems import PERIOD

REPEAT = 5
# no further repeats of a setting once its runs have taken this long, s (as in peer.py)
ENOUGH = 20.0
# spindle speeds of Fig. 8, rad/s, and tolerances, m
SPEEDS = (30, 100, 300, 500)
TOLERANCES = (2e-5, 1e-5, 5e-6, 2e-6, 1e-6)


def settings(quick):
    """Arguments of `coilwind bench`, a list of words each."""
    if quick:
        return [
            ["P1", "--a", "10", "--n", "20"],
            ["P2", *p2(5, 100)],
            ["P2", "--n", "5", "--integrator", "verlet"],
            ["P3", "--n", "40"],
            ["P4", "--omega", "500", *p4(82, 1e-5)],
            ["W", "--omega", "500", "--tol", "1e-5"],
        ]
    words = [["P1", "--a", str(a), "--n", str(n)] for a in (1, 5, 10) for n in (6, 8, 12, 16, 20, 40, 80, 160, 320)]
    words += [["P2", *p2(*s)] for s in ((4, 50), (5, 100), (5, 200), (6, 400), (7, 500), (8, 600), (10, 1600), (12, 3200))]
    words += [["P2", "--n", str(n), "--integrator", "verlet"] for n in (10, 20, 40, 60)]
    words += [["P3", "--n", str(n)] for n in (20, 40, 80, 160, 320)]
    for omega in ("30", "500"):
        for n, tol in ((41, 5e-5), (82, 2e-5), (82, 1e-5), (163, 5e-6), (163, 2e-6), (327, 5e-7)):
            words.append(["P4", "--omega", omega, *p4(n, tol)])
    words += [["P4", "--omega", "500", "--n", str(n), "--integrator", "verlet"] for n in (33, 65, 130)]
    words += [["P4", "--omega", "30", "--n", "33", "--integrator", "verlet"]]
    words += [["W", "--omega", str(omega), "--tol", repr(tol)] for omega in SPEEDS for tol in TOLERANCES]
    # the explicit method takes more than a minute at the lower speeds
    words += [["W", "--omega", str(omega), "--integrator", "verlet"] for omega in (300, 500)]
    return words


def p2(n, steps):
    """Edges and steps a period. Their parts of the error are alike, about 1.5 (10 / n)^4 1e-4 and 200 / steps^2."""
    return ["--n", str(n), "--dt", repr(PERIOD / steps)]


def p4(n, tol):
    return ["--n", str(n), "--tol", repr(tol)]


def bench(command, words, repeat):
    """One line of `coilwind bench`, or what it said."""
    done = subprocess.run(
        [command, "bench", *words, "--repeat", str(repeat)], capture_output=True, text=True, check=False
    )
    if not done.stdout.strip():
        raise SystemExit(f"coilwind bench {' '.join(words)}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def repeated(command, words, quick):
    """The line of as many runs as there is time for."""
    line = bench(command, words, 1)
    # (W winds a second time, for its dearest millisecond)
    once = (2 if words[0] == "W" else 1) * line["wall_s"]
    runs = 1 if quick else min(REPEAT, int(ENOUGH / max(once, 1e-9)))
    return bench(command, words, runs) if runs > 1 and line["ok"] else line


def lines(command, quick):
    for words in settings(quick):
        yield repeated(command, words, quick)


def nodes(command, quick):
    """P5: what a node and step cost, by the length of the wire."""
    for n in (50, 200) if quick else (50, 100, 200, 400, 800, 1600):
        yield repeated(command, ["P5", "--n", str(n)], quick)


def turns(command, helix, quick):
    """W: a helix on a cylinder, by its turns."""
    for count in (2, 4) if quick else (2, 8, 32, 128, 500):
        line = repeated(command, ["W", "--scene", str(helix), "--set", f"spindle.turns={count}"], quick)
        # nothing to compare with
        assert math.isfinite(line["cpu_s"]), line
        yield line
