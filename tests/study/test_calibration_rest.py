"""scripts/calibrate.py tells where what it leaves of a measurement is no noise: an angle, a tension or a scene that is off."""

import json
import subprocess
import sys

import numpy as np
import pytest
from scipy import signal, stats

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


def test_right_sensors_raise_no_doubt(calibrate, measured, tmp_path):
    code, said, result = calibrate(tmp_path, measured(tmp_path / "m.csv"))
    assert code == 0 and result["warnings"] == [] and not result["doubtful"] and "doubtful" not in said, said


@pytest.mark.parametrize("ahead", [6.0, -3.0, -6.0])
def test_an_angle_that_is_off_is_told(ahead, calibrate, measured, tmp_path):
    """A mass and a damping far from the machine's were told with narrow intervals and no word of warning."""
    _, said, result = calibrate(tmp_path, measured(tmp_path / "m.csv", ahead=ahead))
    way = "large" if ahead > 0.0 else "small"
    assert any("looks as if its angle were some" in text and f"deg too {way}" in text and "--fit-angle-zero" in text for text in result["warnings"]), said
    assert result["doubtful"] and result["curves"]["tension_N"]["chances_of_noise"]["turned"] < 1e-6, said
    assert "doubtful" in said or "no fit" in said, said


def test_a_scene_that_is_off_is_told(calibrate, measured, tmp_path):
    """What is left rings, with little correlation from one row to the next."""
    code, said, result = calibrate(tmp_path, measured(tmp_path / "m.csv"), fits=["tensioner.mass"])
    assert code == 0 and "what is left of tension_N is no noise, it repeats along the angle" in said, said
    assert result["doubtful"] and ", doubtful" in said


@pytest.mark.parametrize(("more", "times"), [(0.8, 1.0), (-0.3, 1.0), (0.0, 1.1)])
def test_a_tension_that_is_off_is_told_with_its_size(more, times, calibrate, measured, tmp_path):
    code, said, result = calibrate(tmp_path, measured(tmp_path / "m.csv", more=more, times=times))
    off = more or 8.0 * (times - 1.0)
    told = next((text for text in result["warnings"] if text.startswith("measured tension_N is ")), None)
    assert told and code == 0, said
    size, way = float(told.split()[3]), told.split()[5]
    assert size == pytest.approx(abs(off), rel=0.15) and way == ("above" if off > 0.0 else "below"), told
    assert "check zero and scale of the sensor" in told and result["doubtful"] and told in said


def test_an_angle_that_is_off_can_be_fitted_for_each_file(calibrate, measured, tmp_path):
    zeros = {measured(tmp_path / "a.csv", ahead=6.0): 6.0, measured(tmp_path / "b.csv", ahead=-12.0, seed=2): -12.0}
    code, said, result = calibrate(tmp_path, *zeros, words=["--fit-angle-zero"])
    assert code == 0 and result["warnings"] == [] and not result["doubtful"], said
    for name, truth in TRUTH.items():
        got = result["parameters"][name]
        assert got["low"] < truth < got["high"] < 1.2 * got["low"], f"{name}\n{said}"
    for path, truth in zeros.items():
        got = result["angle_zeros"][str(path)]
        assert got["low_deg"] < truth < got["high_deg"] < got["low_deg"] + 1.0 and got["determined"], said
        assert f"zero of {path}" in said


def test_an_angle_that_is_off_by_more_than_is_looked_for_is_no_fit(calibrate, measured, tmp_path):
    path = measured(tmp_path / "m.csv", ahead=16.0)
    code, said, result = calibrate(tmp_path, path, words=["--fit-angle-zero"])
    assert code == 1 and not result["fitted"] and result["angle_zeros"][str(path)]["at_end"] == "upper", said
    assert f"zero of {path} ended at the upper end of its range of 15 degrees; shift the angles of that file" in said and "wind with" not in said, said


@pytest.mark.parametrize("ahead", [20.0, -22.0])
def test_a_zero_beyond_reach_that_ends_within_is_doubtful(ahead, calibrate, measured, tmp_path):
    """Curves ring: the fit took one ringing for another, at wrong values with narrow intervals and without a word."""
    path = measured(tmp_path / "m.csv", ahead=ahead)
    _, said, result = calibrate(tmp_path, path, words=["--fit-angle-zero"])
    told = [text for text in result["warnings"] if text.startswith(f"the zero of {path} may lie beyond 15 deg, near ")]
    assert result["doubtful"] and len(told) == 1 and told[0] in said, said
    assert result["angle_zeros"][str(path)]["beyond_deg"] == pytest.approx(ahead, abs=1.5), said


@pytest.mark.parametrize("count", [10, 30, 128, 400])
@pytest.mark.parametrize("correlation", [0.0, 0.4, 0.7])
def test_noise_is_seldom_taken_for_something_else(correlation, count, root):
    """Noise that correlates from row to row is noise too."""
    sys.path.insert(0, str(root / "scripts"))
    import calibration_noise as noise

    random, draws = np.random.default_rng(5), 1500
    wrong = np.zeros(2)
    for _ in range(draws):
        rest = signal.lfilter([1.0], [1.0, -correlation], random.normal(0.0, 1.0, count + 100))[100:]
        wrong += [noise.chance(rest) < noise.LEVEL, noise.chance_of_mean(rest) < noise.LEVEL]
    # Tests of this level do so in more draws once in a thousand times; that of Ljung and Box holds its level for many values only.
    assert wrong[0] <= stats.binom.ppf(0.999, draws, 1.5 * noise.LEVEL), wrong
    assert wrong[1] <= stats.binom.ppf(0.999, draws, noise.LEVEL), wrong
