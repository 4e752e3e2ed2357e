"""scripts/measure.py says in a line what is wrong with what it is given."""

import numpy as np
import pytest


@pytest.fixture
def run(tmp_path):
    """A folder with as much of a run as is measured."""
    folder = tmp_path / "run"
    folder.mkdir()
    rows = [f"{angle:.3f},15\n" for angle in np.arange(0.0, 9.0, 0.1)]
    (folder / "history.csv").write_text("spindle_angle,wire_tension\n" + "".join(rows), encoding="utf-8")
    (folder / "stations.csv").write_text("angle,height\n", encoding="utf-8")
    return folder


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["{run}/none", "--noise", "tension_N=0.1"], "none/history.csv is missing; name the folder of a run"),
        (["{run}", "--noise", "tension_N=abc"], "--noise tension_N=abc: expected COLUMN=SIGMA"),
        (["{run}", "--noise", "tension_N"], "--noise tension_N: expected COLUMN=SIGMA"),
        (["{run}", "--noise", "tension_N=-1"], "--noise tension_N=-1: the standard deviation has to be at least 0"),
        (["{run}", "--noise", "tension_lb=1"], "--noise tension_lb=1: the column is none of"),
        (["{run}", "--noise", "tension_N=0", "--from-turn", "3"], "--from-turn 3: tension_N of {run} goes to turn 1.42; begin before that"),
        (["{run}", "--noise", "height_mm=0"], "height_mm of {run} has no rows"),
        (["{run}", "--noise", "tension_N=0", "--seed", "-1"], "--seed -1 has to be at least 0"),
    ],
)
def test_what_cannot_be_measured_is_told_in_a_line(words, complaint, run, script, tmp_path):
    """They ended in tracebacks, or in an empty file."""
    out = tmp_path / "measured.csv"
    code, said = script("scripts/measure.py", *(word.format(run=run) for word in words), "-o", out)
    assert code == 2 and complaint.format(run=run) in said and len(said.splitlines()) == 1, said
    assert not out.exists()


def test_a_run_without_noise_is_measured_as_it_is(run, script, tmp_path):
    code, said = script("scripts/measure.py", run, "--noise", "tension_N=0", "-o", tmp_path / "measured.csv")
    assert code == 0, said
    assert (tmp_path / "measured.csv").read_text(encoding="utf-8").splitlines()[1] == "0.300000,15"
