#!/usr/bin/env python3
"""Writes the two reference pages from the variable table of the command.

    reference_pages.py [--command PATH] [--check]

docs/guide/scene-reference.md lists every key of a scene file, docs/fmu/variables.md every variable
of the FMU. With --check nothing is written; the exit code is 1 if a page on disk differs.
"""

import argparse
import json
import math
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HEADER = "<!-- Written by scripts/reference_pages.py from `coilwind variables --json`. Do not edit. -->"

# Size of one SI unit in the unit that people read.
SHOWN_PER_SI = {
    "mm": 1e3,
    "um": 1e6,
    "mm/s": 1e3,
    "um/rad": 1e6,
    "deg": 180 / math.pi,
    "rpm": 30 / math.pi,
    "ms": 1e3,
    "us": 1e6,
    "g": 1e3,
    "N.mm": 1e3,
    "MPa": 1e-6,
}

# What a section of the scene file describes.
SECTIONS = {
    "wire": "The wire's size and material.",
    "core": "The body that the wire is wound on. Each shape reads only the keys whose meaning names it. Keys that begin with `flange.` may stand under `[core.flange]`.",
    "nozzle": "The nozzle that guides the wire.",
    "tensioner": "What holds the wire back in front of the nozzle.",
    "start": "Where the wire's end is clamped.",
    "spindle": "The motion of the core under `coilwind run` without `--inputs`.",
    "traverse": "The motion of the nozzle under `coilwind run` without `--inputs`. The FMU has another default of `mode`, see [speed only](../fmu/inputs.md#speed-only).",
    "winding": "What the layered modes of `traverse.mode` wind under `coilwind run` without `--inputs`.",
    "contact": "The contact of wire with core and wire.",
    "friction": "The friction of wire on core and wire.",
    "solver": "Accuracy of the computation, and what it takes into account.",
    "freeze": "When settled wire becomes fixed geometry.",
    "defects": "The limits of the defect flags.",
    "output": "What is written, and where.",
}

SCENE_INTRO = """\
# Scene reference

For writing scene files: every section and key with its unit, default, range and meaning.

A scene is a TOML file. `coilwind check FILE` validates it, and `coilwind variables` prints this table.
[Your first coil](first-coil.md) shows a scene in use.

- A key without a suffix is in the unit of the column *unit*. The column *spellings* lists the keys that carry
  another unit: `diameter = 0.0007` and `diameter_mm = 0.7` mean the same.
- A key that is left out has its default. An unknown key is an error.
- `--set SECTION.KEY=VALUE` changes one key of a run, with or without a unit: `--set wire.diameter_mm=0.5`.
"""

VARIABLES_INTRO = """\
# Variables of the FMU

For connecting the FMU: every input, output and parameter with its unit, start value, range and meaning.

- Every value is in the unit of its column. `modelDescription.xml` gives importers the display unit as well.
- *fixed* parameters are set before `fmi2ExitInitializationMode`. *tunable* ones may also change at a communication point.
- A parameter that the importer sets wins over `scene.file`, which wins over the default. Only `traverse.mode` of a scene file is
  not taken: the FMU starts with `by-input` until the importer sets another, see [speed only](inputs.md#speed-only).
- A text with choices has a twin that takes the number of the choice, `core.shape_number` for `core.shape`; scene files have the text only.
- Keys of `[spindle]` and `output.history_interval` do not exist here: the spindle is an input. `traverse.mode` says whether the nozzle is one.

[Inputs](inputs.md) says when an input counts. [Measures and flags](../guide/measures.md) explains the measures.
"""


@dataclass
class Page:
    """A page: where it lies, and its text."""

    path: Path
    text: str

    def is_current(self):
        return self.path.exists() and self.path.read_text(encoding="utf-8") == self.text


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    built = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release/coilwind"
    command = os.environ.get("COILWIND_COMMAND", str(built))
    parser.add_argument("--command", metavar="PATH", default=command, help="the command coilwind; COILWIND_COMMAND names it too")
    parser.add_argument("--check", action="store_true", help="compare with the files, write nothing")
    arguments = parser.parse_args()

    variables = read_variables(arguments.command)
    pages = [
        Page(ROOT / "docs/guide/scene-reference.md", scene_page(variables)),
        Page(ROOT / "docs/fmu/variables.md", variables_page(variables)),
    ]
    stale = [page for page in pages if not page.is_current()]
    for page in stale:
        place = page.path.relative_to(ROOT)
        if arguments.check:
            print(f"{place} is not what scripts/reference_pages.py writes; run it", file=sys.stderr)
        else:
            page.path.parent.mkdir(parents=True, exist_ok=True)
            page.path.write_text(page.text, encoding="utf-8")
            print(f"wrote {place}")
    sys.exit(1 if arguments.check and stale else 0)


def read_variables(command):
    """The rows of the variable table."""
    try:
        told = subprocess.run([command, "variables", "--json"], capture_output=True, text=True, check=True)
    except OSError as error:
        raise SystemExit(f"cannot run {command}: {error.strerror}; build it, or name it with --command") from error
    return json.loads(told.stdout)


def scene_page(variables):
    """Every key of a scene file, a table per section."""
    parameters = [v for v in variables if v["causality"] == "parameter" and v["name"] != "scene.file" and not v["fmuOnly"]]
    top = [v for v in parameters if "." not in v["name"]]
    parts = [HEADER, "", SCENE_INTRO, "## Top level", "", *key_table(top)]
    for section in dict.fromkeys(v["name"].split(".")[0] for v in parameters if "." in v["name"]):
        rows = [v for v in parameters if v["name"].startswith(f"{section}.")]
        parts += ["", f"## [{section}]", "", SECTIONS[section], "", *key_table(rows)]
    return "\n".join(parts) + "\n"


def key_table(rows):
    return table(
        ["key", "unit", "spellings", "default", "range", "meaning"],
        [
            [
                f"`{leaf(v)}`",
                unit(v),
                ", ".join(f"`{leaf(v)}_{suffix}`" for suffix in v["keySuffixes"]),
                shown_start(v),
                allowed(v),
                v["description"],
            ]
            for v in rows
        ],
    )


def variables_page(variables):
    """Every variable of the FMU, a table per causality."""
    inside = [v for v in variables if not v["nativeOnly"]]
    parts = [HEADER, "", VARIABLES_INTRO]
    for title, causality, heads in (
        ("Inputs", "input", ["name", "type", "unit", "start", "range", "causality, variability", "meaning"]),
        ("Outputs", "output", ["name", "type", "unit", "causality, variability", "meaning"]),
        ("Diagnostics", "local", ["name", "type", "unit", "causality, variability", "meaning"]),
        ("Parameters", "parameter", ["name", "type", "unit", "start", "range", "causality, variability", "meaning"]),
    ):
        rows = [v for v in inside if v["causality"] == causality]
        parts += [f"## {title}", "", *table(heads, [[CELLS[head](v) for head in heads] for v in rows]), ""]
    return "\n".join(parts).rstrip("\n") + "\n"


CELLS = {
    "name": lambda v: f"`{v['name']}`",
    "type": lambda v: v["type"],
    "unit": lambda v: unit(v),
    "start": lambda v: shown_start(v | {"start": v["fmuStart"] or v["start"]}),
    "range": lambda v: allowed(v),
    "causality, variability": lambda v: f"{v['causality']}, {v['variability']}",
    "meaning": lambda v: v["description"],
}


def leaf(v):
    return v["name"].partition(".")[2] or v["name"]


def unit(v):
    return "" if v["unit"] in ("", "1") else v["unit"]


def shown_start(v):
    """The default, and beside it what people read: 0.0007 (0.7 mm)."""
    start = v["start"]
    if start is None:
        return ""
    if isinstance(start, str):
        return f'`"{start}"`'
    if isinstance(start, bool):
        return f"`{str(start).lower()}`"
    text = f"{start:.6g}"
    if start and v["displayUnit"]:
        text += f" ({start * SHOWN_PER_SI[v['displayUnit']]:.4g} {v['displayUnit']})"
    return text


def allowed(v):
    """The range, or the choices."""
    if v["choices"]:
        return ", ".join(f"`{choice}`" for choice in v["choices"])
    if v["type"] == "Boolean":
        return "`true`, `false`"
    if v["type"] == "String":
        return "a text"
    ends = v["min"], v["max"]
    return "" if None in ends else f"{ends[0]:.6g} to {ends[1]:.6g}"


def table(heads, rows):
    """Lines of a Markdown table."""
    lines = [heads, ["---"] * len(heads)]
    lines += [[cell.replace("|", "\\|") for cell in row] for row in rows]
    return ["| " + " | ".join(line) + " |" for line in lines]


if __name__ == "__main__":
    main()
