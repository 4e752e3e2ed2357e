"""Importers and checkers by other people accept the FMU and get from it what fmpy gets."""

import json
import os
import subprocess
from pathlib import Path

import pytest
from short_wind import OUTPUTS, SCENE, STEP, STEPS, as_text, inputs_at

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PYTHON = os.environ.get("COILWIND_IMPORTERS_PYTHON", "")
"""Python of the environment that `scripts/venv.sh importers` makes."""


@pytest.fixture(scope="session")
def importers_python():
    assert PYTHON, "COILWIND_IMPORTERS_PYTHON is not set; scripts/test.sh does, to what scripts/venv.sh importers prints"
    missing = subprocess.run(
        [ROOT / "scripts/missing_tools.sh", "importers"], capture_output=True, text=True, check=True
    ).stdout
    if missing:
        pytest.skip(missing.strip())
    return PYTHON


@pytest.fixture
def reference(make_slave):
    """The wind through fmpy."""
    slave = make_slave("winder")
    slave.start(scene__file=SCENE)
    rows = []
    for k in range(STEPS):
        slave.set(**inputs_at(k))
        slave.fmu.doStep(k * STEP, STEP)
        rows.append({name: as_text(slave.get(name)) for name in OUTPUTS})
    return rows


@pytest.mark.parametrize("importer", ("libcosim", "ecos"))
def test_the_same_numbers_to_the_bit(importer, importers_python, fmu_path, reference):
    script = HERE / f"drive_{importer}.py"
    ran = subprocess.run(
        [importers_python, script, fmu_path], capture_output=True, text=True, timeout=600, check=False
    )
    assert ran.returncode == 0, ran.stderr[-4000:]
    # Importers may print on their own account; the result is the last line.
    rows = json.loads(ran.stdout.strip().splitlines()[-1])
    assert len(rows) == STEPS
    for k, (row, expected) in enumerate(zip(rows, reference)):
        assert row == expected, f"step {k}"
    # A wind in which nothing moved would prove nothing.
    for name in OUTPUTS:
        assert reference[0][name] != reference[-1][name], name


def test_the_manipulation_toolbox_finds_nothing_wrong(importers_python, fmu_path):
    fmutool = Path(importers_python).with_name("fmutool")
    ran = subprocess.run(
        [fmutool, "-input", fmu_path, "-check", "-summary"],
        capture_output=True, text=True, timeout=600, check=False,
    )
    said = ran.stdout + ran.stderr
    assert ran.returncode == 0, said
    assert "ERROR" not in said and "WARNING" not in said, said
    assert "This FMU seems to be OK" in said, said
