"""tests/c/drive.c, a plain C importer, on every platform and under every checker that is here."""

import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT, need

SOURCE = ROOT / "tests/c/drive.c"
STUB = ROOT / "tests/c/bcryptprimitives.c"
CYCLES = 1000
"""Instances made, run and freed while the address sanitizer counts every byte."""
WIND_STEPS = 120
"""A third of a turn: two landings, contact, friction."""


def run(command, **options):
    return subprocess.run(
        [str(word) for word in command], capture_output=True, text=True, timeout=1800, check=False, **options
    )


def compiled(directory, name, compiler, *flags):
    """The program, or the reason why it does not compile."""
    program = directory / name
    words = [*shlex.split(compiler), "-std=c99", "-Wall", "-Wextra", "-Werror", "-g", "-O1", *flags]
    made = run([*words, SOURCE, "-o", program, *([] if name.endswith(".exe") else ["-ldl", "-lm"])])
    assert made.returncode == 0, made.stderr
    return program


@pytest.fixture(scope="session")
def directory(tmp_path_factory):
    return tmp_path_factory.mktemp("c")


@pytest.fixture(scope="session")
def target(unzipped, description):
    """Library, GUID and resources as the program takes them."""
    unzipped = Path(unzipped)
    return [
        unzipped / "binaries/linux64/CoilWinding.so",
        description.guid,
        (unzipped / "resources").as_uri(),
    ]


@pytest.fixture(scope="session")
def plain(directory):
    need("c")
    return compiled(directory, "drive", os.environ.get("CC", "cc"))


@pytest.fixture(scope="session")
def sanitized(directory):
    need("sanitizer")
    return compiled(
        directory, "drive_sanitized", os.environ.get("CC", "cc"), "-fsanitize=address,undefined"
    )


def passes(command, **options):
    ran = run(command, **options)
    assert ran.returncode == 0, ran.stderr[-6000:]
    return ran


def tasks(description):
    """What is asked of the program; states only where the description promises them."""
    keeps_states = description.coSimulation.canSerializeFMUstate
    return ["refusals", *(["states"] if keeps_states else [])]


def test_refusals_and_states(plain, target, description):
    for task in tasks(description):
        passes([plain, *target, task])


def test_a_host_that_rounds_otherwise_gets_the_same_bits_and_keeps_its_ways(plain, target):
    """Tiny numbers as zero, every direction of rounding, traps on invalid operations."""
    passes([plain, *target, "rounding", WIND_STEPS])


def test_the_library_is_loaded_and_unloaded_a_thousand_times(plain, target):
    passes([plain, *target, "reload", CYCLES])


def test_no_leak_and_no_invalid_access_over_a_thousand_instances(sanitized, target, description):
    for task in tasks(description):
        passes([sanitized, *target, task])
    passes([sanitized, *target, "cycles", CYCLES])


def test_the_sanitizer_would_see_a_leak(sanitized, target):
    ran = run([sanitized, *target, "forget"])
    assert ran.returncode != 0
    assert "LeakSanitizer" in ran.stderr


def test_valgrind_sees_no_invalid_access(plain, target, description):
    need("valgrind")
    valgrind = [
        "valgrind", "--quiet", "--error-exitcode=9", "--leak-check=full",
        "--errors-for-leak-kinds=definite,indirect", "--show-leak-kinds=definite,indirect",
    ]
    for task in tasks(description):
        passes([*valgrind, plain, *target, task])
    passes([*valgrind, plain, *target, "cycles", 20])
    passes([*valgrind, plain, *target, "wind", 40])


def rows_of(wind):
    rows = [line.split() for line in wind.stdout.splitlines()]
    assert len(rows) == WIND_STEPS
    assert all(re.fullmatch("[0-9a-f]{16}", cell) for row in rows for cell in row)
    assert rows[0] != rows[-1]
    return rows


def test_windows_gives_the_same_numbers_to_the_bit(plain, target, unzipped, description, tmp_path):
    """The win64 library under wine, driven by the same source."""
    need("wine")
    library = Path(unzipped) / "binaries/win64/CoilWinding.dll"
    if not library.is_file():
        pytest.skip("wine: this FMU has no win64 library; scripts/build_fmu.sh --portable makes one")
    compiler = "x86_64-w64-mingw32-gcc"
    program = compiled(tmp_path, "drive.exe", compiler, "-D__USE_MINGW_ANSI_STDIO=1", "-static-libgcc")
    # Wine before 9 lacks this library of Windows 10; the program's directory is searched first.
    stub = run([compiler, "-shared", "-O1", STUB, "-o", tmp_path / "bcryptprimitives.dll", "-ladvapi32"])
    assert stub.returncode == 0, stub.stderr
    shutil.copy(library, tmp_path)
    wine = "wine64" if shutil.which("wine64") else "wine"
    environment = os.environ | {
        "WINEPREFIX": str(tmp_path / "prefix"),
        "WINEDEBUG": "-all",
        # No window, no .NET, no browser engine: nothing to ask for.
        "WINEDLLOVERRIDES": "mscoree,mshtml=;bcryptprimitives=n",
        "DISPLAY": "",
    }
    # Wine shows the root of this machine's files as drive Z.
    resources = "file:///Z:" + Path(unzipped, "resources").as_uri().removeprefix("file://")
    command = [wine, program.name, "CoilWinding.dll", description.guid, resources]
    options = {"cwd": tmp_path, "env": environment}
    for task in (*tasks(description), "cycles"):
        passes([*command, task, 20], **options)
    wine_wind = passes([*command, "wind", WIND_STEPS], **options)
    native_wind = passes([plain, *target, "wind", WIND_STEPS])
    assert rows_of(wine_wind) == rows_of(native_wind)
