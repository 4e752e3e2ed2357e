#!/usr/bin/env python3
"""Fig. 8 as an ensemble: does the second turn lie against the first, and what decides it?

    scripts/fig8.py [--command PATH] [--out target/fig8] [--members 8] [--quick]

Winds `fig8` at every speed, tension, traverse and wire with the nozzle at several distances, +-0.35 mm about the scene's: a
single run tells little, since the landing is sensitive. The second part changes one thing at a time about `fig8`. Lengths in
the tables are in wire diameters.

Leaves members.csv (a row a run) in --out. Writes fig8.csv (a row an ensemble) and fig8.png into docs/validation/fig8/, and
fig8-grid.md and fig8-factors.md into docs/validation/tables/; with --quick into --out instead. Runs that are done already are
not run again, so an interrupted study goes on where it stopped.
"""

import argparse
import csv
import json
import os
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

import tables

SPEEDS = [30, 100, 300, 500]
TENSIONS = [5, 10, 15]
TRAVERSES = [0.35, 0.7]
WIRES = ["table1", "copper"]
SPREAD = 0.35
"""Nozzle distances about the scene's, mm: what a machine's set-up leaves open."""
DIAMETER = 0.7e-3
MEMBERS = 8
TURNS = 3.5
"""Turn 2 is at rest by then."""

# One thing changed at a time about fig8 as given: label, variable, value.
FACTORS = [
    ("as given", None, None),
    ("tension 5 N", "tensioner.tension", 5),
    ("tension 25 N", "tensioner.tension", 25),
    ("tensioner mass 0.1 g", "tensioner.mass", 1e-4),
    ("tensioner mass 10 g", "tensioner.mass", 1e-2),
    ("no friction", "solver.friction", "off"),
    ("friction 0.4 / 0.3", "friction", (0.4, 0.3)),
    ("traverse 0.35 mm", "traverse.per_turn_mm", 0.35),
    ("traverse 1 mm", "traverse.per_turn_mm", 1.0),
    ("nozzle 0.2 mm ahead", "traverse.lead_mm", 0.2),
    ("nozzle 0.2 mm behind", "traverse.lead_mm", -0.2),
    ("copper wire", "wire.material", "copper"),
    ("elastic wire", "solver.plasticity", "off"),
    ("corner radius 4 mm", "core.corner_radius_mm", 4),
    ("nozzle at 120 mm", "nozzle.distance_mm", 120),
]

FIELDS = ["status", "gap_mean", "gap_over", "gap_max", "bulge_max", "verdict", "turns_settled", "steps"]


def settings_of(case):
    """The `--set` words of a member."""
    words = []
    for name, value in case["set"]:
        words += ["--set", f"{name}={value}"]
    return words


def wind(command, case):
    """One member: its second turn, at rest or not."""
    with tempfile.TemporaryDirectory() as folder:
        words = [command, "run", case.get("scene", "fig8"), "--quiet", "--no-geometry", "--out", folder]
        done = subprocess.run(words + settings_of(case), capture_output=True, text=True, check=False)
        path = Path(folder) / "summary.json"
        if not path.exists():
            return {"status": done.stderr.strip() or f"exit code {done.returncode}"}
        summary = json.loads(path.read_text())
    turns = [t for t in summary["turns"] if t["turn"] == 2]
    turn = turns[0] if turns else {}
    found = {key: turn.get(key) for key in ("gap_mean", "gap_over", "gap_max", "bulge_max", "verdict")}
    return {
        "status": summary["status"],
        "turns_settled": summary["turns_settled"],
        "steps": summary["steps"],
        "gaps": {t["turn"]: t.get("gap_mean") for t in summary["turns"]},
        **found,
    }


def cases(args):
    """Every member of every ensemble: key of the ensemble, key of the member, its settings."""
    offsets = [SPREAD * (2 * k / (args.members - 1) - 1) for k in range(args.members)]
    speeds = [100] if args.quick else SPEEDS
    for wire in WIRES[:1] if args.quick else WIRES:
        for tension in TENSIONS[-1:] if args.quick else TENSIONS:
            for traverse in TRAVERSES:
                for speed in speeds:
                    given = [
                        ("wire.material", wire),
                        ("tensioner.tension", tension),
                        ("traverse.per_turn_mm", traverse),
                        ("spindle.speed", speed),
                        ("spindle.turns", args.turns),
                    ]
                    name = f"{wire},{tension},{traverse},{speed}"
                    yield from members("grid", name, given, offsets, 60.0)
    for label, variable, value in FACTORS[:2] if args.quick else FACTORS:
        for speed in [100] if args.quick else [300, 500]:
            given = [("spindle.speed", speed), ("spindle.turns", args.turns)]
            middle = 60.0
            if variable == "friction":
                given += [("friction.static", value[0]), ("friction.kinetic", value[1])]
            elif variable == "nozzle.distance_mm":
                middle = value
            elif variable:
                given.append((variable, value))
            yield from members("factor", f"{label},{speed}", given, offsets, middle)


def members(part, name, given, offsets, middle):
    for k, offset in enumerate(offsets):
        where = ("nozzle.distance_mm", f"{middle + offset:.6g}")
        yield {"part": part, "name": name, "member": k, "set": [*given, where]}


def read_done(path):
    if not path.exists():
        return {}
    with path.open(newline="", encoding="utf-8") as file:
        return {(r["part"], r["name"], int(r["member"])): r for r in csv.DictReader(file)}


def number(text):
    return float(text) if text not in (None, "", "None") else None


def ensembles(rows):
    """Mean, spread and counts of each ensemble, in wire diameters."""
    groups = {}
    for row in rows:
        groups.setdefault((row["part"], row["name"]), []).append(row)
    for (part, name), group in groups.items():
        settled = [r for r in group if r["status"] == "done" and number(r["gap_mean"]) is not None]
        gaps = [number(r["gap_mean"]) / DIAMETER for r in settled]
        over = [number(r["gap_over"]) for r in settled]
        bulges = [number(r["bulge_max"]) / DIAMETER for r in settled]
        verdicts = {}
        for r in group:
            verdict = r["verdict"] if r["status"] == "done" else r["status"]
            verdicts[verdict or "unsettled"] = verdicts.get(verdict or "unsettled", 0) + 1
        yield {
            "part": part,
            "name": name,
            "members": len(group),
            "gap_mean": statistics.fmean(gaps) if gaps else None,
            "gap_spread": statistics.stdev(gaps) if len(gaps) > 1 else None,
            "over_mean": statistics.fmean(over) if over else None,
            "over_spread": statistics.stdev(over) if len(over) > 1 else None,
            "bulge": statistics.fmean(bulges) if bulges else None,
            "verdicts": ", ".join(f"{v} {n}" for v, n in sorted(verdicts.items())),
        }


def shown(value, digits=3):
    return "-" if value is None else f"{value:.{digits}f}"


def cells(e):
    return [
        f"{shown(e['gap_mean'])} +- {shown(e['gap_spread'])}",
        f"{shown(e['over_mean'], 2)} +- {shown(e['over_spread'], 2)}",
        shown(e["bulge"], 2),
        e["verdicts"],
    ]


def write_tables(args, tables_to, csv_to, found):
    command = " ".join(["scripts/fig8.py", *options(args)])
    told = ["mean gap / d", "share of turn above limit", "highest bulge / d", "members"]
    note = (
        f"Turn 2 of ensembles of {args.members} runs of {args.turns:g} turns, default tolerance, nozzle at {SPREAD:g} mm more and less than"
        " given. Mean and standard deviation over the members; the limit is 0.15 d. Results do not depend on the machine."
    )
    grid = [[*e["name"].split(","), *cells(e)] for e in found if e["part"] == "grid"]
    head = ["wire", "tension N", "traverse mm/turn", "rad/s", *told]
    title = "Fig. 8 by speed, tension, traverse and wire"
    yield tables.write(tables_to, "fig8-grid", command, title, note, tables.table(head, grid))
    factors = [[*e["name"].split(","), *cells(e)] for e in found if e["part"] == "factor"]
    title = "Fig. 8 with one thing changed about `fig8`"
    body = tables.table(["changed", "rad/s", *told], factors)
    yield tables.write(tables_to, "fig8-factors", command, title, note, body)
    csv_to.mkdir(parents=True, exist_ok=True)
    with (csv_to / "fig8.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fieldnames=list(found[0]))
        writer.writeheader()
        writer.writerows(found)


def options(args):
    """What was asked for beyond the default and changes the numbers."""
    words = [] if args.members == MEMBERS else ["--members", str(args.members)]
    words += [] if args.turns == TURNS else ["--turns", f"{args.turns:g}"]
    return [*words, "--quick"] if args.quick else words


def draw(folder, found):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from runs import COLOURS, STYLE

    grid = [e for e in found if e["part"] == "grid" and e["gap_mean"] is not None]
    if not grid:
        return
    keys = [e["name"].split(",") for e in grid]
    wires = sorted({k[0] for k in keys}, reverse=True)
    traverses = sorted({k[2] for k in keys}, key=float)
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(
            len(wires), len(traverses), figsize=(9, 3.2 * len(wires)), squeeze=False, sharey=True, sharex=True
        )
        for row, wire in zip(axes, wires):
            for ax, traverse in zip(row, traverses):
                tensions = sorted({k[1] for k in keys}, key=float)
                for colour, tension in zip(COLOURS, tensions):
                    line = [
                        (float(k[3]), 1 + e["gap_mean"], e["gap_spread"] or 0.0)
                        for k, e in zip(keys, grid)
                        if k[:3] == [wire, tension, traverse]
                    ]
                    if line:
                        x, y, spread = zip(*sorted(line))
                        ax.errorbar(x, y, spread, marker="o", ms=4, capsize=3, lw=1.2, color=colour, label=f"{tension} N")
                ax.axhline(1.0, color="#8a8f98", lw=0.8)
                ax.set_title(f"{wire}, {traverse} mm a turn")
        for ax in axes[-1]:
            ax.set_xlabel("spindle speed, rad/s")
        for row in axes:
            row[0].set_ylabel("centre distance of turns 1 and 2, d")
        axes[0][0].legend()
        figure.suptitle("Fig. 8: mean over turn 2 of ensembles, bars: standard deviation between members", fontsize=9.5)
        figure.tight_layout()
        figure.savefig(folder / "fig8.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--command", default="target/release/coilwind")
    parser.add_argument("--out", type=Path, default=Path("target/fig8"))
    parser.add_argument("--members", type=int, default=MEMBERS)
    parser.add_argument("--turns", type=float, default=TURNS)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--quick", action="store_true", help="two ensembles and a factor, to see that it works")
    args = parser.parse_args()
    if args.members < 2:
        parser.error("--members: allowed: 2 or more")
    args.out.mkdir(parents=True, exist_ok=True)
    path = args.out / "members.csv"
    done = read_done(path)
    todo = list(cases(args))
    wanted = {(c["part"], c["name"], c["member"]) for c in todo}
    rows = [row for key, row in done.items() if key in wanted and row["status"] == "done"]
    known = {(r["part"], r["name"], int(r["member"])) for r in rows}
    todo = [c for c in todo if (c["part"], c["name"], c["member"]) not in known]
    fields = ["part", "name", "member", *FIELDS]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fieldnames=fields)
        writer.writeheader()
        writer.writerows(rows)
        with ThreadPoolExecutor(args.jobs) as pool:
            started = {pool.submit(wind, args.command, case): case for case in todo}
            try:
                for count, future in enumerate(as_completed(started), 1):
                    case = started[future]
                    row = {k: case[k] for k in ("part", "name", "member")} | future.result()
                    rows.append({key: row.get(key) for key in fields})
                    writer.writerow(rows[-1])
                    file.flush()
                    print(f"\r{count} of {len(todo)} runs", end="", file=sys.stderr, flush=True)
            except KeyboardInterrupt:
                pool.shutdown(cancel_futures=True)
                print(f"\nstopped; {len(rows)} runs are kept in {path}", file=sys.stderr)
                return 130
    print(file=sys.stderr)
    order = {(c["part"], c["name"], c["member"]): k for k, c in enumerate(cases(args))}
    rows.sort(key=lambda r: order[(r["part"], r["name"], int(r["member"]))])
    found = list(ensembles(rows))
    tables_to, pictures_to = (args.out, args.out) if args.quick else (tables.TABLES, tables.VALIDATION / "fig8")
    for written in write_tables(args, tables_to, pictures_to, found):
        print(written.read_text(encoding="utf-8"))
    draw(pictures_to, found)
    failed = sum(r["status"] != "done" for r in rows)
    if failed:
        print(f"{failed} of {len(rows)} runs did not end; see {path}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
