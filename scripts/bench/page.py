"""docs/performance.md from what was measured."""

import datetime
import os
import platform
import shutil
import subprocess
from pathlib import Path

import plots

# errors that the tables ask for
TARGETS = {
    "P1": (1e-2, 1e-3, 1e-4, 1e-5),
    "P2": (1e-1, 1e-2, 1e-3),
    "P3": (1e-2, 2e-3),
    "P4": (1e-2, 1e-3),
    "W": (3e-5, 2e-5, 1e-5),
}

PROBLEMS = """\
| problem | what | error | reference |
|---|---|---|---|
| P1 | cantilever, 0.1 m, bent by a dead force P L^2/EI = a across its tip, static | distance of the tip over the length | extensible elastica by quadrature (`src/bench/p1.rs`; the packed case `elastica_cantilever` agrees to 1e-9) |
| P2 | the same wire released from its first mode, tip at L/1000, ten periods | largest deviation of the tip over the amplitude | `A cos(omega_1 t)`, closed form |
| P3 | capstan: half a turn of string-like wire slipping on a cylinder of 20 mm | force ratio, relative | `exp(mu pi)`; the bending stiffness left takes 8e-4 off it, so nothing is ranked below 1e-3 |
| P4 | two turns on a cylinder of 20 mm, 10 N | drawn-in length, relative | own runs with `--n 640` and tolerances of 5e-8 and 1e-8 m, good to 2e-5 (30 rad/s) and 1e-4 (500 rad/s); the explicit method on a meshed cylinder agrees to 7e-5 |
| W | `fig8`, 2.5 turns | bulge of turn 2, rms over angle | mean of eight own runs with nozzle distances +-0.35 mm, 0.25 mm edges, 2e-7 m (packed with the scene); single runs scatter by 10 to 20 um |

P1 and P2: elastic wire of the paper's Table 1 (EA 48.9 kN, EI 3.06e-3 N m^2, 0.7 mm, 8960 kg/m^3). The references of P1, P2 and P3 come from no rod
discretisation; those of P4 and W are converged runs of this program."""

PEERS = """\
What the other simulators were not asked, and why:

- Exudyn, P4: its cable that moves along itself has a frictional contact only without sticking, so the wire that stays on the cylinder would have to be
  cut by hand from the wire that is fed; not set up.
- MuJoCo, P3 and P4: not set up. The chain of links cannot stretch and its contacts are soft in friction too; both problems live from how force passes along
  a wire that sticks and slips.
- PyElastica, P3 and P4: not set up. Its contact between rod and cylinder has friction, but the friction and contact springs add to a step of 1e-7 to
  1e-6 s, and P3 and P4 last 0.1 s and more.
- None of them, W: bending with hardening plasticity and wire that is fed through a nozzle and set on the coil are in none of the three (MuJoCo 4 has
  joints that yield, without hardening)."""


def write(found, pictures, path):
    """Writes the page; pictures lie beside it in a folder of its name, unless they are in its own."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if pictures and pictures[0].parent != path.parent:
        folder = path.with_suffix("")
        folder.mkdir(exist_ok=True)
        pictures = [Path(shutil.copy(picture, folder)) for picture in pictures]
    shown = {picture.stem: picture.relative_to(path.parent).as_posix() for picture in pictures}
    lines = found["precision"]
    parts = [
        "# Performance",
        "`scripts/bench.sh` wrote this page: error against CPU time, one thread, medians of 5 runs (a setting whose runs took twenty seconds"
        " together has fewer). The clock of a peer starts after import, compilation and set-up; that of coilwind includes the making of the rod."
        " What was tried in tuning each peer stands at the top of `scripts/bench/*_peer.py`.",
        machine(found["versions"]),
        "## Problems\n\n" + PROBLEMS,
        PEERS,
    ]
    for problem in plots.ERRORS:
        if problem.lower() in shown:
            parts += [f"## {problem}", f"![{problem}]({shown[problem.lower()]})", reached(lines, problem), points(lines, problem)]
    parts += [scaling(found), fmu(found["fmu"]), skips(found["skips"])]
    path.write_text("\n\n".join(parts) + "\n", encoding="utf-8")


def machine(versions):
    """What it ran on, without names."""
    compiler = subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=False).stdout.split()
    peers = ", ".join(f"{name} {version}" for name, version in versions.items())
    return (
        f"{datetime.date.today().isoformat()}; {processor()}, {os.cpu_count()} cores, {platform.system()};"
        f" {' '.join(compiler[:2]) or 'rustc unknown'}, Python {platform.python_version()}; {peers}."
    )


def processor():
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def reached(lines, problem):
    """Least CPU time of a setting that reached an error, by method."""
    parts = ["CPU seconds of the cheapest setting that reached an error:\n"]
    targets = TARGETS[problem]
    parts.append("| | method | " + " | ".join(f"{target:g}" for target in targets) + " |")
    parts.append("|---|---|" + "---|" * len(targets))
    for value, chosen in plots.variants(lines, problem):
        for name in plots.METHODS:
            own = [line for line in chosen if plots.method(line) == name]
            if own:
                cells = [cheapest(own, target) for target in targets]
                parts.append(f"| {plots.title(problem, value)} | {name} | " + " | ".join(cells) + " |")
    return "\n".join(parts)


def cheapest(lines, target):
    times = [line["cpu_s"] for line in lines if line["error"] is not None and line["error"] <= target]
    return f"{min(times):.2g}" if times else "-"


def points(lines, problem):
    """Every setting."""
    own = [line for line in lines if line["problem"] == problem]
    extra = problem == "W"
    parts = ["<details><summary>every setting</summary>\n"]
    head = ["method", "setting", "error", "CPU s", "steps"] + (["gap error um", "times real time"] if extra else [])
    parts += ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    for line in own:
        error = "-" if line["error"] is None else f"{line['error']:.2e}"
        if not line["ok"]:
            error = line.get("reason", "failed")
        row = [plots.method(line), plots.setting(line), error, f"{line['cpu_s']:.3g}", str(line["steps"])]
        if extra:
            gap = line.get("gap_error_m")
            row += ["-" if gap is None else f"{gap * 1e6:.0f}", f"{line['rtf']:.2f}"]
        parts.append("| " + " | ".join(row) + " |")
    return "\n".join([*parts, "\n</details>"])


def scaling(found):
    """How the time grows."""
    parts = ["## How the time grows", "Free wire, implicit method without contact (`bench P5`):\n"]
    parts += ["| edges | ns a node and step | ns a node and iteration |", "|---|---|---|"]
    for line in found["nodes"]:
        parts.append(f"| {line['n']} | {line['ns_per_node_step']:.0f} | {line['ns_per_node_iteration']:.0f} |")
    parts += ["\nA helix on a cylinder of 20 mm at 300 rad/s (`scripts/bench/helix.toml`):\n"]
    parts += ["| turns | CPU s | CPU s a turn | live nodes | times real time |", "|---|---|---|---|---|"]
    for line in found["turns"]:
        turns = line["turns"]
        parts.append(
            f"| {turns:.0f} | {line['cpu_s']:.2f} | {line['cpu_s'] / turns:.3f} | {line['nodes_mean']:.0f} | {line['rtf']:.2f} |"
        )
    return "\n".join(parts)


def fmu(found):
    """The cost of the interface."""
    ratio = found["fmu_cpu_s"] / found["native_cpu_s"]
    same = "the same fed length, to the bit" if found["same_fed_length"] else "DIFFERENT fed lengths"
    return (
        "## FMU against native\n\n"
        f"`{found['scene']}`, {found['turns']:g} turns at {found['omega']:g} rad/s in {found['communication_steps']} communication steps:"
        f" {found['fmu_cpu_s']:.2f} s through the FMU in fmpy, {found['native_cpu_s']:.2f} s by `coilwind run --inputs` (the whole process, with its"
        f" tables): {ratio:.2f} times the CPU time, {same}."
    )


def skips(text):
    """The table of scripts/skips.py."""
    return (
        "## What each skip saves\n\n"
        "`scripts/skips.py`: `fig8` with one switch after the other set against what `auto` takes; errors of turn 2 against the converged run.\n\n"
        + text.strip()
    )
