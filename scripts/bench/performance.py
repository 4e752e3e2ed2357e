"""Tables of docs/validation/tables/performance-*.md from what was measured."""

import platform
import shutil
import sys
from pathlib import Path

import plots

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import tables  # noqa: E402

# errors that the tables ask for
TARGETS = {
    "P1": (1e-2, 1e-3, 1e-4, 1e-5),
    "P2": (1e-1, 1e-2, 1e-3),
    "P3": (1e-2, 2e-3),
    "P4": (1e-2, 1e-3),
    "W": (3e-5, 2e-5, 1e-5),
}
NAMES = {
    "P1": "cantilever under a dead force at its tip",
    "P2": "cantilever vibration",
    "P3": "capstan",
    "P4": "two turns on a cylinder",
    "W": "`fig8`, 2.5 turns",
}


def write(found, pictures, folder, command="scripts/bench.sh"):
    """Writes the tables into `tables` below a folder, and copies of the pictures into `performance` below it."""
    shown = folder / "performance"
    shown.mkdir(parents=True, exist_ok=True)
    for picture in pictures:
        shutil.copy(picture, shown)
    lines, where = found["precision"], machine(found["versions"])

    def put(name, title, *parts):
        tables.write(folder / "tables", name, command, title, where, *parts)

    for problem in plots.ERRORS:
        if any(line["problem"] == problem for line in lines):
            name = f"performance-{problem.lower()}"
            title = f"{problem}, {NAMES[problem]}"
            told = "CPU seconds of the cheapest setting that reached an error, one thread, medians of up to five runs."
            put(name, f"{title}: time to reach an error", told, reached(lines, problem))
            told = "Error and CPU time of every setting, one thread, medians of up to five runs."
            put(f"{name}-settings", f"{title}: every setting", told, points(lines, problem))
    told = "Free wire by the implicit method without contact (`coilwind bench P5 --n EDGES`)."
    put("performance-nodes", "Time by number of nodes", told, nodes(found["nodes"]))
    told = (
        "A helix on a cylinder of 20 mm at 300 rad/s"
        " (`coilwind bench W --scene scripts/bench/helix.toml --set spindle.turns=TURNS`)."
    )
    put("performance-turns", "Time by number of turns", told, turns(found["turns"]))
    put("performance-fmu", "FMU against native", *fmu(found["fmu"]))
    told = "`fig8` with one switch after the other set against what `auto` takes. Errors are those of turn 2 against the converged run."
    put("performance-skips", "What each skip saves", told, found["skips"].strip())


def machine(versions):
    """What it ran on and with, without names."""
    peers = ", ".join(f"{name} {version}" for name, version in versions.items())
    return f"{tables.machine()}; {tables.compiler()}, Python {platform.python_version()}; {peers}."


def reached(lines, problem):
    """Least CPU time of a setting that reached an error, by method."""
    targets, unit = TARGETS[problem], " m" if problem == "W" else ""
    rows = []
    for value, chosen in plots.variants(lines, problem):
        for name in plots.METHODS:
            own = [line for line in chosen if plots.method(line) == name]
            if own:
                rows.append([plots.title(problem, value), name, *(cheapest(own, target) for target in targets)])
    return tables.table(["problem", "method", *(f"error {target:g}{unit}" for target in targets)], rows)


def cheapest(lines, target):
    times = [line["cpu_s"] for line in lines if line["error"] is not None and line["error"] <= target]
    return f"{min(times):.2g}" if times else "-"


def points(lines, problem):
    """Every setting."""
    extra = problem == "W"
    head = ["method", "setting", "error m" if extra else "error", "CPU s", "steps"] + (["gap error um", "real-time factor"] if extra else [])
    rows = []
    for line in lines:
        if line["problem"] != problem:
            continue
        error = "-" if line["error"] is None else f"{line['error']:.2e}"
        if not line["ok"]:
            error = line.get("reason", "failed")
        row = [plots.method(line), plots.setting(line), error, f"{line['cpu_s']:.3g}", str(line["steps"])]
        if extra:
            gap = line.get("gap_error_m")
            row += ["-" if gap is None else f"{gap * 1e6:.0f}", f"{line['rtf']:.2f}"]
        rows.append(row)
    return tables.table(head, rows)


def nodes(lines):
    """How the time grows with the nodes."""
    head = ["edges", "ns a node and step", "ns a node and iteration"]
    return tables.table(
        head, [[line["n"], f"{line['ns_per_node_step']:.0f}", f"{line['ns_per_node_iteration']:.0f}"] for line in lines]
    )


def turns(lines):
    """How the time grows with the turns."""
    rows = []
    for line in lines:
        count = line["turns"]
        row = [f"{count:.0f}", f"{line['cpu_s']:.2f}", f"{line['cpu_s'] / count:.3f}"]
        rows.append([*row, f"{line['nodes_mean']:.0f}", f"{line['rtf']:.2f}"])
    return tables.table(["turns", "CPU s", "CPU s a turn", "live nodes", "real-time factor"], rows)


def fmu(found):
    """The cost of the interface: what was run, and a table."""
    told = (
        f"`{found['scene']}`, {found['turns']:g} turns at {found['omega']:g} rad/s in {found['communication_steps']} communication steps."
        " The native time is that of the whole process, with its tables."
    )
    length = "the same, to the bit" if found["same_fed_length"] else "DIFFERENT"
    ratio = found["fmu_cpu_s"] / found["native_cpu_s"]
    rows = [
        ["`coilwind run --inputs`", f"{found['native_cpu_s']:.2f}", "1.00", "reference"],
        ["the FMU in fmpy", f"{found['fmu_cpu_s']:.2f}", f"{ratio:.2f}", length],
    ]
    return told, tables.table(["driven by", "CPU s", "over native", "fed length"], rows)
