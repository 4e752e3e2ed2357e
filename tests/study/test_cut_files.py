"""Scripts that read a run refuse a file that is cut, as `coilwind report` does, and a folder without a run: in a line that says what to do."""

import shutil
import subprocess

import pytest

SCENE = "[spindle]\nspeed = 100\nturns = 1.2\n"
# What reads which file.
READERS = [
    ("plot_tension", "history.csv", []),
    ("section_plot", "stations.csv", []),
    ("measure", "history.csv", ["--noise", "tension_N=0"]),
    ("measure", "stations.csv", ["--noise", "height_mm=0"]),
    ("verdicts", "history.csv", None),
]


@pytest.fixture(scope="module")
def wound(scene, command, tmp_path_factory):
    folder = tmp_path_factory.mktemp("wound") / "run"
    subprocess.run([command, "run", scene, "--out", folder, "--quiet", "--no-report", "--no-geometry"], check=True)
    return folder


@pytest.fixture
def run(wound, tmp_path):
    """A copy of a run, to be cut."""
    return shutil.copytree(wound, tmp_path / "run")


CUTS = {
    "within the last cell": lambda data: data[:-3],
    "a last line of few cells": lambda data: data + b"1,2\n",
    "within the header": lambda data: data[:20],
    "half": lambda data: data[: len(data) // 2],
}


def cut(path, what):
    path.write_bytes(CUTS[what](path.read_bytes()))


@pytest.mark.parametrize("what", CUTS)
@pytest.mark.parametrize(("name", "file", "words"), READERS, ids=[f"{name} {file}" for name, file, _ in READERS])
def test_a_file_that_is_cut_is_refused(name, file, words, what, run, script, tmp_path):
    """It was taken without a word, with a number cut short or a cell that is empty."""
    cut(run / file, what)
    # The table of verdicts goes into the folder that holds the runs.
    ways = [run.parent] if words is None else [run, *words, "-o", tmp_path / "out"]
    code, said = script(f"scripts/{name}.py", *ways)
    assert code == 2 and len(said.splitlines()) == 1, said
    assert f"{run}: {file} is not whole (" in said and f"; begin again with: coilwind run {run}/scene.toml --out {run}" in said, said
    assert not (tmp_path / "out").exists()


def test_the_history_of_a_run_that_goes_on_is_taken_up_to_its_last_row(run, script, tmp_path):
    cut(run / "history.csv", "within the last cell")
    (run / "summary.json").unlink()
    code, said = script("scripts/plot_tension.py", run, "-o", tmp_path / "out.png")
    assert code == 0 and (tmp_path / "out.png").exists(), said
    assert f"warning: {run / 'history.csv'}: line " in said and "is cut and left out, as the run has not ended" in said, said


@pytest.mark.parametrize("text", ['{"status": "do', "[]x", "3", '"abc"'])
@pytest.mark.parametrize("name", ["verdicts", "plot_tension", "section_plot", "report"])
def test_a_summary_that_is_cut_is_refused(name, text, run, script, tmp_path):
    """It ended in a traceback."""
    (run / "summary.json").write_text(text, encoding="utf-8")
    ways = [run.parent] if name in ("verdicts", "report") else [run, "-o", tmp_path / "out"]
    code, said = script(f"scripts/{name}.py", *ways)
    assert code == 2 and len(said.splitlines()) == 1, said
    assert f"{run}: summary.json is not whole (" in said and f"begin again with: coilwind run {run}/scene.toml --out {run}" in said, said


@pytest.mark.parametrize("name", ["plot_tension", "section_plot"])
def test_a_folder_without_a_run_is_named(name, script, tmp_path):
    """A folder that was not there was taken for a file, and the folder round it was looked into."""
    code, said = script(f"scripts/{name}.py", tmp_path, "-o", tmp_path / "out")
    assert code == 2 and f"{tmp_path} holds no results of a run; wind one with: coilwind run SCENE --out {tmp_path}\n" in said, said
    code, said = script(f"scripts/{name}.py", tmp_path / "none", "-o", tmp_path / "out")
    assert code == 2 and f"{tmp_path}/none is no folder; name that of a run" in said and len(said.splitlines()) == 1, said


def test_a_history_by_itself_is_drawn(run, script, tmp_path):
    lone = tmp_path / "lone/tension.csv"
    lone.parent.mkdir()
    shutil.copy(run / "history.csv", lone)
    code, said = script("scripts/plot_tension.py", lone, "-o", tmp_path / "out.png")
    assert code == 0 and (tmp_path / "out.png").exists(), said
