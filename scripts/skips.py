#!/usr/bin/env python3
"""What each part of a step costs that a scene can do without, and whether leaving it out changes the verdict.

    scripts/skips.py [--command PATH] [--repeat K] [--speeds 30 300]

Runs `coilwind bench W` on fig8 as it is, then with one switch after the other set against what auto takes, and prints a
Markdown table: CPU time over that of auto, errors of turn 2 against the converged run, and the verdict.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

# a switch and a value that auto does not take for fig8
SWITCHES = [
    ("solver.twist", "off"),
    ("solver.twist", "dynamic"),
    ("solver.live_contact", "on"),
    ("solver.live_contact", "off"),
    ("solver.coarse_span", "off"),
    ("solver.coarse_settled", "off"),
    ("solver.inertia", "off"),
    ("solver.friction", "off"),
    ("solver.plasticity", "off"),
    ("freeze.enabled", "false"),
]


def bench(command, speed, switches, repeat):
    words = [command, "bench", "W", "--omega", str(speed), "--repeat", str(repeat), "--tol", "2e-6"]
    for name, value in switches:
        words += ["--set", f"{name}={value}"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if not done.stdout.strip():
        return {"cpu_s": float("nan"), "reason": done.stderr.strip()}
    return json.loads(done.stdout)


def verdict(command, speed, switches):
    with tempfile.TemporaryDirectory() as folder:
        words = [command, "run", "fig8", "--quiet", "--out", folder]
        for name, value in [("spindle.speed", speed), *switches]:
            words += ["--set", f"{name}={value}"]
        subprocess.run(words, capture_output=True, text=True, check=False)
        path = Path(folder) / "summary.json"
        if not path.exists():
            return "-"
        summary = json.loads(path.read_text())
        return summary["verdict"] if summary["status"] == "done" else summary["status"]


def micro(value):
    return "-" if value is None else f"{value * 1e6:.0f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--command", default="target/release/coilwind")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--speeds", type=int, nargs="+", default=[30, 300])
    args = parser.parse_args()
    print("| rad/s | switch | value | CPU s | over that of auto | bulge, gap error um | verdict |")
    print("|---|---|---|---|---|---|---|")
    for speed in args.speeds:
        base = None
        for name, other in [("(auto)", ""), *SWITCHES]:
            switches = [] if name == "(auto)" else [(name, other)]
            took = bench(args.command, speed, switches, args.repeat)
            base = base or took["cpu_s"]
            errors = ", ".join(micro(took.get(k)) for k in ("bulge_error_m", "gap_error_m"))
            told = verdict(args.command, speed, switches)
            row = [speed, name, other, f"{took['cpu_s']:.2f}"]
            row += [f"{took['cpu_s'] / base:.2f}", errors, told]
            print("| " + " | ".join(str(cell) for cell in row) + " |")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
