#!/usr/bin/env python3
"""Runs everything and hands it to the plots and the tables; scripts/bench.sh calls it."""

import argparse
import csv
import json
import subprocess
import sys
from pathlib import Path

import coilwind
import fmu
import performance
import plots
import tables

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PEERS = ("exudyn", "mujoco", "pyelastica")
# speeds at which skips are measured, rad/s, and runs of each
SKIP_SPEEDS = ("30", "300")
SKIP_REPEAT = "5"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--command", required=True, help="the coilwind binary")
    parser.add_argument("--fmu", required=True)
    parser.add_argument("--peers", required=True, help="Python that has the other simulators")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--quick", action="store_true")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    # lines of an earlier run would mix with these
    for old in args.out.glob("*.jsonl"):
        old.unlink()

    print("coilwind", flush=True)
    precision = keep(coilwind.lines(args.command, args.quick), args.out / "coilwind.jsonl")
    for peer in PEERS:
        print(peer, flush=True)
        precision += keep(peer_lines(args.peers, peer, args.quick), args.out / f"{peer}.jsonl")
    print("by nodes, by turns", flush=True)
    found = {
        "precision": precision,
        "nodes": keep(coilwind.nodes(args.command, args.quick), args.out / "nodes.jsonl"),
        "turns": keep(coilwind.turns(args.command, HERE / "helix.toml", args.quick), args.out / "turns.jsonl"),
    }
    print("FMU against native", flush=True)
    found["fmu"] = fmu.compare(args.command, args.fmu, args.quick)
    (args.out / "fmu.json").write_text(json.dumps(found["fmu"]) + "\n", encoding="utf-8")
    print(found["fmu"], flush=True)
    print("what each skip saves", flush=True)
    found["skips"] = skips(args.command, args.quick)
    (args.out / "skips.md").write_text(found["skips"], encoding="utf-8")
    found["versions"] = peer_versions(args.peers)

    table(precision, args.out / "precision.csv")
    pictures = plots.draw(precision, args.out)
    failed = [line for line in precision if not line["ok"]]
    for line in failed:
        print(f"no answer: {json.dumps(line)}", flush=True)
    if args.quick:
        performance.write(found, pictures, args.out, "scripts/bench.sh --quick")
        # the quick settings are known to work with each peer
        sys.exit(1 if failed or not found["fmu"]["same_fed_length"] else 0)
    performance.write(found, pictures, tables.VALIDATION)


def keep(lines, path):
    """Writes lines as they come, shows them in short, and returns them."""
    kept = []
    with path.open("w", encoding="utf-8") as file:
        for line in lines:
            kept.append(line)
            file.write(json.dumps(line) + "\n")
            file.flush()
            error = "-" if line["error"] is None else f"{line['error']:.2e}"
            print(f"  {line['problem']:3} {plots.setting(line):44} error {error:8} cpu {line['cpu_s']:.3g} s", flush=True)
    return kept


def peer_lines(python, peer, quick):
    """Lines of a peer's program."""
    words = [python, HERE / f"{peer}_peer.py", "--repeat", str(coilwind.REPEAT), *(["--quick"] if quick else [])]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as running:
        for line in running.stdout:
            # peers print warnings of their own
            if line.startswith("{"):
                yield json.loads(line)
    if running.returncode != 0:
        raise SystemExit(f"{peer}: exit code {running.returncode}")


def peer_versions(python):
    """Version of each peer, as installed."""
    asks = f"import importlib.metadata as m, json; print(json.dumps({{p: m.version(p) for p in {PEERS!r}}}))"
    done = subprocess.run([python, "-c", asks], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def skips(command, quick):
    """The table of scripts/skips.py."""
    speeds = SKIP_SPEEDS[-1:] if quick else SKIP_SPEEDS
    repeat = "1" if quick else SKIP_REPEAT
    words = [sys.executable, ROOT / "scripts" / "skips.py", "--command", command, "--repeat", repeat, "--speeds", *speeds]
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


def table(lines, path):
    """All lines with every key that any of them has."""
    names = list(dict.fromkeys(name for line in lines for name in line))
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, names)
        writer.writeheader()
        writer.writerows(lines)


if __name__ == "__main__":
    main()
