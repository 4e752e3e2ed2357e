"""scripts/sweep_dask.py: the same bytes for any number of workers, also where workers are killed or the sweep is stopped on the way."""

import contextlib
import csv
import json
import math
import os
import signal
import socket
import subprocess
import sys
import threading
import time
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


def begun(sweep_dask, folder, tasks):
    """A ledger in an empty folder."""
    ledger = sweep_dask.ledger_of(folder, *tasks, {})
    ledger.begin()
    return ledger


@pytest.fixture(scope="module")
def alone(sweep_dask, tasks, fmu, tmp_path_factory):
    """The table without Dask."""
    folder = tmp_path_factory.mktemp("alone")
    with open(fmu, "rb") as file:
        unpacked = sweep_dask.unpack(file.read(), folder)
    ledger = begun(sweep_dask, folder, tasks)
    for task in tasks[1]:
        sweep_dask.keep_in(ledger, task, {**sweep_dask.wind(unpacked, task), "worker": ""})
    ledger.write()
    return (folder / "sweep.csv").read_bytes()


def test_the_script_leaves_the_table_of_a_plain_loop(alone, scene, fmu, command, script, tmp_path):
    words = ["--command", command, "--fmu", fmu, "--workers", "1", "--out", tmp_path]
    code, said = script("scripts/sweep_dask.py", scene, *OVER, *words)
    assert code == 0, said
    assert (tmp_path / "sweep.csv").read_bytes() == alone
    assert alone.count(b"\n") == RUNS + 1
    assert f"{RUNS} of {RUNS} runs" in said and "ms more between runs" in said and "on 1 worker\n" in said
    rows = list(csv.DictReader((tmp_path / "times.csv").open(encoding="utf-8")))
    assert [int(row["run"]) for row in rows] == list(range(RUNS))


def test_members_lie_apart_by_wire_with_its_enamel(sweep_dask, fmu, command, tmp_path):
    """The nozzle of a member was moved by half a bare wire, and the member was another than that of `coilwind sweep`."""
    enamelled = tmp_path / "enamelled.toml"
    enamelled.write_text(SCENE + "[wire]\ndiameter_mm = 0.5\nenamelled_diameter_mm = 0.6\n[nozzle]\ndistance_mm = 50\n", encoding="utf-8")
    words = Namespace(command=command, scene=str(enamelled), over=["spindle.speed=60:60:1"], set=[], ensemble=3, step=5e-4)
    _, tasks = sweep_dask.tasks_of(words)
    task = next(task for task in tasks if task["offset"])
    with open(fmu, "rb") as file:
        unpacked = sweep_dask.unpack(file.read(), tmp_path)
    at = {**task["parameters"], "nozzle.distance": 0.05 + task["offset"] * 0.6e-3}
    moved, nearer = (sweep_dask.wind(unpacked, one)["result"] for one in (task, {**task, "offset": 0.0, "parameters": at}))
    assert moved == nearer


def test_runs_that_judge_nothing_are_told(scene, fmu, command, script, tmp_path):
    """They counted as runs without a defect."""
    words = ["--over", "spindle.speed=100:100:1", "--command", command, "--fmu", fmu, "--workers", "1", "--out", tmp_path, "--force"]
    for turns, judged in (("0.5", "false"), ("2.5", "true")):
        code, said = script("scripts/sweep_dask.py", scene, *words, "--set", f"spindle.turns={turns}")
        assert code == 0, said
        (row,) = csv.DictReader((tmp_path / "sweep.csv").open(encoding="utf-8"))
        assert row["judged"] == judged, row
        assert ("in 1 of 1 runs no turn came to rest beside another" in said) == (judged == "false"), said
        assert f"{0 if judged == 'true' else 1} not judged" in said, said


def test_another_sweep_is_not_overwritten_without_a_word(scene, fmu, command, script, tmp_path):
    other = tmp_path / "sweep.csv"
    other.write_text("of another sweep\n", encoding="utf-8")
    (tmp_path / "sweep.json").write_text("{}\n", encoding="utf-8")
    over = ["--over", "spindle.speed=100:100:1", "--set", "spindle.turns=0.3"]
    words = [*over, "--command", command, "--fmu", fmu, "--workers", "1", "--out", tmp_path]
    code, said = script("scripts/sweep_dask.py", scene, *words)
    assert code == 2 and "holds another sweep (another over, " in said and "); add --force" in said and len(said.splitlines()) == 1, said
    assert other.read_text(encoding="utf-8") == "of another sweep\n"
    code, said = script("scripts/sweep_dask.py", scene, *words, "--force", "--quiet")
    assert code == 0 and said == "", said
    assert {path.name for path in tmp_path.iterdir()} == {"sweep.csv", "times.csv", "sweep.json"}
    assert len(list(csv.DictReader(other.open(encoding="utf-8")))) == 1


def test_workers_that_die_as_they_start_start_again(sweep_dask):
    tries = []

    def dies(times):
        tries.append(times)
        if len(tries) <= times:
            raise RuntimeError("Nanny failed to start.")
        return "a cluster"

    assert sweep_dask.begun(lambda: dies(2)) == "a cluster" and len(tries) == 3
    with pytest.raises(sweep_dask.Stuck, match="the workers did not start: Nanny failed"):
        sweep_dask.begun(lambda: dies(1000))


def test_killed_workers_change_nothing(alone, sweep_dask, tasks, fmu, tmp_path):
    import dask
    from distributed import Client, LocalCluster

    ledger = begun(sweep_dask, tmp_path, tasks)
    killed, workers = [], set()
    dask.config.set({"distributed.scheduler.allowed-failures": sweep_dask.DEATHS})
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:

        def keep(task, report):
            sweep_dask.keep_in(ledger, task, report)
            workers.add(report["worker"])
            ended = len(ledger.rows)
            # One of the workers that are alive, at three instants of the sweep.
            if ended in (2, 5, 8):
                pids = sorted(client.run(os.getpid).values())
                os.kill(pids[ended % len(pids)], signal.SIGKILL)
                killed.append(ended)

        with open(fmu, "rb") as file:
            sweep_dask.wind_all(client, file.read(), tasks[1], keep)
    assert killed == [2, 5, 8]
    ledger.write()
    assert (tmp_path / "sweep.csv").read_bytes() == alone
    assert len(workers) > 2


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


# A core of 2 by 2 cm and 3 cm long, its two files as a user may write them.
BESIDE = """
[core]
shape = "mesh"
'file' = "shapes/box \\"of me\\".stl" # file = "another"
[spindle]
turns = 0.7
file = 'speed.csv'
[traverse]
per_turn_mm = 0.8
"""
# Its eight corners and twelve triangles, seen from outside.
CORNERS = [(x, y, z) for x in (-10, 10) for y in (-15, 15) for z in (-10, 10)]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
SLOW = "angle_deg,share\n0,1\n180,0.5\n360,1\n"


@pytest.fixture
def beside(tmp_path):
    """A scene with files beside it."""
    folder = tmp_path / "scene"
    (folder / "shapes").mkdir(parents=True)
    facets = [(face[0], *face[at : at + 2]) for face in FACES for at in (1, 2)]
    shown = ["\n".join("vertex {} {} {}".format(*CORNERS[at]) for at in facet) for facet in facets]
    solid = "".join(f"facet normal 0 0 0\nouter loop\n{vertices}\nendloop\nendfacet\n" for vertices in shown)
    (folder / 'shapes/box "of me".stl').write_text(f"solid box\n{solid}endsolid box\n", encoding="ascii")
    (folder / "speed.csv").write_text(SLOW, encoding="ascii")
    (folder / "machine.toml").write_text(BESIDE, encoding="utf-8")
    return folder / "machine.toml"


def test_files_that_a_scene_names_travel_with_it(beside, fmu, command, script, tmp_path):
    """The workers looked for them in a folder of their own, and the packages of Python were to blame."""
    words = ["--over", "spindle.speed=100:100:1", "--ensemble", "2", "--command", command, "--fmu", fmu, "--workers", "1", "--out", tmp_path / "out"]
    code, said = script("scripts/sweep_dask.py", beside, *words)
    assert code == 0, said
    table = (tmp_path / "out/sweep.csv").read_bytes()
    code, said = script("scripts/sweep_dask.py", beside, *words)
    assert code == 0 and "2 runs, 0 of them new" in said, said
    # The same sweep from another place, of files that are elsewhere.
    moved = beside.parent.rename(tmp_path / "moved") / "machine.toml"
    text = moved.read_text(encoding="utf-8")
    (moved.parent / "speed.csv").rename(tmp_path / "speed.csv")
    moved.write_text(text.replace("'speed.csv'", f"'{tmp_path / 'speed.csv'}'"), encoding="utf-8")
    code, said = script("scripts/sweep_dask.py", moved, *words, "--force")
    assert code == 0 and (tmp_path / "out/sweep.csv").read_bytes() == table, said
    stl = moved.parent / 'shapes/box "of me".stl'
    stl.write_bytes(stl.read_bytes().replace(b"15", b"16"))
    code, said = script("scripts/sweep_dask.py", moved, *words)
    assert code == 2 and "holds another sweep (another files)" in said and len(said.splitlines()) == 1, said


@pytest.mark.parametrize("line", ['file = """tooth.stl"""', '"fil\\u0065" = "tooth.stl"'])
def test_a_file_that_is_named_in_another_way_is_told(line, sweep_dask, tmp_path):
    scene = tmp_path / "machine.toml"
    scene.write_text(f"# file\n[core]\n{line}\n", encoding="utf-8")
    (tmp_path / "tooth.stl").write_bytes(b"solid")
    with pytest.raises(sweep_dask.Mistake, match="write each of core.file on one line, in quotes"):
        sweep_dask.carried(scene, ["core.file"])


def test_what_the_fmu_refuses_is_told_in_its_words(sweep_dask, tasks, fmu, tmp_path):
    """A later call failed too, and its error hid what the FMU had said."""
    from distributed import Client, LocalCluster

    task = {**tasks[1][0], "scene": '[core]\nshape = "mesh"\nfile = "none.stl"\n'}
    with open(fmu, "rb") as file:
        data = file.read()
    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        with pytest.raises(sweep_dask.Mistake) as told:
            sweep_dask.wind_all(client, data, [task], None)
    assert str(told.value).startswith("the FMU does not begin run 0: ") and "none.stl" in str(told.value) and str(tmp_path) not in str(told.value)
    assert "packages" not in str(told.value) and "\n" not in str(told.value)


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["--over", "spindle.speed=3:1:2"], "A has to be below B"),
        (["--over", "spindle.speed=1:2"], "expected NAME=A:B:N"),
        (["--over", "spindle.sped=1:2:2"], "there is no such parameter"),
        (["--over", "spindle.speed=1:2:2", "--set", "wire.material=copper"], "wire.material is no number"),
        (["--over", "wire.diameter=-1:2:2"], "wire.diameter"),
        (["--over", "spindle.speed=100:200:2", "--scheduler", "tcp://127.0.0.1:9"], "there is no scheduler"),
        (["--over", "spindle.speed=100:200:2", "--workers", "0"], "--workers 0 has to be at least 1"),
        (["--over", "spindle.speed=100:200:2", "--fmu", "none.fmu"], "none.fmu is missing; build it with scripts/build_fmu.sh"),
    ],
)
def test_what_cannot_be_swept_is_told_in_a_line(words, complaint, scene, fmu, command, script, tmp_path):
    fixed = ["--command", command, "--out", tmp_path / "out"] + ([] if "--fmu" in words else ["--fmu", fmu])
    code, said = script("scripts/sweep_dask.py", scene, *words, *fixed)
    assert code == 2
    assert complaint in said and len(said.splitlines()) == 1, said
    assert not (tmp_path / "out").exists()


@contextlib.contextmanager
def answering(said):
    """The address of a server that says this to whoever comes, and then nothing."""
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve():
            with contextlib.suppress(OSError), contextlib.ExitStack() as held:
                while True:
                    caller = held.enter_context(server.accept()[0])
                    caller.sendall(said)

        threading.Thread(target=serve, daemon=True).start()
        yield f"tcp://127.0.0.1:{server.getsockname()[1]}"


@pytest.mark.parametrize(("said", "complaint"), [(b"", "within 5 s"), (b"SSH-2.0-OpenSSH_9.2\r\n" * 9, "what answers is no scheduler of Dask")])
def test_another_program_at_the_address_is_told_in_time(said, complaint, scene, fmu, command, script, tmp_path):
    """The client of Dask waits for ever, or wants exabytes of memory."""
    with answering(said) as address:
        words = ["--over", "spindle.speed=100:200:2", "--command", command, "--fmu", fmu, "--scheduler", address, "--out", tmp_path / "out"]
        code, told = script("scripts/sweep_dask.py", scene, *words, timeout=30)
    assert code == 2 and f"--scheduler {address}: " in told and complaint in told and "start one with dask scheduler" in told, told
    assert len(told.splitlines()) == 1 and not (tmp_path / "out").exists()


@contextlib.contextmanager
def scheduler(workers, folder):
    """The process and the address of a scheduler on a port of its own."""
    file = folder / "scheduler.json"
    module = [sys.executable, "-m"]
    line = [*module, "distributed.cli.dask_scheduler", "--port", "0", "--no-dashboard", "--host", "127.0.0.1", "--scheduler-file", str(file)]
    silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    children = [subprocess.Popen(line, **silent)]
    try:
        while not file.exists() or not file.read_text(encoding="utf-8").strip():
            assert children[0].poll() is None
            time.sleep(0.05)
        address = json.loads(file.read_text(encoding="utf-8"))["address"]
        for _ in range(workers):
            line = [*module, "distributed.cli.dask_worker", address, "--nthreads", "1", "--no-dashboard", "--death-timeout", "20"]
            children.append(subprocess.Popen(line, cwd=folder, **silent))
        yield children[0], address
    finally:
        for child in children:
            child.terminate()
        for child in children:
            child.wait(20)


def test_a_scheduler_without_workers_ends_in_time(scene, fmu, command, script, tmp_path):
    with scheduler(0, tmp_path) as (_, address):
        words = ["--over", "spindle.speed=100:200:2", "--command", command, "--fmu", fmu, "--scheduler", address, "--wait", "5"]
        code, said = script("scripts/sweep_dask.py", scene, *words, "--out", tmp_path / "out", timeout=60)
    lines = said.splitlines()
    assert code == 3 and len(lines) == 2, said
    assert lines[0] == f"waiting up to 5 s for a worker; start some with: dask worker {address}"
    assert f"the scheduler {address} had no worker for 5 s; start some with: dask worker {address}; 0 runs are kept" in lines[1]


# Runs of a second: one is on its way whenever a test stops the sweep.
LONG = ["--over", "spindle.speed=60:120:4", "--set", "spindle.turns=3"]


@pytest.fixture
def stopped(scene, fmu, command, root, tmp_path):
    """Ends a sweep on its way; its exit code, what it said in its last line, and its folder."""

    def run(stop, *words):
        out = tmp_path / "out"
        line = [sys.executable, root / "scripts/sweep_dask.py", scene, *LONG, "--command", command, "--fmu", fmu, "--out", out, "--quiet", *words]
        child = subprocess.Popen(list(map(str, line)), stderr=subprocess.PIPE, text=True, start_new_session=True)
        while not (out / "sweep.csv").exists():
            assert child.poll() is None, child.communicate()
            time.sleep(0.02)
        stop(child)
        said = child.communicate(timeout=30)[1]
        assert len(said.splitlines()) == 1, said
        return child.returncode, said, out

    return run


@pytest.fixture(scope="module")
def uninterrupted(scene, fmu, command, script, tmp_path_factory):
    out = tmp_path_factory.mktemp("whole")
    code, said = script("scripts/sweep_dask.py", scene, *LONG, "--command", command, "--fmu", fmu, "--out", out, "--workers", "1")
    assert code == 0, said
    return (out / "sweep.csv").read_bytes()


# On a terminal Ctrl-C reaches the workers as well.
@pytest.mark.parametrize("stop", [lambda child: os.killpg(child.pid, signal.SIGINT), lambda child: child.send_signal(signal.SIGTERM)], ids=["SIGINT", "SIGTERM"])
def test_a_sweep_that_is_stopped_goes_on_to_the_same_bytes(stop, stopped, uninterrupted, tmp_path):
    code, said, out = stopped(stop, "--workers", "1")
    kept = (out / "sweep.csv").read_bytes()
    runs = kept.count(b"\n") - 1
    assert code == 130 and f"interrupted; {runs} runs are kept; go on with: " in said, said
    assert 1 <= runs < 4 and uninterrupted.startswith(kept)
    line = said.partition("go on with: ")[2]
    assert " --quiet" in line
    again = subprocess.run(line.replace(" --quiet", ""), shell=True, capture_output=True, text=True, check=False)
    assert again.returncode == 0 and f"4 runs, {4 - runs} of them new" in again.stdout, again.stderr
    assert (out / "sweep.csv").read_bytes() == uninterrupted
    assert not list(out.glob("*.partial*"))


def test_a_lost_scheduler_leaves_the_rows(stopped, uninterrupted, tmp_path):
    with scheduler(1, tmp_path) as (process, address):
        code, said, out = stopped(lambda _: process.kill(), "--scheduler", address)
    assert code == 3 and f"the scheduler {address} was lost; " in said and " runs are kept; go on with: " in said, said
    assert uninterrupted.startswith((out / "sweep.csv").read_bytes())


def test_a_full_disk_leaves_the_rows(stopped, uninterrupted, tmp_path):
    code, said, out = stopped(lambda _: (tmp_path / "out/sweep.partial.csv").symlink_to("/dev/full"), "--workers", "1")
    assert code == 3 and f"cannot write {out}/sweep.csv: No space left on device; " in said and "go on with: " in said, said
    assert uninterrupted.startswith((out / "sweep.csv").read_bytes())


def test_the_folder_of_something_else_is_refused(sweep_dask, tasks, tmp_path):
    names, runs = tasks

    def refused(plan=None):
        with pytest.raises(sweep_dask.Mistake) as told:
            sweep_dask.ledger_of(tmp_path, names, runs, plan or {})
        return str(told.value)

    begun(sweep_dask, tmp_path, tasks)
    assert f"{tmp_path} holds another sweep (another set); add --force" in refused({"set": ["spindle.turns=2"]})
    (tmp_path / "sweep.csv").write_text("spindle.speed,member\n1,1\n", encoding="utf-8")
    assert f"{tmp_path / 'sweep.csv'}:1: no row of this sweep; remove the line, or begin again with --force" in refused()
    (tmp_path / "sweep.json").write_text("{", encoding="utf-8")
    assert "holds another sweep (its sweep.json is not whole)" in refused()
    (tmp_path / "scene.toml").write_text("[core]\n", encoding="utf-8")
    assert f"{tmp_path} holds another run; add --force to overwrite it, or --out for another folder" in refused()
    sweep_dask.ledger_of(tmp_path, names, runs, {}, force=True).begin()
    assert {path.name for path in tmp_path.iterdir()} == {"sweep.json"}


@pytest.mark.parametrize("cut", [lambda data: data[:-1], lambda data: data[:-9], lambda data: data[: data[:-1].rindex(b",")] + b"\n"])
def test_a_last_row_that_a_crash_has_cut_is_wound_again(cut, alone, sweep_dask, tasks, tmp_path):
    """It was refused, though the same command goes on after a crash."""
    whole = begun(sweep_dask, tmp_path, tasks)
    whole.lock.close()
    (tmp_path / "sweep.csv").write_bytes(cut(alone))
    (tmp_path / "times.csv").write_bytes(cut(b"run,worker,began,wound_s\n0,here,1,2\n11,there,3,4\n"))
    ledger = sweep_dask.ledger_of(tmp_path, *tasks, {})
    assert sorted(ledger.rows) == list(range(RUNS - 1)) and ledger.times == {0: ["here", "1", "2"]}
    last = alone.decode().splitlines()[-1].split(",")
    ledger.add(RUNS - 1, last, ["", "", ""])
    ledger.write()
    assert (tmp_path / "sweep.csv").read_bytes() == alone


def test_a_sweep_whose_header_is_cut_begins_again(sweep_dask, tasks, tmp_path):
    begun(sweep_dask, tmp_path, tasks).lock.close()
    (tmp_path / "sweep.csv").write_text("spindle.sp", encoding="utf-8")
    assert not sweep_dask.ledger_of(tmp_path, *tasks, {}).rows


def test_a_row_that_is_cut_before_others_is_refused(alone, sweep_dask, tasks, tmp_path):
    begun(sweep_dask, tmp_path, tasks).lock.close()
    header, first, *rest = alone.splitlines(keepends=True)
    (tmp_path / "sweep.csv").write_bytes(b"".join([header, first[:20] + b"\n", *rest]))
    with pytest.raises(sweep_dask.Mistake, match=":2: no row of this sweep; remove the line"):
        sweep_dask.ledger_of(tmp_path, *tasks, {})


def test_the_scene_is_not_removed_with_the_run_that_it_lies_in(scene, fmu, command, script, tmp_path):
    inside = tmp_path / "scene.toml"
    inside.write_bytes(scene.read_bytes())
    words = ["--over", "spindle.speed=100:200:2", "--command", command, "--fmu", fmu, "--out", tmp_path, "--force"]
    code, said = script("scripts/sweep_dask.py", inside, *words)
    assert code == 2 and f"{inside} lies in {tmp_path}, which --force empties" in said and inside.exists(), said


def test_two_sweeps_in_a_folder_are_refused(sweep_dask, tasks, tmp_path):
    pytest.importorskip("fcntl")
    first = begun(sweep_dask, tmp_path, tasks)
    with pytest.raises(sweep_dask.Mistake, match="a sweep is going on here"):
        sweep_dask.ledger_of(tmp_path, *tasks, {}).begin()
    first.lock.close()


def test_what_was_built_is_looked_for_in_the_target_folder_of_cargo(scene, root, tmp_path):
    env = {name: value for name, value in os.environ.items() if not name.startswith("COILWIND_")} | {"CARGO_TARGET_DIR": str(tmp_path)}
    for name, words in [("sweep_dask", ["--over", "spindle.speed=1:2:2"]), ("calibrate", ["--measured", "x.csv", "--fit", "tensioner.mass"])]:
        line = [sys.executable, root / f"scripts/{name}.py", scene, *words]
        said = subprocess.run(line, capture_output=True, text=True, check=False, env=env, cwd=tmp_path).stderr
        assert said == f"{name}.py: {tmp_path}/release/coilwind is missing; build it with cargo build --release\n"


def test_a_worker_in_place_of_a_dead_one_is_no_other(sweep_dask):
    reports = [{"worker": name, "began": began, "ended": ended} for name, began, ended in [
        ("a", 0.0, 2.0), ("b", 0.0, 3.0), ("a2", 2.0, 4.0), ("b", 3.0, 5.0), ("", 0.0, 0.0),
    ]]
    assert sweep_dask.most_at_once(reports) == 2
    assert sweep_dask.most_at_once([]) == 0


def test_a_result_that_died_with_its_worker_is_waited_for(sweep_dask, monkeypatch):
    """It was told as a lost scheduler."""
    monkeypatch.setattr(sweep_dask, "LOOK", 0.01)

    class Future:
        states = ["lost", "pending", "finished"]

        @property
        def status(self):
            return self.states.pop(0) if len(self.states) > 1 else self.states[0]

        def add_done_callback(self, tell):
            tell(self)

        def result(self):
            return "a report"

    class Client:
        class scheduler:
            address = "tcp://nowhere"
            identity = None

        def register_plugin(self, plugin):
            pass

        def submit(self, *task, **options):
            return Future()

        def sync(self, *call, **options):
            return {"workers": ["one"]}

    kept = []
    sweep_dask.wind_all(Client(), b"", [{"run": 0}], lambda task, report: kept.append((task, report)))
    assert kept == [({"run": 0}, "a report")]


def test_a_worker_that_winds_several_runs_at_once_tells_no_time_between_them(sweep_dask):
    """The closing words had a negative time."""
    def report(worker, began, ended):
        return {"worker": worker, "began": began, "ended": ended}

    one = [report("a", 0.0, 1.0), report("a", 1.2, 2.0), report("a", 2.2, 3.0)]
    several = [report("b", 0.0, 1.0), report("b", 0.1, 1.1), report("b", 1.2, 2.0)]
    assert sweep_dask.overhead(one + several) == pytest.approx(0.2)
    assert math.isnan(sweep_dask.overhead(several))
