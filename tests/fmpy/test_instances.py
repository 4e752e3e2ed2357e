"""Many instances: in threads, one after the other, and from folders with odd names."""

import gc
import shutil
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import fmpy
import pytest
from conftest import Slave
from drive import run
from signals import duration, winding_signals

SCENE = "fig8"
STEPS = 20


def wind(unzipped, description, speed):
    """Outputs along a run of an instance of its own."""
    slave = Slave(unzipped, description, f"at {speed}")
    signals = winding_signals(speed, 0.35, 0.7e-3, 0.0, STEPS)
    rows = run(slave, signals, duration(speed, 0.35) / STEPS, scene__file=SCENE)
    slave.free()
    return rows


def test_eight_instances_in_four_threads(unzipped, description):
    speeds = [150 + 50 * k for k in range(8)]
    serial = [wind(unzipped, description, speed) for speed in speeds]
    with ThreadPoolExecutor(4) as pool:
        threaded = list(pool.map(lambda speed: wind(unzipped, description, speed), speeds))
    assert threaded == serial


def resident():
    """Memory of this process, kB."""
    status = Path("/proc/self/status")
    if not status.exists():
        pytest.skip("no /proc to read the memory from")
    line = next(line for line in status.read_text().splitlines() if line.startswith("VmRSS:"))
    return int(line.split()[1])


def test_two_hundred_lives_leave_nothing_behind(unzipped, description):
    def live():
        slave = Slave(unzipped, description, "one of many")
        slave.start(scene__file=SCENE)
        slave.set(spindle_speed=50.0)
        for k in range(3):
            slave.fmu.doStep(k * 1e-4, 1e-4)
        state = slave.fmu.getFMUstate()
        slave.fmu.serializeFMUstate(state)
        slave.fmu.freeFMUstate(state)
        slave.free()

    after = []
    for _ in range(4):
        for _ in range(50):
            live()
        gc.collect()
        after.append(resident())
    # one instance takes some megabytes; 150 lives may not leave one behind
    assert after[-1] - after[0] < 1024, after


@pytest.mark.parametrize("name", ("with space", "a%41b", "Größe 线圈", "all %20 ü of+it#?"))
def test_folders_with_odd_names(fmu_path, description, tmp_path, name):
    directory = tmp_path / name
    fmpy.extract(fmu_path, str(directory))
    scenes = directory / "resources" / "scenes"
    # found only where the path is read right
    text = (scenes / "fig8.toml").read_text(encoding="utf-8")
    (scenes / "mine ü.toml").write_text(text, encoding="utf-8")
    slave = Slave(str(directory), description)
    slave.start(scene__file="mine ü.toml", output__directory=str(directory / "out %s %n"))
    slave.fmu.doStep(0.0, 1e-4)
    slave.fmu.terminate()
    assert (directory / "out %s %n" / "history.csv").is_file()
    slave.free()
    shutil.rmtree(directory, ignore_errors=True)
