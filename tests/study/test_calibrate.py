"""scripts/calibrate.py finds the parameters that a measurement was made with, and tells what is wrong with a measurement."""

import json
import os
import signal
import subprocess
import sys
import time

import pytest

SCENE = """
[core]
width_x_mm = 14
height_z_mm = 20
corner_radius_mm = 3
[nozzle]
distance_mm = 50
[tensioner]
line_damping_ratio = 0.2
[spindle]
speed = 200
turns = 1.4
[traverse]
per_turn_mm = 1.5
"""
# The machine, far from where the fit starts.
TRUTH = {
    "tensioner.mass": 1.6e-3,
    "tensioner.line_damping_ratio": 0.26,
    "wire.yield_stress": 1.25e8,
    "wire.flow_stress": 2.6e8,
    "nozzle.exit_friction": 0.14,
}
# Where the scene has 0, the fit is told where to start.
START = {"wire.yield_stress": 1e8, "wire.flow_stress": 2.2e8, "nozzle.exit_friction": 0.1}
NOISE = {"tension_N": 0.05, "height_mm": 0.003}


@pytest.fixture(scope="module")
def measured(scene, command, script):
    run, path = scene.parent / "run", scene.parent / "measured.csv"
    sets = [word for name, value in TRUTH.items() for word in ("--set", f"{name}={value}")]
    subprocess.run([command, "run", scene, *sets, "--no-geometry", "--no-report", "--quiet", "--out", run], check=True)
    noise = [word for column, sigma in NOISE.items() for word in ("--noise", f"{column}={sigma}")]
    code, said = script("scripts/measure.py", run, *noise, "-o", path)
    assert code == 0, said
    return path


@pytest.fixture(scope="module")
def calibrate(scene, command, script):
    def run(measured, *words):
        return script("scripts/calibrate.py", scene, "--measured", measured, "--command", command, *words)

    return run


def test_parameters_of_a_noisy_measurement_are_recovered(calibrate, measured, tmp_path):
    names = [f"{name}={START[name]}" if name in START else name for name in TRUTH]
    code, said = calibrate(measured, *(word for name in names for word in ("--fit", name)), "--out", tmp_path)
    assert code == 0, said
    result = json.loads((tmp_path / "calibration.json").read_text(encoding="utf-8"))
    for name, truth in TRUTH.items():
        got = result["parameters"][name]
        assert abs(got["value"] / truth - 1.0) < 0.05, f"{name}\n{said}"
        # Four standard deviations of a fit with the noise as it is.
        assert got["low"] < got["value"] < got["high"]
        assert abs(got["value"] - truth) < 2.0 * (got["high"] - got["low"]), f"{name}\n{said}"
        assert got["high"] / got["low"] < 1.2, f"{name}\n{said}"
    for column, sigma in NOISE.items():
        assert result["curves"][column]["rms"] == pytest.approx(sigma, rel=0.15)
    assert result["warnings"] == [] and result["fitted"]
    assert (tmp_path / "residuals.png").stat().st_size > 10_000
    assert (tmp_path / "residuals.csv").read_text(encoding="utf-8").startswith("column,angle_rad,measured,fitted\n")


@pytest.fixture(scope="module")
def short(measured):
    """The tension of the first turns."""
    lines = measured.read_text(encoding="utf-8").splitlines(keepends=True)
    path = measured.parent / "short.csv"
    tension = (",".join(line.rstrip().split(",")[:2]) + "\n" for line in lines[:100])
    path.write_text("".join(tension), encoding="utf-8")
    return path


SHORT = ["--set", "spindle.turns=0.65"]


def test_what_does_not_show_is_told(calibrate, short, tmp_path):
    code, said = calibrate(short, *SHORT, "--fit", "friction.slip_speed", "--out", tmp_path)
    assert code == 1, said
    assert "friction.slip_speed hardly shows in what was measured" in said
    assert "what is left of tension_N is no noise" in said
    assert "no fit: what was measured does not determine friction.slip_speed" in said
    assert "wind with" not in said and "inf" not in said.replace("interval", ""), said
    result = json.loads((tmp_path / "calibration.json").read_text(encoding="utf-8"))
    assert not result["fitted"] and not result["parameters"]["friction.slip_speed"]["determined"]


@pytest.mark.parametrize(("words", "expected"), [([], 0), (["--fail-on-doubt"], 1)])
def test_doubtful_values_fail_where_asked(words, expected, calibrate, short, tmp_path):
    """A script could not tell them from others by the exit code."""
    head, *rows = short.read_text(encoding="utf-8").splitlines()
    cells = [row.split(",") for row in rows]
    path = tmp_path / "more.csv"
    path.write_text("\n".join([head, *(f"{turns},{float(pull) + 0.5}" for turns, pull in cells)]) + "\n", encoding="utf-8")
    known = [word for name, value in TRUTH.items() if name != "tensioner.mass" for word in ("--set", f"{name}={value}")]
    code, said = calibrate(path, *SHORT, *known, "--fit", "tensioner.mass", "--out", tmp_path / "out", *words)
    assert code == expected, said
    assert ", doubtful" in said and ("the fitted values are doubtful" in said) == bool(expected), said
    result = json.loads((tmp_path / "out/calibration.json").read_text(encoding="utf-8"))
    assert result["fitted"] and result["doubtful"]


def test_a_setting_far_off_is_no_fit(calibrate, short, tmp_path):
    """A mass of 2 kg was told as fitted, from 0 to inf. It shows in how far the line yields, and no mass near it is right."""
    code, said = calibrate(short, *SHORT, "--set", "tensioner.mass=2", "--fit", "tensioner.mass", "--out", tmp_path)
    # one that is a little better than such a start is none either
    assert code == 1 and "no fit: what the solution leaves is far more" in said and "wind with" not in said, said


def test_a_solution_that_is_its_start_and_leaves_everything_is_no_fit(root, monkeypatch):
    monkeypatch.syspath_prepend(root / "scripts")
    import calibration_curves as curves
    import calibration_fit as fits
    import numpy as np

    angle = np.linspace(0.0, 6.0, 60)
    curve = curves.Curve("measured.csv", "tension_N", "tension", 1.0, angle, 15.0 + np.sin(angle))

    def nothing(computed, gain):
        return fits.explains_nothing(fits.Answer(None, None, None, 58, [computed], 1.0, gain), [curve])

    assert "no better than its start" in nothing(15.0 - np.sin(angle), 1.0)
    # It came closer and is far off.
    assert "far more" in nothing(15.0 - 9.0 * np.sin(angle), 2.0)
    # It came closer, it is close, or what is left is noise.
    assert not nothing(15.0 - np.sin(angle), 2.0)
    assert not nothing(15.0 + 0.9 * np.sin(angle), 1.0)
    assert not nothing(curve.values + np.where(np.arange(60) % 2, 1.0, -1.0), 1.0)


def test_a_setting_of_what_is_fitted_is_its_start(calibrate, short, tmp_path):
    code, said = calibrate(short, *SHORT, "--set", "tensioner.mass_g=1.5", "--fit", "tensioner.mass", "--out", tmp_path)
    assert code == 0, said
    result = json.loads((tmp_path / "calibration.json").read_text(encoding="utf-8"))
    assert result["parameters"]["tensioner.mass"]["start"] == pytest.approx(1.5e-3)


@pytest.mark.skipif(os.name == "nt", reason="terminals of POSIX")
def test_a_terminal_shows_the_progress(root, scene, short, command, tmp_path):
    """It said nothing until its end."""
    reader, writer = os.openpty()
    code = "import sys; sys.path.insert(0, 'scripts'); import progress; progress.QUIET = 0.0; import calibrate; calibrate.main()"
    line = [sys.executable, "-c", code, scene, "--measured", short, *SHORT, "--fit", "tensioner.mass", "--command", command, "--out", tmp_path]
    said = subprocess.run(line, stdout=subprocess.PIPE, stderr=writer, text=True, check=True, cwd=root).stdout
    shown = os.read(reader, 1 << 12).decode()
    os.close(reader)
    os.close(writer)
    assert "wind with" in said and "\r" not in said, said
    assert "1 runs, 0 s" in shown and "20 runs, " in shown, shown


def test_results_are_not_overwritten_without_a_word(calibrate, short, tmp_path):
    for name, holds in [("summary.json", "another run"), ("sweep.csv", "another sweep"), ("calibration.json", "another calibration")]:
        out = tmp_path / name
        out.mkdir()
        (out / name).write_text("{}\n", encoding="utf-8")
        code, said = calibrate(short, *SHORT, "--fit", "tensioner.mass", "--out", out)
        assert code == 2 and f"{out} holds {holds}; add --force to overwrite it" in said and len(said.splitlines()) == 1, said
        assert (out / name).read_text(encoding="utf-8") == "{}\n"
    code, said = calibrate(short, *SHORT, "--fit", "tensioner.mass=1.5e-3", "--out", out, "--force")
    assert code == 0 and json.loads((out / "calibration.json").read_text(encoding="utf-8"))["fitted"], said


def test_a_full_disk_is_told_in_a_line(calibrate, short, tmp_path):
    (tmp_path / "residuals.partial.csv").symlink_to("/dev/full")
    code, said = calibrate(short, *SHORT, "--fit", "tensioner.mass=1.5e-3", "--out", tmp_path)
    assert code == 3 and said.endswith(f"calibrate.py: cannot write {tmp_path}/residuals.csv: No space left on device\n"), said
    assert "wind with" in said and "Traceback" not in said
    assert {path.name for path in tmp_path.iterdir()} == {"calibration.json"}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_fit_that_is_stopped_keeps_the_best_so_far(number, scene, command, measured, root, tmp_path):
    out, runs = tmp_path / "out", tmp_path / "runs"
    runs.mkdir()
    fits = [word for name in TRUTH for word in ("--fit", f"{name}={START[name]}" if name in START else name)]
    line = [sys.executable, root / "scripts/calibrate.py", scene, "--measured", measured, *fits, "--threads", "1", "--command", command, "--out", out]
    child = subprocess.Popen(line, stderr=subprocess.PIPE, text=True, env=os.environ | {"TMPDIR": str(runs)})
    while sum(1 for _ in runs.glob("*/*")) < 8:
        assert child.poll() is None
        time.sleep(0.05)
    child.send_signal(number)
    said = child.communicate(timeout=30)[1]
    assert child.returncode == 130 and len(said.splitlines()) == 1, said
    assert f"the best values so far are in {out}/calibration.json; go on from them with: " in said and said.endswith(" --force\n"), said
    result = json.loads((out / "calibration.json").read_text(encoding="utf-8"))
    assert result["stopped"] and not result["fitted"]
    for name in TRUTH:
        assert f"--fit {name}={result['parameters'][name]['value']:.6g}" in said
    assert (out / "residuals.csv").stat().st_size > 1000 and (out / "residuals.png").stat().st_size > 10_000
    assert not list(runs.iterdir()), "temporary folders are left"


def test_a_fit_that_ends_at_an_end_of_its_range_is_none(calibrate, measured, tmp_path):
    """The least mass that was allowed was told as a result, where a better one lies beyond."""
    known = [word for name, value in TRUTH.items() if name != "tensioner.mass" for word in ("--set", f"{name}={value}")]
    lines = [line.split(",")[:2] for line in measured.read_text(encoding="utf-8").splitlines()]
    tension = tmp_path / "tension.csv"
    tension.write_text("".join(f"{turns},{pull}\n" for turns, pull in lines), encoding="utf-8")
    code, said = calibrate(tension, *known, "--fit", "tensioner.mass=0.02", "--out", tmp_path)
    assert code == 1, said
    result = json.loads((tmp_path / "calibration.json").read_text(encoding="utf-8"))
    assert not result["fitted"] and result["parameters"]["tensioner.mass"]["at_end"] == "lower"
    assert "no fit: tensioner.mass ended at the lower end of its range" in said, said
    assert "wind with" not in said


@pytest.mark.parametrize(
    ("text", "words", "complaint"),
    [
        ("turns,tension_lb\n0.3,1\n0.4,1\n", [], "has the unit lb; tension takes N, mN, cN"),
        ("turns,tension\n0.3,1\n0.4,1\n", [], "column tension is none of tension_N|mN|cN, coil_width_m|mm|"),
        ("time,tension_N\n0.3,1\n0.4,1\n", [], "has 0 columns of the angle; give one, named angle_deg, angle_rad, turns"),
        ("turns,tension_N\n0.3,15\n0.4\n", [], ":3 has 1 cells, the header has 2"),
        ("turns,tension_N\n0.3,15\n0.4,much\n", [], ":3: tension_N is 'much', which is not a number"),
        ("turns,tension_N\n# spun up\n0.3,15\n\n0.4,much\n", [], ":5: tension_N is 'much', which is not a number"),
        ("turns,tension_N\n0.3,15\n0.4,nan\n", [], ":3: tension_N is 'nan', which is not a finite number; leave the cell empty"),
        ("turns,tension_N\n0.3,15\n0.4,1e999\n", [], ":3: tension_N is '1e999', which is not a finite number; leave the cell empty"),
        ("turns,tension_N\n0.3,15\n,15\n", [], ":3: turns is empty; give each row its angle"),
        ("turns;tension_N\n0,3;15\n0,4;15\n", [], "has semicolons between columns; save it with commas between columns and points in numbers"),
        ("turns,tension_N\n0.4,15\n0.3,15\n", [], "turns has to rise from row to row"),
        ("turns,tension_N\n", [], "holds no measurement"),
        ("turns,tension_N\n0.3,15\n", [], "1 measured values are too few for 1 parameters"),
        ("turns,tension_N\n0.3,15\n1.3,15\n", [], "2 measured values are too few for 1 parameters; measure at 5 angles or more"),
        ("angle_deg,tension_N\n0.1,15\n8.7,15\n", [], "is measured over 0.0239 of the 1.4 turns of the run; is the angle in the unit of its column"),
        ("turns,tension_N\n0.3,15000\n0.4,15000\n", [], "tension_N is 1.01e+03 times what the scene gives (14.8)"),
        ("turns,tension_N\n0.3,15\n2.5,15\n", [], "from 0.30 to 2.50 turns, the run goes from 0.00 to 1.40; wind more with --set spindle.turns=N"),
        ("turns,height_mm\n0.3,0.1\n1.38,0.1\n2,0.1\n", [], "settled wire of the run goes from"),
        ("turns,tension_N\n0.3,15\n0.4,15\n0.5,15\n", ["--fit", "tensioner.mas"], "--fit tensioner.mas: there is no such parameter"),
        ("turns,tension_N\n0.3,15\n0.4,15\n0.5,15\n", ["--fit", "winding.layers"], "--fit winding.layers: it is a whole number"),
        ("turns,tension_N\n0.3,15\n0.4,15\n0.5,15\n", ["--fit", "tensioner.mass=2"], "--fit tensioner.mass is given twice; leave one out"),
        (
            "turns,tension_N\n0.3,15\n0.4,15\n0.5,15\n", ["--fit", "tensioner.radius=0.05", "--set", "tensioner.radius_mm=50"],
            "--fit tensioner.radius=0.05 and --set tensioner.radius_mm=50 both say where tensioner.radius starts",
        ),
        ("turns,tension_N\n0.3,15\n0.4,15\n0.5,15\n", ["--fit", "nozzle.exit_friction"], "it starts from 0; give a start above zero"),
        ("turns,tension_N\n0.3,15\n0.4,15\n", ["--set", "wire.diametr=1"], "wire.diametr"),
    ],
)
def test_a_wrong_measurement_is_told_in_a_line(text, words, complaint, calibrate, tmp_path):
    path = tmp_path / "measured.csv"
    path.write_text(text, encoding="utf-8")
    code, said = calibrate(path, "--fit", "tensioner.mass", *words, "--out", tmp_path / "out")
    assert code == 2
    assert complaint in said, said
    assert len(said.splitlines()) == 1, said
    assert not (tmp_path / "out").exists()


def test_tables_of_spreadsheets_are_read_or_told(root, monkeypatch, tmp_path):
    """A comma at the end of lines gave a column without a name, and UTF-16 an error of the decoder."""
    monkeypatch.syspath_prepend(root / "scripts")
    import calibration_curves as curves
    from failure import Mistake

    path = tmp_path / "measured.csv"
    path.write_text("turns,tension_N,\n0.3,15,\n0.4,16,\n", encoding="utf-8")
    (curve,) = curves.read_curves(path)
    assert list(curve.values) == [15.0, 16.0]
    path.write_text("turns,tension_N\n0.3,15\n", encoding="utf-16")
    with pytest.raises(Mistake, match="save it as CSV in UTF-8"):
        curves.read_curves(path)


def in_folder(call, folder):
    code = f"import sys; sys.path.insert(0, 'scripts'); import folder, pathlib; folder.{call}"
    return subprocess.run([sys.executable, "-c", code, folder], capture_output=True, text=True, check=False)


@pytest.mark.parametrize("name", ["ensemble.bin", "ensemble.json"])
def test_the_folder_of_an_ensemble_is_refused(tmp_path, name):
    (tmp_path / name).write_text("{}")
    said = in_folder("refuse_occupied(pathlib.Path(sys.argv[1]), False)", tmp_path).stderr
    assert "holds an ensemble; add --force" in said


def test_no_member_of_an_ensemble_stays_behind(tmp_path):
    (tmp_path / "ensemble.json").write_text('{"members": 2, "verdicts": {}}')
    for run, name in [("1", "summary.json"), ("2", "mine.txt"), ("2", "history.csv"), ("3", "summary.json")]:
        (tmp_path / run).mkdir(exist_ok=True)
        (tmp_path / run / name).write_text("{}")
    assert in_folder("clear(pathlib.Path(sys.argv[1]))", tmp_path).returncode == 0
    left = sorted(str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*"))
    assert left == ["2", "2/mine.txt", "3", "3/summary.json"]
