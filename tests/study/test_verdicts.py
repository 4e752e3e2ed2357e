"""scripts/verdicts.py tells each run by its folder, in diameters of its own wire, with the verdict on the coil and on a turn."""

import csv
import subprocess

import pytest


@pytest.fixture(scope="module")
def runs(tmp_path_factory, command):
    """Runs of one speed with wires of two diameters, in the folder that holds them."""
    out = tmp_path_factory.mktemp("verdicts")
    scene = out / "scene.toml.txt"
    scene.write_text("[spindle]\nspeed = 100\nturns = 2.3\n", encoding="utf-8")
    for name, words in [("thin", ["wire.diameter_mm=0.4"]), ("enamelled", ["wire.diameter_mm=0.4", "wire.enamelled_diameter_mm=0.7"])]:
        sets = [word for text in words for word in ("--set", text)]
        subprocess.run([command, "run", scene, *sets, "--out", out / name, "--quiet", "--no-report", "--no-geometry"], check=True)
    return out


def test_lengths_are_in_diameters_of_the_wire_of_each_run(runs, script):
    """All runs were divided by 0.7 mm."""
    code, said = script("scripts/verdicts.py", runs)
    assert code == 0, said
    with open(runs / "verdicts.csv", newline="", encoding="utf-8") as file:
        rows = {row["folder"]: row for row in csv.DictReader(file)}
    assert {name: float(row["diameter_m"]) for name, row in rows.items()} == {"thin": 0.4e-3, "enamelled": 0.7e-3}
    lines = (runs / "verdicts.md").read_text(encoding="utf-8").splitlines()
    head, *shown = [[cell.strip() for cell in line.strip("|").split("|")] for line in (lines[0], *lines[2:4])]
    for cells in shown:
        told, row = dict(zip(head, cells)), rows[cells[0]]
        assert float(row["gap_mean_m"]) > 0.0
        assert float(told["gap mean/d"]) == pytest.approx(float(row["gap_mean_m"]) / float(row["diameter_m"]), abs=6e-4), told


def test_the_verdict_on_the_coil_stands_beside_that_of_the_turn(runs, script):
    code, said = script("scripts/verdicts.py", runs, "--turn", "2")
    assert code == 0 and "coil: verdict" in said and "turn 2: verdict" in said, said
    assert said.splitlines()[-1] == f"wrote {runs / 'verdicts.csv'}, {runs / 'verdicts.md'}", said


def test_a_folder_without_runs_is_told_in_a_line(script, tmp_path):
    code, said = script("scripts/verdicts.py", tmp_path)
    assert code == 2 and "no summary.json below" in said and len(said.splitlines()) == 1, said
