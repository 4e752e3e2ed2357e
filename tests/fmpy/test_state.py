"""Saved states through fmpy: continuation to the bit, here, in a new process, and what is refused."""

import json
import subprocess
import sys
from pathlib import Path

import fmpy
import pytest
from conftest import ERROR, ROOT, Slave
from fmpy.fmi1 import FMICallException
from signals import duration, winding_signals
from test_masters import bar

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


def wound_on_a_mesh(slave, **parameters):
    """The bytes of a state on the way, and what follows it."""
    slave.start(inputs={"spindle_speed": 20.0}, **parameters)
    slave.fmu.doStep(0.0, 1e-3)
    state = slave.fmu.getFMUstate()
    data = slave.fmu.serializeFMUstate(state)
    slave.fmu.doStep(1e-3, 1e-3)
    return data, slave.outputs()


def gone_on(slave, data):
    slave.fmu.setFMUstate(slave.fmu.deSerializeFMUstate(data))
    slave.fmu.doStep(1e-3, 1e-3)
    return slave.outputs()


def test_a_state_finds_its_mesh_from_another_folder(make_slave, tmp_path, monkeypatch):
    """The name counted from wherever the process stood, and a file of that name there was taken for the mesh."""
    here, there = tmp_path / "here", tmp_path / "there"
    for folder, length in ((here, 30.0), (there, 20.0)):
        folder.mkdir()
        (folder / "bar.stl").write_text(bar(12.0, 30.0, length), encoding="utf-8")
    monkeypatch.chdir(here)
    mesh = {"core__shape": "mesh", "core__file": "bar.stl", "core__unit": "mm"}
    data, rest = wound_on_a_mesh(make_slave(), **mesh)
    monkeypatch.chdir(there)
    other = make_slave()
    assert gone_on(other, data) == rest
    assert other.get("core.file") == b"bar.stl"
    # bytes of bytes, and a parameter that is set in between
    state = other.fmu.getFMUstate()
    again = other.fmu.serializeFMUstate(state)
    monkeypatch.chdir(tmp_path)
    third = make_slave()
    third.fmu.setFMUstate(third.fmu.deSerializeFMUstate(again))
    third.set(defects__gap=0.3)
    third.fmu.doStep(2e-3, 1e-3)
    (here / "bar.stl").unlink()
    text = refused(make_slave(), data)
    assert "core.file" in text and str(here / "bar.stl") in text, text


def test_a_state_finds_its_mesh_in_an_fmu_unpacked_elsewhere(fmu_path, description, tmp_path):
    slaves = []
    for name in ("first", "second"):
        unpacked = tmp_path / name
        fmpy.extract(fmu_path, str(unpacked))
        scene = '[core]\nshape = "mesh"\nfile = "bar.stl"\nunit = "mm"\n'
        (unpacked / "resources/scenes/mine.toml").write_text(scene, encoding="utf-8")
        (unpacked / "resources/scenes/bar.stl").write_text(bar(12.0, 30.0, 30.0), encoding="utf-8")
        slaves.append(Slave(str(unpacked), description))
    data, rest = wound_on_a_mesh(slaves[0], scene__file="mine.toml")
    (tmp_path / "first/resources/scenes/bar.stl").unlink()
    assert gone_on(slaves[1], data) == rest
    (tmp_path / "second/resources/scenes/bar.stl").unlink()
    text = refused(slaves[1], data)
    for name in ("first", "second"):
        assert str(tmp_path / name / "resources/scenes/bar.stl") in text, text
    for slave in slaves:
        slave.free()


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
