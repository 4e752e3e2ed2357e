"""Markdown tables in files of their own, for the pages under docs/validation/."""

import datetime
import os
import platform
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
VALIDATION = ROOT / "docs" / "validation"
TABLES = VALIDATION / "tables"


def table(head, rows):
    """Lines of a Markdown table."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines)


def write(folder, name, command, title, *parts):
    """Writes `name`.md: the command that wrote it as a comment, a heading, and paragraphs or tables."""
    folder.mkdir(parents=True, exist_ok=True)
    head = f"<!-- Written by `{command}`. Change the script, not this file. -->"
    path = folder / f"{name}.md"
    path.write_text("\n\n".join([head, f"# {title}", *parts]) + "\n", encoding="utf-8")
    return path


def machine():
    """Day, processor, cores and system, without names."""
    return f"{datetime.date.today().isoformat()}; {processor()}, {os.cpu_count()} cores, {platform.system()}"


def compiler():
    """Name and version of the Rust compiler."""
    words = subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=False).stdout.split()
    return " ".join(words[:2]) or "rustc unknown"


def processor():
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()
