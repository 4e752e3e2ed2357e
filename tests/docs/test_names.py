"""Pages name types, constants and paths that exist in the sources."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
IDENTIFIER = re.compile(r"[A-Z][A-Za-z0-9]*(::[A-Za-z_0-9]+)*|[A-Z_]{4,}")
FOLDER = re.compile(r"(src|tests|scripts|fmu|modelDescription|docs|examples|benches|fuzz)/[A-Za-z0-9_./-]+")


def listed():
    """Files of the repository, also those that are not committed yet."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()


FILES = [file for file in listed() if (ROOT / file).is_file()]
PAGES = [file for file in FILES if file.endswith(".md") and not file.startswith((".github", "tests", "modelDescription"))]
WORDS = frozenset(
    word
    for file in FILES
    if file.endswith((".rs", ".py", ".sh", ".toml", ".json", ".xml", ".yml"))
    for word in re.findall(r"\w+", (ROOT / file).read_text(encoding="utf-8"))
)


def unknown(text):
    """Names in back quotes that look like a type, a constant or a path and are none."""
    known = {parent.as_posix() for file in FILES for parent in [Path(file), *Path(file).parents]}
    for quoted in set(re.findall(r"`([^`\n]+)`", text)):
        if IDENTIFIER.fullmatch(quoted) and not WORDS.issuperset(quoted.split("::")):
            yield quoted
        elif FOLDER.fullmatch(quoted) and "KIND" not in quoted and quoted.rstrip("/") not in known:
            yield quoted


@pytest.mark.parametrize("page", PAGES)
def test_names_of_a_page_exist(page):
    assert sorted(unknown((ROOT / page).read_text(encoding="utf-8"))) == []


def test_a_name_that_is_gone_is_caught():
    # put together here, so that this file does not bring the words into the sources
    gone = ["Gone" + "Type::new", "GONE" + "_CONSTANT", "src/gone" + "/room.rs"]
    text = " ".join(f"`{name}`" for name in [*gone, "Simulation", "src/lib.rs"])
    assert sorted(unknown(text)) == sorted(gone)
