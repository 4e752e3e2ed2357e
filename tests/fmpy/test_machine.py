"""The machine of examples/machine: two masters, a System Structure, and numbers that obey the machine's own equations."""

import csv
import math
import subprocess
import zipfile

import pytest
from conftest import ROOT, python_of

INERTIA, TORQUE_LIMIT, FULL_SPEED = 2e-4, 0.5, 100.0
"""Of the spindle drive: kg m2, N m, rad/s."""


@pytest.fixture(scope="session")
def machine(fmu_path, tmp_path_factory):
    """The folder that the one command leaves, and what it says. It is named from the folder where the command is given."""
    python = python_of("COILWIND_MACHINE_PYTHON", "machine")
    here = tmp_path_factory.mktemp("machine")
    ran = subprocess.run(
        [python, ROOT / "examples/machine/run.py", "--fmu", fmu_path, "--out", "target/machine"],
        capture_output=True, text=True, timeout=600, check=False, cwd=here,
    )
    assert ran.returncode == 0, ran.stderr[-4000:]
    return here / "target/machine", ran.stdout


@pytest.fixture(scope="session")
def columns(machine):
    with open(machine[0] / "machine.csv", encoding="ascii", newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def test_the_spindle_turns_as_torque_and_wire_make_it(columns):
    """Inertia times acceleration is the drive's torque and the wire's, which the masters hand on a step late."""
    speed, drive = columns["spindle.speed"], columns["spindle.torque"]
    wire, step = columns["coil.spindle_torque_total"], columns["time"][1] - columns["time"][0]
    # where the drive is at its limit, its torque is nearly the same all through a step
    steady = [k for k in range(2, len(speed)) if drive[k] == drive[k - 1] == TORQUE_LIMIT]
    assert len(steady) > 200
    for k in steady:
        gained = INERTIA * (speed[k] - speed[k - 1]) / step
        assert gained == pytest.approx(TORQUE_LIMIT + wire[k - 1], abs=1e-4)
    turned = columns["coil.spindle_angle"]
    for k in range(2, len(speed)):
        assert turned[k] - turned[k - 1] == pytest.approx(speed[k - 1] * step, abs=1e-9)


def test_speed_dips_and_tension_jumps_at_corners(columns):
    """Twice a turn a narrow side of the core meets the wire: there it draws least, so that the spindle runs ahead."""
    angle, wire = columns["coil.spindle_angle"], columns["coil.spindle_torque_total"]
    speed, tension = columns["spindle.speed"], columns["coil.wire_tension"]
    assert max(columns["spindle.torque"]) == TORQUE_LIMIT
    full = [k for k, t in enumerate(columns["time"]) if t > 0.12]
    near = 30
    middle = 0.5 * (max(wire[k] for k in full) + min(wire[k] for k in full))
    easiest = [k for k in full[near:-near] if middle < wire[k] == max(wire[k - near : k + near + 1])]
    assert len(easiest) >= 3
    for a, b in zip(easiest, easiest[1:]):
        assert angle[b] - angle[a] == pytest.approx(math.pi, abs=0.15)
    swing = 2 * (max(wire[k] for k in full) - middle)
    assert 0.1 < swing < 0.3, swing
    highest, lowest = (f(speed[k] for k in full) for f in (max, min))
    assert 0.5 < highest - FULL_SPEED < 3.0 and 0.3 < FULL_SPEED - lowest < 2.0, (lowest, highest)
    for k in easiest:
        after = speed[k : k + near]
        assert max(after) > FULL_SPEED + 0.5
        ring = [tension[j] - columns["coil.tension_setpoint"][j] for j in range(k, k + near)]
        assert 0.3 < max(map(abs, ring)) < 4.0
    off = [tension[k] - columns["coil.tension_setpoint"][k] for k in full]
    assert abs(sum(off) / len(off)) < 0.05


def test_both_masters_see_the_same_machine(machine):
    """A table of values at the end: libcosim opens the System Structure by itself and gets what fmpy gets."""
    out, said = machine
    _, *rows = [line.split() for line in said.splitlines()]
    values = {name: (float(here), float(there)) for name, here, there in rows[:9]}
    assert len(values) == 9, said
    for name, (here, there) in values.items():
        # (the tension rings at a corner; one step late is another phase)
        close = 0.02 if name in ("coil.wire_tension", "coil.spindle_torque_total") else 1e-3
        assert there == pytest.approx(here, rel=close), name
    with zipfile.ZipFile(out / "WindingMachine.ssp") as ssp:
        assert "SystemStructure.ssd" in ssp.namelist()
        assert len([name for name in ssp.namelist() if name.endswith(".fmu")]) == 4
    assert (out / "machine.png").stat().st_size > 30_000
