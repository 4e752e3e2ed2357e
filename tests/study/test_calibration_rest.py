"""scripts/calibrate.py tells where what it leaves of a measurement is no noise: an angle, a tension or a scene that is off."""

import json
import subprocess

import numpy as np
import pytest

SCENE = """
[wire]
diameter_mm = 0.5
[core]
width_x_mm = 10
height_z_mm = 18
corner_radius_mm = 2
[nozzle]
distance_mm = 35
[tensioner]
tension = 8
line_length_m = 0.8
mass_g = 1
line_damping_ratio = 0.1
[spindle]
speed_rpm = 1800
turns = 1.3
[traverse]
per_turn_mm = 1.2
"""
TRUTH = {"tensioner.mass": 0.0023, "tensioner.line_damping_ratio": 0.22}
NOISE = 0.08
DEGREES = np.arange(40.0, 445.0, 3.3)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "machine.toml"
    path.write_text(SCENE, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def measured(scene, command):
    """A file of the machine's tension, with what is wrong with the sensors."""
    run = scene.parent / "run"
    sets = [word for name, value in TRUTH.items() for word in ("--set", f"{name}={value}")]
    subprocess.run([command, "run", scene, *sets, "--no-geometry", "--no-report", "--quiet", "--out", run], check=True)
    history = np.genfromtxt(run / "history.csv", delimiter=",", names=True)
    exact = np.interp(DEGREES, np.degrees(history["spindle_angle"]), history["wire_tension"])

    def write(path, ahead=0.0, more=0.0, times=1.0, seed=1):
        tension = times * (exact + np.random.default_rng(seed).normal(0.0, NOISE, exact.size)) + more
        rows = [f"{angle:.4f},{pull:.5f}\n" for angle, pull in zip(DEGREES + ahead, tension)]
        path.write_text("angle_deg,tension_N\n" + "".join(rows), encoding="utf-8")
        return path

    return write


@pytest.fixture(scope="module")
def calibrate(scene, command, script):
    def run(out, *files, fits=tuple(TRUTH), words=()):
        given = [word for file in files for word in ("--measured", file)] + [word for name in fits for word in ("--fit", name)]
        code, said = script("scripts/calibrate.py", scene, *given, *words, "--command", command, "--out", out)
        return code, said, json.loads((out / "calibration.json").read_text(encoding="utf-8"))

    return run


def test_a_search_that_falls_to_an_end_of_its_range_is_told_in_a_line(calibrate, measured, tmp_path):
    """It ended in a traceback: `Singular matrix`."""
    code, said, result = calibrate(tmp_path, measured(tmp_path / "m.csv", ahead=-12.0))
    assert code == 1 and "Traceback" not in said, said
    assert "no fit: tensioner.line_damping_ratio ended at the upper end of its range" in said and "wind with" not in said, said
    assert not result["fitted"]
