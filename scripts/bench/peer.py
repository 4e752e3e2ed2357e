"""What the programs that run a peer have in common: settings, the clock, a JSON line for each setting.

A peer offers, for each problem, a function of a setting (a dictionary) that returns three functions: `prepare()`
builds the model, `solve(model)` computes, `judge(model, solved)` returns `error`, `steps` and, where the peer tells,
`iterations`. Only `solve` is on the clock.
"""

import argparse
import json
import math
import statistics
import sys
import time

# no further repeats of a setting once its runs have taken this long, s
ENOUGH = 20.0
# what peers raise when they cannot go on
FAILURES = (ArithmeticError, RuntimeError, ValueError)


def measure(peer, problem, setting, steps, repeat):
    """One line in the format of `coilwind bench`, times as medians."""
    prepare, solve, judge = steps
    line = {"peer": peer, "problem": problem, "n": setting.get("n"), "dt": setting.get("dt"), "tol": setting.get("tol")}
    line |= {"error": None, "cpu_s": 0.0, "wall_s": 0.0, "steps": 0, "iterations": None, "ok": False} | setting
    cpu, wall = [], []
    found = {}
    while len(cpu) < repeat and sum(wall) < ENOUGH:
        try:
            model = prepare()
            started = time.process_time(), time.perf_counter()
            solved = solve(model)
            cpu.append(time.process_time() - started[0])
            wall.append(time.perf_counter() - started[1])
            found = judge(model, solved)
        except FAILURES as failure:
            return line | {"reason": str(failure).strip().split("\n")[0]}
    line |= found | {"cpu_s": statistics.median(cpu), "wall_s": statistics.median(wall), "runs": len(cpu)}
    if math.isfinite(found["error"]):
        return line | {"ok": True}
    return line | {"error": None, "reason": "diverged"}


def main(peer, problems, settings, quick):
    """Runs every setting (or the quick ones) of every problem and prints their lines.

    All three map a problem's name: to its function, to lists of settings.
    """
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true", help="coarsest settings, once")
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--problem", choices=list(problems), action="append")
    args = parser.parse_args()
    repeat = 1 if args.quick else args.repeat
    for problem in args.problem or problems:
        chosen = (quick if args.quick else settings)[problem]
        for number, setting in enumerate(chosen):
            steps = problems[problem](setting)
            if number == 0:
                # what is compiled or cached at first use is on nobody's clock
                measure(peer, problem, setting, steps, 1)
            print(json.dumps(measure(peer, problem, setting, steps, repeat)))
            sys.stdout.flush()
