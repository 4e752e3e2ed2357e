#!/usr/bin/env python3
"""The table of exact answers: every kind, how many quantities are right, and which is nearest to its tolerance.

    scripts/verify_table.py [--command PATH] [--tables docs/validation/tables]

Runs `coilwind verify --json` for both presets (two minutes) and writes exact-answers.md. Exits with 1 if a quantity is wrong.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import tables

CASES = tables.ROOT / "tests" / "reference"
PRESETS = {"default": "The production method", "paper": "The explicit method of the paper"}


def records(command, preset):
    """What `coilwind verify` says of each quantity."""
    words = [command, "verify", "--json", "--preset", preset]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if not done.stdout.strip():
        raise SystemExit(f"{' '.join(words)}: {done.stderr.strip()}")
    return [json.loads(line) for line in done.stdout.splitlines()]


def share(record):
    """Error over the widest bound that the check allows; None where the answer has to be equal."""
    check, expected = record["tolerance"], record["expected"]
    bounds = []
    if "rel" in check:
        bounds.append(check["rel"] * abs(expected))
    if "abs" in check:
        bounds.append(check["abs"])
    if "abs_of" in check:
        bounds.append(check["tol"] * abs(inputs(record)[check["abs_of"]]))
    return abs(record["got"] - expected) / max(bounds) if bounds else None


def inputs(record):
    cases = json.loads((CASES / f"{record['kind']}.json").read_text(encoding="utf-8"))["cases"]
    return next(case["inputs"] for case in cases if case["id"] == record["id"])


def row(kind, found):
    """A kind's line: the quantity that comes nearest to its tolerance stands for all."""
    right = sum(record["ok"] is True for record in found)
    shares = [(share(record), record) for record in found]
    largest, nearest = max(((s, r) for s, r in shares if s is not None), key=lambda pair: pair[0])
    error = f"{100 * nearest['rel_error']:.2g} %" if nearest["rel_error"] is not None else "-"
    slowest = max(record["cpu_s"] for record in found)
    name = f"`{nearest['quantity']}` ({nearest['id']})"
    setups = "; ".join(dict.fromkeys(record["setup"] for record in found))
    return [f"`{kind}`", setups, f"{right} of {len(found)}", name, error, f"{100 * largest:.1f} %", f"{slowest:.1f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--command", default="target/release/coilwind")
    parser.add_argument("--tables", type=Path, default=tables.TABLES)
    args = parser.parse_args()
    head = ["kind", "set-up", "right", "quantity nearest to its tolerance (case)", "relative error", "share of tolerance", "slowest case, CPU s"]
    parts, wrong = [f"`coilwind verify --json --preset default` and `--preset paper`; {tables.machine()}."], 0
    for preset, name in PRESETS.items():
        found = records(args.command, preset)
        failed = [record for record in found if record["ok"] is not True]
        for record in failed:
            print(f"not right: {json.dumps(record)}", file=sys.stderr)
        wrong += len(failed)
        kinds = dict.fromkeys(record["kind"] for record in found)
        rows = [row(kind, [r for r in found if r["kind"] == kind]) for kind in kinds]
        parts += [f"## {name} (`--preset {preset}`): {len(found) - len(failed)} of {len(found)} right", tables.table(head, rows)]
    print(tables.write(args.tables, "exact-answers", "scripts/verify_table.py", "Exact answers", *parts).read_text(encoding="utf-8"))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
