"""scripts/cross_check.py writes what the FMI cross check asks for, and another run of the FMU gets the reference."""

import csv
import subprocess
import sys

import fmpy
import numpy as np
import pytest
from conftest import ROOT


@pytest.fixture(scope="module")
def files(fmu_path, tmp_path_factory):
    out = tmp_path_factory.mktemp("cross_check")
    line = [sys.executable, ROOT / "scripts/cross_check.py", "--fmu", fmu_path, "--out", out]
    ran = subprocess.run(line, capture_output=True, text=True, timeout=300, check=False)
    assert ran.returncode == 0, ran.stderr[-4000:]
    return out


def test_simulating_the_input_gives_the_reference(files, fmu_path):
    options = dict(
        line.split(", ") for line in (files / "CoilWinding_ref.opt").read_text(encoding="ascii").splitlines()
    )
    assert list(options) == ["StartTime", "StopTime", "StepSize", "RelTol"]
    with open(files / "CoilWinding_ref.csv", encoding="ascii", newline="") as file:
        rows = list(csv.reader(file))
    names, values = rows[0], np.array(rows[1:], dtype=float)
    signals = np.genfromtxt(files / "CoilWinding_in.csv", delimiter=",", names=True)
    result = fmpy.simulate_fmu(
        fmu_path, stop_time=float(options["StopTime"]), output_interval=float(options["StepSize"]),
        relative_tolerance=float(options["RelTol"]), input=signals, output=names[1:],
    )
    assert len(result) == len(values) == len(signals)
    for k, name in enumerate(names):
        # (points of time differ in their last digit, which the solver's steps pass on)
        close = 1e-12 if name in ("time", "spindle_angle") else 1e-4
        assert np.allclose(result[name], values[:, k], rtol=close, atol=close), name
    assert np.ptp(values[:, names.index("turns_wound")]) > 1.0
