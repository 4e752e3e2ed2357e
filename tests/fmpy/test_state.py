"""Saved states through fmpy: continuation to the bit, here, in a new process, and what is refused."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ERROR, ROOT
from fmpy.fmi1 import FMICallException
from signals import duration, winding_signals

SCENE = "fig8"
SPEED = 400
TURNS = 0.6
STEPS = 60
SIGNALS = winding_signals(SPEED, TURNS, 0.7e-3, 0.0, STEPS)
SIZE = duration(SPEED, TURNS) / STEPS


def go(slave, first, last):
    """Makes steps and returns every output after each."""
    rows = []
    for k in range(first, last):
        slave.set(
            spindle_speed=float(SIGNALS["spindle_speed"][k]),
            nozzle_position=float(SIGNALS["nozzle_position"][k]),
        )
        slave.fmu.doStep(float(SIGNALS["time"][k]), SIZE)
        rows.append(slave.outputs())
    return rows


@pytest.fixture(scope="module")
def uninterrupted(unzipped, description):
    from conftest import Slave

    slave = Slave(unzipped, description, "uninterrupted")
    slave.start(scene__file=SCENE)
    rows = go(slave, 0, STEPS)
    slave.free()
    return rows


@pytest.mark.parametrize("at", (0, 1, 23, 41, 59))
def test_a_state_continues_to_the_bit(slave, uninterrupted, at):
    slave.start(scene__file=SCENE)
    go(slave, 0, at)
    state = slave.fmu.getFMUstate()
    assert go(slave, at, STEPS) == uninterrupted[at:]
    slave.fmu.setFMUstate(state)
    assert go(slave, at, STEPS) == uninterrupted[at:]
    data = slave.fmu.serializeFMUstate(state)
    slave.fmu.freeFMUstate(state)
    slave.fmu.reset()
    state = slave.fmu.deSerializeFMUstate(data)
    slave.fmu.setFMUstate(state)
    assert go(slave, at, STEPS) == uninterrupted[at:]
    slave.fmu.freeFMUstate(state)


def test_a_state_continues_in_a_new_process(slave, uninterrupted, unzipped, fmu_path, tmp_path):
    slave.start(scene__file=SCENE, friction__static=0.23)
    go(slave, 0, 30)
    state = slave.fmu.getFMUstate()
    (tmp_path / "state").write_bytes(slave.fmu.serializeFMUstate(state))
    slave.fmu.freeFMUstate(state)
    program = f"""
import sys, json
sys.path[:0] = [{str(Path(__file__).parent)!r}]
import conftest, fmpy, test_state
description = fmpy.read_model_description({fmu_path!r})
slave = conftest.Slave({unzipped!r}, description)
data = open({str(tmp_path / "state")!r}, "rb").read()
slave.fmu.setFMUstate(slave.fmu.deSerializeFMUstate(data))
print(json.dumps(test_state.go(slave, 30, test_state.STEPS)))
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == uninterrupted[30:]


def test_one_place_for_many_saves(slave):
    from ctypes import byref

    slave.start(scene__file=SCENE)
    state = slave.fmu.getFMUstate()
    place = state.value
    go(slave, 0, 2)
    later = slave.outputs()
    slave.fmu.fmi2GetFMUstate(slave.fmu.component, byref(state))
    assert state.value == place
    go(slave, 2, 4)
    slave.fmu.setFMUstate(state)
    assert slave.outputs() == later
    slave.fmu.fmi2FreeFMUstate(slave.fmu.component, byref(state))
    assert state.value is None
    slave.fmu.fmi2FreeFMUstate(slave.fmu.component, byref(state))
    slave.fmu.fmi2FreeFMUstate(slave.fmu.component, None)


def refused(slave, data):
    told = len(slave.log)
    with pytest.raises(FMICallException) as caught:
        slave.fmu.deSerializeFMUstate(data)
    assert caught.value.status == ERROR
    assert len(slave.log) == told + 1
    return slave.reason()


def test_bytes_that_are_no_state_change_nothing(slave, uninterrupted):
    slave.start(scene__file=SCENE)
    go(slave, 0, 20)
    state = slave.fmu.getFMUstate()
    good = slave.fmu.serializeFMUstate(state)
    slave.fmu.freeFMUstate(state)
    assert "not a state" in refused(slave, b"nothing of the kind")
    assert "version" in refused(slave, good[:8] + b"\x63" + good[9:])
    foreign = good[:13] + bytes([good[13] ^ 1]) + good[14:]
    assert "is of the FMU" in refused(slave, foreign)
    assert "bytes" in refused(slave, good[:-1])
    assert "bytes" in refused(slave, good[: len(good) // 2])
    middle = len(good) // 2
    damaged = good[:middle] + bytes([good[middle] ^ 1]) + good[middle + 1 :]
    assert "checksum" in refused(slave, damaged)
    assert go(slave, 20, STEPS) == uninterrupted[20:]


def test_history_is_cut_back_to_the_restored_state(make_slave, tmp_path):
    plain, back = make_slave("plain"), make_slave("back")
    plain.start(scene__file=SCENE, output__directory=str(tmp_path / "plain"))
    go(plain, 0, 12)
    back.start(scene__file=SCENE, output__directory=str(tmp_path / "back"))
    go(back, 0, 5)
    state = back.fmu.getFMUstate()
    go(back, 5, 9)
    back.fmu.setFMUstate(state)
    go(back, 5, 12)
    for slave in (plain, back):
        slave.fmu.terminate()
    for name in ("history.csv", "turns.csv", "coil.vtp"):
        assert (tmp_path / "plain" / name).read_bytes() == (tmp_path / "back" / name).read_bytes()


def test_the_script_that_measures_costs(fmu_path):
    line = [sys.executable, ROOT / "scripts/state_costs.py", "--fmu", fmu_path, "--turns", "1"]
    said = subprocess.run(line, capture_output=True, text=True, timeout=300, check=True).stdout
    head, _, row = [[cell.strip() for cell in text.strip("|").split("|")] for text in said.splitlines()]
    costs = {name: float(cell) for name, cell in zip(head, row, strict=True)}
    assert 1.0 <= costs["turns"] < 6.0 and costs["bytes kB"] > 100.0
    # one derivative takes some steps, a state hardly any of one
    assert costs["get ms"] < costs["step ms"] < costs["derivative ms"]
