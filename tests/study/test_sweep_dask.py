"""scripts/sweep_dask.py: the same bytes for any number of workers, also where workers are killed on the way."""

import csv
import json
import os
import signal
import subprocess
import sys
from argparse import Namespace

import pytest

SCENE = """
[core]
shape = "cylinder"
radius_mm = 10
length_y_mm = 60
[spindle]
turns = 0.7
[traverse]
per_turn_mm = 5
"""
OVER = ["--over", "spindle.speed=50:150:3", "--over", "tensioner.mass_g=1:3:2", "--ensemble", "2"]
RUNS = 12


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "cylinder.toml"
    path.write_text(SCENE, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def sweep_dask(root):
    sys.path.insert(0, str(root / "scripts"))
    import sweep_dask

    return sweep_dask


@pytest.fixture(scope="module")
def tasks(sweep_dask, scene, command):
    over = OVER[1:4:2]
    return sweep_dask.tasks_of(Namespace(command=command, scene=str(scene), over=over, set=[], ensemble=2, step=5e-4))


@pytest.fixture(scope="module")
def alone(sweep_dask, tasks, fmu, tmp_path_factory):
    """The table without Dask."""
    folder = tmp_path_factory.mktemp("alone")
    with open(fmu, "rb") as file:
        unpacked = sweep_dask.unpack(file.read(), folder)
    names, runs = tasks
    sweep_dask.write(folder, names, runs, [{**sweep_dask.wind(unpacked, task), "worker": ""} for task in runs])
    return (folder / "sweep.csv").read_bytes()


def test_the_script_leaves_the_table_of_a_plain_loop(alone, scene, fmu, command, script, tmp_path):
    words = ["--command", command, "--fmu", fmu, "--workers", "1", "--out", tmp_path]
    code, said = script("scripts/sweep_dask.py", scene, *OVER, *words)
    assert code == 0, said
    assert (tmp_path / "sweep.csv").read_bytes() == alone
    assert alone.count(b"\n") == RUNS + 1
    assert f"{RUNS} of {RUNS} runs" in said and "ms more between runs" in said and "on 1 workers" in said
    rows = list(csv.DictReader((tmp_path / "times.csv").open(encoding="utf-8")))
    assert [int(row["run"]) for row in rows] == list(range(RUNS))


def test_another_sweep_is_not_overwritten_without_a_word(scene, fmu, command, script, tmp_path):
    other = tmp_path / "sweep.csv"
    other.write_text("of another sweep\n", encoding="utf-8")
    (tmp_path / "sweep.json").write_text("{}\n", encoding="utf-8")
    over = ["--over", "spindle.speed=100:100:1", "--set", "spindle.turns=0.3"]
    words = [*over, "--command", command, "--fmu", fmu, "--workers", "1", "--out", tmp_path]
    code, said = script("scripts/sweep_dask.py", scene, *words)
    assert code == 2 and "holds another sweep; add --force" in said and len(said.splitlines()) == 1, said
    assert other.read_text(encoding="utf-8") == "of another sweep\n"
    code, said = script("scripts/sweep_dask.py", scene, *words, "--force")
    assert code == 0, said
    assert {path.name for path in tmp_path.iterdir()} == {"sweep.csv", "times.csv"}
    assert len(list(csv.DictReader(other.open(encoding="utf-8")))) == 1


def test_killed_workers_change_nothing(alone, sweep_dask, tasks, fmu, tmp_path):
    import dask
    from distributed import Client, LocalCluster

    names, runs = tasks
    killed = []
    dask.config.set({"distributed.scheduler.allowed-failures": sweep_dask.DEATHS})
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:

        def kill(ended):
            # One of the workers that are alive, at three instants of the sweep.
            if ended in (2, 5, 8):
                pids = sorted(client.run(os.getpid).values())
                os.kill(pids[ended % len(pids)], signal.SIGKILL)
                killed.append(ended)

        with open(fmu, "rb") as file:
            reports = sweep_dask.wind_all(client, file.read(), runs, kill)
    assert killed == [2, 5, 8]
    sweep_dask.write(tmp_path, names, runs, reports)
    assert (tmp_path / "sweep.csv").read_bytes() == alone
    assert len({report["worker"] for report in reports}) > 2


def test_a_run_has_the_numbers_of_the_command(alone, scene, command, tmp_path):
    row = list(csv.DictReader(alone.decode().splitlines()))[6]
    assert (row["spindle.speed"], row["tensioner.mass_g"], row["member"]) == ("100.0", "3.0", "1")
    sets = ["--set", "spindle.speed=100", "--set", "tensioner.mass_g=3", "--set", "nozzle.distance_mm=59.65"]
    motion = tmp_path / "motion.csv"
    subprocess.run([command, "motion", scene, *sets, "--out", motion], check=True)
    words = ["--inputs", motion, "--step", "5e-4", "--no-geometry", "--quiet", "--out", tmp_path / "run"]
    subprocess.run([command, "run", scene, *sets, *words], check=True)
    history = list(csv.DictReader((tmp_path / "run/history.csv").open(encoding="utf-8")))
    # 59.65 mm and the nozzle of the member are the same but for the last digit.
    for name, of, column in [("tension_max_N", max, "wire_tension_max"), ("turns_settled", max, "turns_settled")]:
        assert float(row[name]) == pytest.approx(of(float(line[column]) for line in history), rel=1e-4), name
    assert json.loads((tmp_path / "run/summary.json").read_text(encoding="utf-8"))["status"] == "done"


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["--over", "spindle.speed=3:1:2"], "A has to be below B"),
        (["--over", "spindle.speed=1:2"], "expected NAME=A:B:N"),
        (["--over", "spindle.sped=1:2:2"], "there is no such parameter"),
        (["--over", "spindle.speed=1:2:2", "--set", "wire.material=copper"], "wire.material is no number"),
        (["--over", "wire.diameter=-1:2:2"], "wire.diameter"),
        (["--over", "spindle.speed=100:200:2", "--scheduler", "tcp://127.0.0.1:9"], "there is no scheduler"),
        (["--over", "spindle.speed=100:200:2", "--fmu", "none.fmu"], "none.fmu is missing; build it with scripts/build_fmu.sh"),
    ],
)
def test_what_cannot_be_swept_is_told_in_a_line(words, complaint, scene, fmu, command, script, tmp_path):
    fixed = ["--command", command, "--out", tmp_path / "out"] + ([] if "--fmu" in words else ["--fmu", fmu])
    code, said = script("scripts/sweep_dask.py", scene, *words, *fixed)
    assert code == 2
    assert complaint in said and len(said.splitlines()) == 1, said
    assert not (tmp_path / "out").exists()
