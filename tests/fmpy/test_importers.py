"""Importers and checkers by other people accept the FMU and get from it what fmpy gets."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT, python_of

DRIVERS = ROOT / "tests/importers"
sys.path.insert(0, str(DRIVERS))
from short_wind import OUTPUTS, SCENE, STEP, STEPS, as_text, inputs_at


@pytest.fixture(scope="session")
def importers_python():
    """Python of the environment that `scripts/venv.sh importers` makes."""
    return python_of("COILWIND_IMPORTERS_PYTHON", "importers")


@pytest.fixture
def wind(make_slave):
    """Winds a scene through fmpy; rows of outputs with all their bits."""

    def rows_of(scene):
        slave = make_slave("winder")
        slave.start(scene__file=scene)
        rows = []
        for k in range(STEPS):
            slave.set(**inputs_at(k))
            slave.fmu.doStep(k * STEP, STEP)
            rows.append({name: as_text(slave.get(name)) for name in OUTPUTS})
        return rows

    return rows_of


def same(rows, expected):
    """Every output of every step is the same to the bit."""
    assert len(rows) == STEPS
    for k, (row, wanted) in enumerate(zip(rows, expected)):
        assert row == wanted, f"step {k}"
    # A wind in which nothing moved would prove nothing.
    for name in OUTPUTS:
        assert expected[0][name] != expected[-1][name], name


@pytest.mark.parametrize("importer", ("libcosim", "ecos"))
def test_the_same_numbers_to_the_bit(importer, importers_python, fmu_path, wind, tmp_path):
    script, result = DRIVERS / f"drive_{importer}.py", tmp_path / "result.json"
    ran = subprocess.run(
        [importers_python, script, fmu_path, result], capture_output=True, text=True, timeout=600, check=False
    )
    assert ran.returncode == 0, ran.stderr[-4000:]
    same(json.loads(result.read_text()), wind(SCENE))


@pytest.fixture(scope="session")
def cargo_drivers(importers_python):
    """The folder of the drivers that stand on crates; built where they are not."""
    native = Path(importers_python).parents[1].glob("lib/python*/site-packages/clang/native")
    headers = subprocess.run(["cc", "-print-file-name=include"], capture_output=True, text=True, check=True).stdout.strip()
    target = ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "importers"
    # bindgen, which `fmi` is built with, wants libclang and a compiler's own headers
    needs = {"LIBCLANG_PATH": str(next(native)), "BINDGEN_EXTRA_CLANG_ARGS": f"-I{headers}"}
    ran = subprocess.run(
        ["cargo", "build", "--locked", "--quiet", "--manifest-path", DRIVERS / "cargo/Cargo.toml", "--target-dir", target],
        env=os.environ | needs, capture_output=True, text=True, timeout=1800, check=False,
    )
    assert ran.returncode == 0, ran.stderr[-4000:]
    return target / "debug"


@pytest.mark.parametrize("importer, scene", (("fmi", SCENE), ("fmu_runner", "")))
def test_crates_get_the_same_numbers_to_the_bit(importer, scene, cargo_drivers, fmu_path, wind, tmp_path):
    table = tmp_path / "inputs.csv"
    rows = [inputs_at(k) for k in range(STEPS)]
    lines = [",".join(rows[0]), *(",".join(repr(value) for value in row.values()) for row in rows)]
    table.write_text("\n".join(lines) + "\n", encoding="ascii")
    ran = subprocess.run(
        [cargo_drivers / f"drive_{importer}", fmu_path, table, repr(STEP), ",".join(OUTPUTS)],
        capture_output=True, text=True, timeout=600, check=False,
    )
    assert ran.returncode == 0, ran.stderr[-4000:]
    got = [[as_text(value) for value in line.split(",")] for line in ran.stdout.splitlines()]
    same([dict(zip(OUTPUTS, row, strict=True)) for row in got], wind(scene))


def test_the_manipulation_toolbox_finds_nothing_wrong(importers_python, fmu_path):
    fmutool = Path(importers_python).with_name("fmutool")
    ran = subprocess.run(
        [fmutool, "-input", fmu_path, "-check", "-summary"],
        capture_output=True, text=True, timeout=600, check=False,
    )
    said = ran.stdout + ran.stderr
    assert ran.returncode == 0, said
    assert "ERROR" not in said and "WARNING" not in said, said
    assert "This FMU seems to be compliant with FMI-2.0." in said, said
    assert "No semantic error" in said, said
