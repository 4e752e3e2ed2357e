"""Compares runs with their recorded results to the bit; see same_results.sh."""

import argparse
import csv
import hashlib
import json
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
GOLDEN = ROOT / "tests" / "golden" / "results.json"
FILES = ["history.csv", "turns.csv", "defects.csv", "stations.csv", "coil.vtp", "core.vtp", "summary.json"]
# the words in which a random scene says why it ended
REASON = re.compile(r"((?:wire broke|ended|gave up) at t = [0-9.e-]+ s): .*")
# what a run takes, not what it computes
CLOCK = re.compile(r'"(wall_s|cpu_s|real_time_factor)": ?[0-9.eE+-]+,?')


def runs():
    """Name and arguments of every run."""
    for speed in (30, 100, 300, 500):
        yield f"fig8-{speed}", ["run", "fig8", "--set", f"spindle.speed={speed}"]
    yield "fig8_gap", ["run", "fig8_gap"]
    yield "fig8-no-twist", ["run", "fig8", "--set", "solver.twist=off", "--set", "spindle.turns=1"]
    yield "fig8-all-twist", ["run", "fig8", "--set", "solver.twist=dynamic", "--set", "spindle.turns=1"]
    short = ["--set", "spindle.turns=0.05", "--set", "spindle.ramp_turns=0.05"]
    for method in ("rk4", "verlet"):
        explicit = ["run", "fig8", "--set", "preset=paper", "--set", f"solver.integrator={method}"]
        yield f"fig8-{method}", [*explicit, *short]
    for scene in sorted((ROOT / "tests" / "stress").glob("*.toml")):
        step = re.search(r"--step ([0-9.e+-]+)", scene.read_text(encoding="utf-8"))
        inputs = ["--inputs", scene.with_suffix(".csv").as_posix(), "--step", step.group(1)]
        yield f"stress/{scene.stem}", ["run", scene.as_posix(), *inputs]
    yield "stress-seed-7", ["stress", "--count", "40", "--seed", "7"]
    for preset in ("default", "paper"):
        yield f"verify-{preset}", ["verify", "--preset", preset, "--json"]


def digest(text):
    """Short hash of a text without its clock readings."""
    return hashlib.sha256(CLOCK.sub("", text).encode()).hexdigest()[:32]


def result(command, name, arguments):
    """What one run computes: exit code, hash of each file or of what was printed, last row of the history."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        if arguments[0] != "verify":
            arguments = [*arguments, "--out", str(out)]
        if arguments[0] == "run":
            arguments = [*arguments, "--quiet"]
        ran = subprocess.run([command, *arguments], cwd=ROOT, capture_output=True, text=True, check=False)
        if ran.returncode == 2:
            raise SystemExit(f"{name} is refused: {ran.stderr.strip()}")
        got = {"exit": ran.returncode}
        if arguments[0] != "run":
            printed = REASON.sub(r"\1", ran.stdout.replace(str(out), "OUT"))
            got["printed"] = digest(printed)
            return name, got
        for file in FILES:
            path = out / file
            if path.exists():
                text = path.read_text(encoding="latin-1")
                # where the scene lies is no result
                got[file] = digest(text.replace(ROOT.as_posix(), ""))
        history = out / "history.csv"
        if history.exists():
            rows = list(csv.DictReader(history.open(encoding="utf-8")))
            got["last"] = {key: rows[-1][key] for key in ("time", "wire_tension", "fed_length", "gap_width")}
    return name, got


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--command", required=True, help="the binary coilwind")
    parser.add_argument("--record", action="store_true", help="write the recorded results anew")
    parser.add_argument("--only", default="", metavar="WORD", help="runs whose name has this in it")
    given = parser.parse_args()
    command = str(Path(given.command).resolve())
    wanted = [run for run in runs() if given.only in run[0]]
    with ThreadPoolExecutor(2) as pool:
        got = dict(pool.map(lambda run: result(command, *run), wanted))
    if given.record:
        kept = json.loads(GOLDEN.read_text(encoding="utf-8")) if given.only and GOLDEN.exists() else {}
        GOLDEN.parent.mkdir(exist_ok=True)
        GOLDEN.write_text(json.dumps(kept | got, indent=1) + "\n", encoding="utf-8")
        print(f"recorded {len(got)} runs in {GOLDEN.relative_to(ROOT)}")
        return 0
    golden = json.loads(GOLDEN.read_text(encoding="utf-8"))
    failed = 0
    for name, now in got.items():
        before = golden.get(name, {})
        changed = [key for key in before.keys() | now.keys() if before.get(key) != now.get(key)]
        failed += bool(changed)
        for key in sorted(changed):
            print(f"{name}: {key} differs: {before.get(key)} recorded, {now.get(key)} now")
    missing = [name for name in golden if given.only in name and name not in got]
    for name in missing:
        print(f"{name}: recorded, but no run of that name")
    print(f"{len(got) - failed} passed, {failed + len(missing)} failed (runs compared to the bit)")
    return 1 if failed or missing else 0


if __name__ == "__main__":
    sys.exit(main())
