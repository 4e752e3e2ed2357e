"""Importers and checkers by other people accept the FMU and get from it what fmpy gets."""

import json
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
def test_the_same_numbers_to_the_bit(importer, importers_python, fmu_path, reference, tmp_path):
    script, result = DRIVERS / f"drive_{importer}.py", tmp_path / "result.json"
    ran = subprocess.run(
        [importers_python, script, fmu_path, result], capture_output=True, text=True, timeout=600, check=False
    )
    assert ran.returncode == 0, ran.stderr[-4000:]
    rows = json.loads(result.read_text())
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
    assert "This FMU seems to be compliant with FMI-2.0." in said, said
    assert "No semantic error" in said, said
