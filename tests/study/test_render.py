"""scripts/render.py draws the wire that a run has, and frames are read by VTK's own reader."""

import os
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest

RENDER = os.environ.get("COILWIND_RENDER_PYTHON")
pytestmark = pytest.mark.skipif(not RENDER, reason="COILWIND_RENDER_PYTHON does not name the Python of scripts/venv.sh render")


@pytest.fixture(scope="module")
def run(tmp_path_factory, command):
    out = tmp_path_factory.mktemp("film") / "run"
    words = ["run", "fig8", "--set", "spindle.speed=100", "--set", "spindle.turns=1", "--frames", "3", "--no-report", "--quiet"]
    subprocess.run([command, *words, "--out", out], check=True)
    return out


def render_python(text):
    return subprocess.run([RENDER, "-c", text], capture_output=True, text=True, check=True).stdout


def test_the_last_frame_is_the_coil(run):
    said = render_python(f"""
import numpy as np, pyvista as pv
frames = pv.get_reader(r"{run / 'frames.pvd'}")
sizes = []
for time in frames.time_values:
    frames.set_active_time_value(time)
    wire = frames.read()[0]
    sizes.append(wire.n_points)
coil = pv.read(r"{run / 'coil.vtp'}")
assert len(sizes) == 3 and sizes == sorted(sizes), sizes
assert wire.n_lines == 1 and 16 * wire.n_points == coil.n_points
middle = coil.points.reshape(-1, 16, 3).mean(axis=1)
assert np.abs(middle - wire.points).max() < 1e-8
for name in ["tension", "plastic_strain", "layer", "turn", "defect", "frozen", "arc"]:
    np.testing.assert_allclose(wire[name], coil[name][::16], rtol=1e-6, atol=1e-7, err_msg=name)
assert wire.field_data["TimeValue"][0] == frames.time_values[-1]
assert abs(wire.field_data["WireRadius"][0] - 0.35e-3) < 1e-12
print("same")
""")
    assert said == "same\n"


def test_a_picture_shows_wire_and_core(run, script, tmp_path):
    picture = tmp_path / "x.png"
    code, said = script("scripts/render.py", run, "-o", picture, "--colour", "none", "--size", "320x240", python=RENDER)
    assert code == 0, said
    copper, grey, paper = map(float, render_python(f"""
import numpy as np, pyvista as pv
pixels = pv.read(r"{picture}").point_data.active_scalars[:, :3].astype(int)
red, _, blue = pixels.T
print(np.mean(red > blue + 40), np.mean((abs(red - blue) < 40) & (red < 235)), np.mean(pixels.min(axis=1) > 250))
""").split())
    assert copper > 0.01 and grey > 0.05 and paper > 0.2, (copper, grey, paper)


def test_labels_of_counted_colours_have_even_whole_steps(root):
    """Ten turns had the labels 1 3 5 6 8 10: even steps that were rounded."""
    said = render_python(f"""
import sys; sys.path.insert(0, r"{root / 'scripts'}")
import numpy as np, render
from types import SimpleNamespace
for turns in [1, 2, 6, 7, 10, 12, 27, 360]:
    end = {{"turn": np.arange(1, turns + 1)}}
    coil = SimpleNamespace(args=SimpleNamespace(colour="turn"), end=end, rest=np.full(turns, True), size=(640, 480), bar_share=lambda: 0.2)
    colours = render.Coil.colours(coil)
    low, high = colours["clim"]
    labels = np.linspace(low, high, colours["scalar_bar_args"]["n_labels"])
    assert low == 1 and labels.size <= 6, labels
    assert np.all(labels == np.round(labels)), f"{{turns}} turns: {{labels}}"
    assert max(turns, 2) <= high < max(turns, 2) + (labels[1] - labels[0]), labels
print("even")
""")
    assert said == "even\n"


def test_a_wire_is_one_smooth_tube(root):
    """Each edge was a tube of its own, and every node a dark seam."""
    said = render_python(f"""
import sys; sys.path.insert(0, r"{root / 'scripts'}")
import numpy as np, pyvista as pv, render
from types import SimpleNamespace
turn = np.linspace(0.0, 6.0, 40)
wire = pv.PolyData(np.column_stack([np.cos(turn), np.sin(turn), 0.1 * turn]))
wire["tension"] = turn
coil = SimpleNamespace(args=SimpleNamespace(colour="tension"), radius=0.05)
tube = render.Coil.tube(coil, wire)
# A ring at each node, and the caps.
assert tube.n_points == 42 * render.SIDES, tube.n_points
rings = tube["shown"][: 40 * render.SIDES].reshape(40, -1)
np.testing.assert_allclose(rings, np.tile(turn[:, None], render.SIDES), atol=1e-6)
print("smooth")
""")
    assert said == "smooth\n"


def test_a_film_has_the_frames(run, script, tmp_path):
    film = tmp_path / "x.gif"
    code, said = script("scripts/render.py", run, "--film", film, "--size", "160x120", python=RENDER)
    assert code == 0, said
    assert render_python(f"import imageio; print(len(imageio.mimread(r'{film}')))") == "3\n"


def test_a_film_has_the_size_that_is_asked_for(run, script, tmp_path):
    film = tmp_path / "x.mp4"
    code, said = script("scripts/render.py", run, "--film", film, "--size", "162x122", python=RENDER)
    assert code == 0 and "WARNING" not in said, said
    assert render_python(f"import imageio; f = imageio.get_reader(r'{film}'); print(f.get_meta_data()['size'], f.count_frames())") == "(162, 122) 3\n"


@pytest.mark.parametrize("output", [["-o", "x.png"], ["--film", "x.gif"], ["--film", "x.mp4"]])
def test_a_full_disk_leaves_no_half_of_a_picture_or_film(output, run, root, tmp_path):
    kept = tmp_path / output[1]
    kept.write_bytes(b"before")
    line = shlex.join([str(RENDER), "scripts/render.py", str(run), output[0], str(kept), "--size", "640x480"])
    done = subprocess.run(["bash", "-c", f"ulimit -f 8; {line}"], cwd=root, capture_output=True, text=True)
    assert done.returncode == 3, done
    assert f"cannot write {kept}: " in done.stderr and "Traceback" not in done.stderr, done.stderr
    assert kept.read_bytes() == b"before" and os.listdir(tmp_path) == [output[1]]


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["{folder}/none"], "is no folder"),
        (["{folder}"], "{folder} holds no results of a run; wind one with: coilwind run SCENE --out {folder}"),
        (["{folder}", "--film", "film.mp4"], "{folder} holds no results of a run; wind one with"),
        (["{folder}", "--film", "film.avi"], "the ending has to be .mp4 or .gif"),
        (["{folder}", "--film", "film.mp4", "-o", "x.png"], "-o x.png names a picture, --film film.mp4 a film; leave one out"),
        (["{folder}", "--size", "big"], "--size big is not WIDTHxHEIGHT"),
    ],
)
def test_what_cannot_be_drawn_is_told_in_a_line(words, complaint, script, tmp_path):
    code, said = script("scripts/render.py", *(word.format(folder=tmp_path) for word in words), python=RENDER)
    assert code == 2
    assert complaint.format(folder=tmp_path) in said and "Traceback" not in said


@pytest.mark.parametrize(
    ("name", "complaint"), [("ensemble.json", "holds an ensemble; name a member, such as {folder}/1"), ("sweep.json", "holds a sweep; name the folder of a run")]
)
def test_a_folder_of_many_runs_is_told_from_one_without(name, complaint, script, tmp_path):
    (tmp_path / name).write_text('{"members": 2}', encoding="utf-8")
    code, said = script("scripts/render.py", tmp_path, python=RENDER)
    assert code == 2 and complaint.format(folder=tmp_path) in said, said


@pytest.mark.parametrize(("words", "complaint"), [([], "coil.vtp is missing; wind the run without --no-geometry"), (["--film", "x.gif"], "wind the run with --frames N")])
def test_a_run_without_geometry_is_told_from_a_folder_without_a_run(words, complaint, run, script, tmp_path):
    for name in ("summary.json", "scene.toml", "history.csv"):
        shutil.copy(run / name, tmp_path)
    code, said = script("scripts/render.py", tmp_path, *words, python=RENDER)
    assert code == 2 and complaint in said and len(said.splitlines()) == 1, said


@pytest.fixture
def spoilt(run, tmp_path):
    """A copy of the run, one file of which ends too early."""

    def cut(name, size):
        folder = tmp_path / "run"
        shutil.copytree(run, folder)
        os.truncate(folder / name, size)
        return folder

    return cut


@pytest.mark.parametrize(
    ("name", "size", "words", "complaint"),
    [
        ("coil.vtp", 20_000, [], "coil.vtp is not whole (it ends too early); begin again with: coilwind run {folder}/scene.toml --out {folder} --frames 3 --force"),
        ("core.vtp", 0, [], "core.vtp is not whole (it ends too early); begin again with"),
        (
            "frames/frame_0002.vtp", 2000, ["--film", "{folder}/film.gif"],
            "frame_0002.vtp is not whole (it ends too early); begin again with: coilwind run {folder}/scene.toml --out {folder} --frames 3 --force",
        ),
        ("frames.pvd", 200, ["--film", "{folder}/film.gif"], "frames.pvd is not whole"),
    ],
)
def test_a_file_that_is_cut_short_is_told_in_a_line(name, size, words, complaint, spoilt, script):
    folder = spoilt(name, size)
    code, said = script("scripts/render.py", folder, *(word.format(folder=folder) for word in words), python=RENDER)
    assert code == 2 and complaint.format(folder=folder) in said and len(said.splitlines()) == 1, said
    assert not (folder / "film.gif").exists()


def test_the_command_that_begins_again_has_the_options_of_the_run(script, tmp_path):
    folder = tmp_path / "two words"
    folder.mkdir()
    options = "--inputs '/data/in puts.csv' --step 0.0005 --frames 7"
    (folder / "scene.toml").write_text(f"# wound with: {options}\npreset = 'fig8'\n", encoding="utf-8")
    code, said = script("scripts/render.py", folder, python=RENDER)
    assert code == 2 and said.endswith(f"begin again with: coilwind run '{folder}/scene.toml' --out '{folder}' {options} --force\n"), said


def test_a_frame_with_damage_inside_is_told_in_a_line(spoilt, script):
    folder = spoilt("frames/frame_0002.vtp", 1 << 20)
    frame = folder / "frames/frame_0002.vtp"
    text = frame.read_bytes().rstrip(b"\0")
    middle = text.index(b"<Points>") + 200
    frame.write_bytes(text[:middle] + b"!!!!" + text[middle + 4 :])
    code, said = script("scripts/render.py", folder, "--film", folder / "film.gif", "--size", "160x120", python=RENDER)
    assert code == 2 and "frame_0002.vtp is not whole" in said and len(said.splitlines()) == 1, said
    assert not (folder / "film.gif").exists()


@pytest.mark.parametrize(("checkpoint", "complaint"), [(True, "go on with: coilwind run --resume {folder}"), (False, "begin again with: coilwind run {folder}/scene.toml")])
def test_a_run_that_was_killed_is_told_to_go_on(checkpoint, complaint, script, tmp_path):
    if checkpoint:
        (tmp_path / "checkpoint.bin").write_bytes(b"coilwck2")
    (tmp_path / "scene.toml").write_text("preset = 'fig8'\n", encoding="utf-8")
    code, said = script("scripts/render.py", tmp_path, python=RENDER)
    assert code == 2 and len(said.splitlines()) == 1, said
    assert f"the run was stopped before it wrote its results; {complaint.format(folder=tmp_path)}" in said


def test_a_run_that_goes_on_is_told_to_be_under_way(script, tmp_path):
    fcntl = pytest.importorskip("fcntl")
    (tmp_path / "scene.toml").write_text("preset = 'fig8'\n", encoding="utf-8")
    with open(tmp_path / "history.csv", "w", encoding="utf-8") as history:
        fcntl.flock(history, fcntl.LOCK_EX)
        code, said = script("scripts/render.py", tmp_path, python=RENDER)
    assert code == 2 and len(said.splitlines()) == 1 and "the run is under way" in said, said


@pytest.mark.parametrize("rate", ["0", "-3", "nan", "1e4"])
def test_a_film_without_a_rate_is_refused(rate, run, script, tmp_path):
    code, said = script("scripts/render.py", run, "--film", tmp_path / "x.gif", f"--rate={rate}", python=RENDER)
    assert code == 2 and "from 0.5 to 120" in said and len(said.splitlines()) == 1, said
    assert not (tmp_path / "x.gif").exists()


@pytest.mark.parametrize(("size", "view"), [("1280x960", "corner"), ("400x800", "corner"), ("640x480", "axis"), ("320x240", "z")])
def test_the_whole_core_and_all_windings_stand_clear_of_the_colours(size, view, run, root):
    said = render_python(f"""
import sys; sys.path.insert(0, r"{root / 'scripts'}")
import pyvista as pv, render
from pathlib import Path
from types import SimpleNamespace
args = SimpleNamespace(run=Path(r"{run}"), size="{size}", colour="tension", no_core=False, flanges=False, view="{view}")
coil = render.Coil(args)
plotter = coil.stage()
core = pv.read(args.run / "core.vtp")
assert plotter.renderer.bounds[2:4] == core.bounds[2:4], "a core without flanges is not cut"
plotter.render()
width, height = coil.size
for point in coil.end.points[coil.rest]:
    plotter.renderer.SetWorldPoint(*point, 1.0)
    plotter.renderer.WorldToDisplay()
    x, y, _ = plotter.renderer.GetDisplayPoint()
    assert 0 <= x <= (1.0 - coil.bar_share()) * width and 0 <= y <= height, (x, y)
print("clear")
""")
    assert said == "clear\n"
