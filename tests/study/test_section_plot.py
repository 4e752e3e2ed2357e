"""scripts/section_plot.py takes wire, core and limits from the folder of a run."""

import subprocess
import sys

import pytest


def wind(tmp_path, command, name, *settings):
    """The folder of a run of one turn."""
    scene = tmp_path / f"{name}.toml"
    scene.write_text("[spindle]\nspeed = 100\nturns = 1\n", encoding="utf-8")
    folder = tmp_path / name
    words = [word for setting in settings for word in ("--set", setting)]
    subprocess.run([command, "run", scene, "--out", folder, "--quiet", "--no-report", "--no-geometry", *words], check=True)
    return folder


def sections(root, *folders):
    """Label, diameter, limit, first and second place of each run."""
    code = (
        f"import sys; sys.path.insert(0, r'{root / 'scripts'}')\n"
        "from section_plot import sections_of\n"
        "for s in sections_of(sys.argv[1:]): print(s.label, round(s.diameter, 6), s.gap_limit, s.places[1][0], round(s.places[1][1], 4), sep='; ')\n"
    )
    done = subprocess.run([sys.executable, "-c", code, *map(str, folders)], capture_output=True, text=True, check=True)
    return done.stdout.splitlines()


@pytest.fixture(scope="module")
def runs(root, tmp_path_factory, command):
    out = tmp_path_factory.mktemp("sections")
    box = wind(out, command, "box", "wire.enamelled_diameter=0.8e-3", "core.width_x=0.02", "core.height_z=0.02", "defects.gap=0.2")
    drum = wind(out, command, "7", "core.shape=cylinder", "wire.diameter=0.4e-3")
    return box, drum


def test_wire_core_and_limits_are_those_of_the_scene(root, runs):
    assert sections(root, *runs) == [
        # The number of a member of an ensemble is no speed.
        "100 rad/s, 7; 0.4; 0.15; 45° from +x; 0.7854",
        "100 rad/s, box; 0.8; 0.2; corner +x +z; 0.7854",
    ]


def test_unlike_coils_come_into_one_picture(script, runs, tmp_path):
    picture = tmp_path / "x.png"
    code, said = script("scripts/section_plot.py", *runs, "-o", picture)
    assert code == 0 and picture.stat().st_size > 10_000, said


def test_a_folder_without_a_scene_is_refused(script, runs, tmp_path):
    (tmp_path / "stations.csv").write_bytes((runs[0] / "stations.csv").read_bytes())
    code, said = script("scripts/section_plot.py", tmp_path, "-o", tmp_path / "x.png")
    assert code == 2 and "scene.toml is missing" in said, said
