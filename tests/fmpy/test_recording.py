"""Files that the FMU leaves in `output.directory`, however the run ends."""

import csv
import json

import pytest
from conftest import OK, WARNING

STEP = 2e-5
RESULTS = {
    "scene.toml", "history.csv", "summary.json", "turns.csv", "stations.csv",
    "defects.csv", "coil.vtp", "core.vtp", "coil.png",
}


def steps(slave, count, start_time=0.0):
    for k in range(count):
        slave.fmu.doStep(start_time + k * STEP, STEP)


def status(directory):
    return json.loads((directory / "summary.json").read_text())["status"]


def times(directory):
    with open(directory / "history.csv", newline="", encoding="utf-8") as file:
        return [float(row["time"]) for row in csv.DictReader(file)]


def test_nothing_is_written_unasked(slave, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    slave.start()
    steps(slave, 2)
    slave.fmu.terminate()
    assert list(tmp_path.iterdir()) == []


def told(slave):
    """Messages of a run that has ended, without the one at the end on what the solver did, and that on a core that nobody turns."""
    summary = [entry for entry in slave.log if entry[2] == "logSolver"]
    # (fmpy hands messages of all instances to the logger that came last)
    assert len(summary) == len({entry[0] for entry in summary}), summary
    assert all("the solver took" in entry[3] for entry in summary), summary
    stands = [entry for entry in slave.log if entry[3].startswith("output.directory is set")]
    assert all((level, category) == (OK, "logEvents") for _, level, category, _ in stands), stands
    assert len(stands) == len({entry[0] for entry in stands}), stands
    return [entry for entry in slave.log if entry not in summary + stands]


def test_a_terminated_run_leaves_its_files(slave, tmp_path):
    directory = tmp_path / "made" / "on demand ü"
    slave.start(start_time=1.0, output__directory=str(directory))
    steps(slave, 3, start_time=1.0)
    slave.fmu.terminate()
    assert {path.name for path in directory.iterdir()} == RESULTS
    assert times(directory) == pytest.approx([1.0 + k * STEP for k in range(4)], rel=1e-15)
    assert (status(directory), told(slave)) == ("done", [])


def test_a_run_cut_short_says_so(make_slave, tmp_path):
    before_stop, freed, reset = (make_slave(name) for name in ("before_stop", "freed", "reset"))
    for slave in (before_stop, freed, reset):
        slave.start(stop_time=10 * STEP, output__directory=str(tmp_path / slave.fmu.instanceName))
        steps(slave, 2)
    before_stop.fmu.terminate()
    freed.free()
    # The fixture frees what is left; NULL is fine.
    freed.fmu.component = None
    reset.fmu.reset()
    for slave in (before_stop, freed, reset):
        directory = tmp_path / slave.fmu.instanceName
        assert {path.name for path in directory.iterdir()} == RESULTS
        assert (status(directory), len(times(directory))) == ("interrupted", 3)


def test_results_of_a_run_before_are_not_overwritten_without_a_word(make_slave, tmp_path):
    directory = str(tmp_path / "results")
    first, second = make_slave("first"), make_slave("second")
    for slave in (first, second):
        slave.start(output__directory=directory)
        steps(slave, 1)
        slave.fmu.terminate()
    assert told(first) == []
    [(_, level, category, text)] = told(second)
    assert (level, category) == (WARNING, "logStatusWarning")
    assert "output.directory" in text and directory in text


def test_a_run_begun_anew_leaves_no_results_of_the_run_before(make_slave, tmp_path):
    """The folder of a run that was going on held the verdict and the coil of the one before, and a report mixed the two."""
    directory = tmp_path / "results"
    first, second = make_slave("first"), make_slave("second")
    first.start(output__directory=str(directory))
    steps(first, 2)
    first.fmu.terminate()
    (directory / "checkpoint.bin").write_bytes(b"of a run of the command")
    second.start(output__directory=str(directory))
    steps(second, 1)
    assert {path.name for path in directory.iterdir()} == {"scene.toml", "history.csv"}
    second.fmu.terminate()
    assert {path.name for path in directory.iterdir()} == RESULTS


def test_a_run_freed_at_its_stop_time_is_done(slave, tmp_path):
    """It was "interrupted", although it had come to its end."""
    slave.start(stop_time=2 * STEP, output__directory=str(tmp_path))
    steps(slave, 2)
    slave.free()
    slave.fmu.component = None
    assert status(tmp_path) == "done"


def test_time_computed_before_a_roll_back_counts(slave, tmp_path):
    """A master that rolls back at every step told the wall time of its last one."""
    slave.start(output__directory=str(tmp_path))
    state = slave.fmu.getFMUstate()
    steps(slave, 20)
    slave.fmu.setFMUstate(state)
    slave.fmu.freeFMUstate(state)
    slave.fmu.terminate()
    assert json.loads((tmp_path / "summary.json").read_text())["wall_s"] > 0.0


def test_a_directory_that_cannot_be_made_is_a_warning(slave, tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    slave.start(output__directory=str(blocked / "results"))
    _, level, category, text = slave.log[-1]
    assert (level, category) == (WARNING, "logStatusWarning")
    assert "output.directory" in text and str(blocked) in text
    steps(slave, 2)
    slave.fmu.terminate()
    assert blocked.read_text() == "in the way"


def test_a_directory_that_vanishes_is_a_warning(slave, tmp_path):
    directory = tmp_path / "results"
    slave.start(output__directory=str(directory))
    steps(slave, 1)
    for path in directory.iterdir():
        path.unlink()
    directory.rmdir()
    steps_after = slave.get("solver_steps")
    slave.fmu.doStep(STEP, STEP)
    slave.fmu.terminate()
    assert slave.get("solver_steps") > steps_after
    [(_, level, _, text)] = told(slave)
    assert level == WARNING and "turns.csv" in text
