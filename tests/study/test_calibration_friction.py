"""scripts/calibrate.py fits friction within what a scene takes."""

import json
import subprocess

import numpy as np
import pytest

SCENE = """
[core]
width_x_mm = 11
height_z_mm = 26
corner_radius_mm = 2.5
length_y_mm = 60
[wire]
diameter_mm = 0.6
[nozzle]
distance_mm = 40
[tensioner]
tension_N = 11
line_length_m = 1
line_damping_ratio = 0.15
[spindle]
speed = 180
turns = 1.6
[traverse]
per_turn_mm = 6
"""
TRUTH = {"friction.static": 0.35, "friction.kinetic": 0.3}
DEGREES = np.arange(110.0, 575.0, 2.0)


@pytest.fixture(scope="module")
def measured(scene, command):
    """The width of a wire that slips where friction does not hold it."""
    run, path = scene.parent / "run", scene.parent / "m.csv"
    sets = [word for name, value in TRUTH.items() for word in ("--set", f"{name}={value}")]
    subprocess.run([command, "run", scene, *sets, "--no-geometry", "--no-report", "--quiet", "--out", run], check=True)
    history = np.genfromtxt(run / "history.csv", delimiter=",", names=True)
    width = 1e3 * np.interp(DEGREES, np.degrees(history["spindle_angle"]), history["coil_width"])
    width += np.random.default_rng(7).normal(0.0, 0.005, width.size)
    path.write_text("angle_deg,coil_width_mm\n" + "".join(f"{a:.2f},{w:.6f}\n" for a, w in zip(DEGREES, width)), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def calibrate(scene, command, script, measured):
    def run(*words):
        return script("scripts/calibrate.py", scene, "--measured", measured, "--command", command, *words)

    return run


def test_a_search_does_not_step_to_a_kinetic_friction_above_the_static_one(calibrate, tmp_path):
    """It ended with `static friction below kinetic friction`."""
    fits = [word for name, value in TRUTH.items() for word in ("--fit", f"{name}={value}")]
    _, said = calibrate(*fits, "--out", tmp_path)
    assert "impossible" not in said, said
    result = json.loads((tmp_path / "calibration.json").read_text(encoding="utf-8"))
    values = {name: result["parameters"][name]["value"] for name in TRUTH}
    assert values["friction.static"] >= values["friction.kinetic"], said
    assert values == pytest.approx(TRUTH, rel=0.06), said


def test_a_start_with_static_friction_below_kinetic_says_where_to_start(calibrate, tmp_path):
    code, said = calibrate("--set", "friction.kinetic=0.3", "--fit", "friction.static=0.2", "--out", tmp_path)
    assert code == 2 and "start above the other with --fit friction.static=VALUE" in said and len(said.splitlines()) == 1, said


@pytest.mark.parametrize("start", [(0.5, 0.12), (0.23, 0.17), (0.6, 0.25), (0.3, 0.3)])
def test_a_search_from_afar_does_not_end_in_a_wrong_pair(calibrate, tmp_path, start):
    """It ended at 0.515 and 0.180, with residuals three times the noise, and was told to wind with."""
    fits = [word for name, value in zip(TRUTH, start) for word in ("--fit", f"{name}={value}")]
    code, said = calibrate(*fits, "--fail-on-doubt", "--out", tmp_path)
    found = json.loads((tmp_path / "calibration.json").read_text(encoding="utf-8"))["parameters"]
    assert code == 0, said
    assert all(found[name]["low"] < value < found[name]["high"] for name, value in TRUTH.items()), said


def test_a_curve_of_steps_does_not_give_a_narrow_interval(calibrate, tmp_path):
    """The truth lay 18 half intervals off, without a word."""
    code, said = calibrate("--set", "friction.static=0.35", "--fit", "friction.kinetic", "--out", tmp_path)
    found = json.loads((tmp_path / "calibration.json").read_text(encoding="utf-8"))["parameters"]["friction.kinetic"]
    assert code == 0 and found["low"] < TRUTH["friction.kinetic"] < found["high"], said
    assert found["high"] / found["low"] < 1.25, said
