#!/usr/bin/env python3
"""Sweeps a scene through the FMU, on a cluster of Dask.

    sweep_dask.py fig8 --over spindle.speed=100:400:4 --ensemble 4 --set spindle.turns=2.5 --out target/speeds
    sweep_dask.py SCENE.toml --over tensioner.tension=5:15:3 --scheduler tcp://HOST:8786

The Python is that of `scripts/venv.sh study`. Without --scheduler the workers are processes of this machine. The FMU, the scene
and the files that it names travel to the workers; they need fmpy and dask, and no coilwind. Each run follows the scene's own motion,
as `coilwind motion` samples it. A run whose worker dies is wound again elsewhere.

DIR gets sweep.csv, a row a run in the order of the grid, the same bytes for any number of workers; times.csv, which says
where and how long each run was wound; and sweep.json, which says what the sweep is. Rows are written as runs end. After Ctrl-C,
SIGTERM, a kill or a full disk the same command goes on with the runs that have no row.

Exit codes: 0 every run has its row, 2 a mistake that can be mended, 3 a full disk or a lost scheduler on the way, 130 stopped.
"""

import argparse
import asyncio
import contextlib
import csv
import hashlib
import io
import itertools
import json
import math
import os
import queue
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import folder as folders
from carried import carried
from failure import Interrupted, Mistake, Stuck, same_command, told
from progress import Progress
from sweep_ledger import ROWS, TIMES, Ledger

# Spread of the members' nozzle distance about the scene's, outer diameters of the wire, as in `coilwind sweep`.
SPREAD = 0.5
# Deaths of its worker that a run survives.
DEATHS = 10
UNITS = {
    "m": 1.0, "mm": 1e-3, "um": 1e-6, "kg": 1.0, "g": 1e-3, "Pa": 1.0, "MPa": 1e6, "GPa": 1e9,
    "rad": 1.0, "deg": math.pi / 180.0, "rad_per_s": 1.0, "rpm": math.pi / 30.0,
}
# Within this time a scheduler answers, s.
ANSWER = 5.0
# Time between two looks at the scheduler while no run ends, and how long it may take to answer while it works, s.
LOOK, BUSY = 1.0, 30.0
# Code that workers of this machine run first: Ctrl-C on a terminal reaches them as well, and the script is what ends them.
DEAF = "import signal\nsignal.signal(signal.SIGINT, signal.SIG_IGN)"
# Without a worker for so long, the script says that it waits, s.
SILENT = 3.0
COUNTS = ["bulge", "gap", "overlap", "break", "slack"]
# Turns at rest from which on one counts beside another: half of the second, as for the verdict of `coilwind sweep`.
BESIDE = 1.5
RESULTS = [
    "outcome", "reason", "defect", "judged", *(f"defects_{kind}" for kind in COUNTS),
    "gap_max_m", "bulge_max_m", "tension_min_N", "tension_max_N", "turns_settled",
]


# What workers do. It is sent to them whole, so it imports what it needs.


def unpack(fmu, folder, files=None):
    """Unpacks the bytes of an FMU, and of the files that the scene names; what `wind` needs of them."""
    import fmpy

    # The scene of a run names a file from its own folder, which is one below.
    scenes = Path(folder) / "scenes"
    scenes.mkdir()
    for name, data in (files or {}).items():
        (scenes / name).parent.mkdir()
        (scenes / name).write_bytes(data)
    path = Path(folder) / "sweep.fmu"
    path.write_bytes(fmu)
    description = fmpy.read_model_description(str(path))
    return {
        "scenes": str(scenes),
        "folder": fmpy.extract(str(path), str(Path(folder) / "fmu")),
        "guid": description.guid,
        "model": description.coSimulation.modelIdentifier,
        "references": {variable.name: variable.valueReference for variable in description.modelVariables},
    }


def wind(fmu, task):
    """One run: its results, and when and how long it was wound; or why the FMU does not begin it."""
    import ctypes
    import tempfile
    import time

    from fmpy.fmi1 import FMICallException
    from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
    from fmpy.logging import addLoggerProxy

    began, said = time.time(), []

    def hear(_component, _instance, status, _category, message):
        if status >= 2:  # discard, error, fatal
            said.append(message.decode("utf-8", "replace"))

    callbacks = fmi2CallbackFunctions()
    callbacks.logger = fmi2CallbackLoggerTYPE(hear)
    addLoggerProxy(ctypes.byref(callbacks))
    reference = fmu["references"]
    slave = FMU2Slave(guid=fmu["guid"], unzipDirectory=fmu["folder"], modelIdentifier=fmu["model"], instanceName=f"run {task['run']}")

    def get(name):
        return slave.getReal([reference[name]])[0]

    counts = [f"defect_count_{kind}" for kind in ("bulge", "gap", "overlap", "break", "slack")]
    extremes = {"gap_width": 0.0, "bulge_height": 0.0, "wire_tension_min": math.inf, "wire_tension_max": -math.inf}
    wanted = [reference[name] for name in extremes]
    result = {"outcome": "done", "reason": ""}
    started, refused = False, ""
    with tempfile.TemporaryDirectory(dir=fmu["scenes"]) as folder:
        scene = task["scene"]
        if "\n" in scene:
            path = Path(folder) / "scene.toml"
            path.write_text(scene, encoding="utf-8")
            scene = str(path)
        slave.instantiate(callbacks=callbacks, loggingOn=False)
        try:
            slave.setString([reference["scene.file"]], [scene])
            for name, value in task["parameters"].items():
                slave.setReal([reference[name]], [value])
            slave.setupExperiment(startTime=0.0)
            inputs = [reference["spindle_speed"], reference["nozzle_position"]]
            motion = task["motion"]
            slave.setReal(inputs, motion[0][1:])
            slave.enterInitializationMode()
            if task["offset"]:
                outer = max(get("wire.diameter"), get("wire.enamelled_diameter"))
                slave.setReal([reference["nozzle.distance"]], [get("nozzle.distance") + task["offset"] * outer])
            slave.exitInitializationMode()
            started = True
            for row, after in zip(motion, motion[1:]):
                slave.setReal(inputs, row[1:])
                slave.doStep(row[0], after[0] - row[0])
                gap, bulge, least, most = slave.getReal(wanted)
                extremes["gap_width"] = max(extremes["gap_width"], gap)
                extremes["bulge_height"] = max(extremes["bulge_height"], bulge)
                extremes["wire_tension_min"] = min(extremes["wire_tension_min"], least)
                extremes["wire_tension_max"] = max(extremes["wire_tension_max"], most)
        except FMICallException as error:
            reason = said[0] if said else str(error)
            result = {"outcome": "failed", "reason": reason}
            refused = "" if started else reason.replace(f"{folder}{os.sep}", "")
        if not refused:
            values = slave.getInteger([reference[name] for name in counts])
            every = slave.getInteger([reference["defect_count"]])[0]
            settled = get("turns_settled")
        slave.freeInstance()
    if refused:
        return {"refused": refused}
    result["defect"] = str(every > 0).lower()
    result["judged"] = str(every > 0 or settled >= task["beside"]).lower()
    result.update(zip([name.replace("defect_count_", "defects_") for name in counts], values))
    result.update(
        gap_max_m=extremes["gap_width"], bulge_max_m=extremes["bulge_height"], turns_settled=settled,
        tension_min_N=extremes["wire_tension_min"], tension_max_N=extremes["wire_tension_max"],
    )
    return {"result": result, "began": began, "ended": time.time()}


# What the client does.


def values_of(text):
    """The name and the values of NAME=A:B:N."""
    name, _, span = text.partition("=")
    try:
        low, high, count = span.split(":")
        low, high, count = float(low), float(high), int(count)
    except ValueError:
        raise Mistake(f"--over {text}: expected NAME=A:B:N, such as spindle.speed=100:400:4") from None
    if count < 1 or (count == 1) != (low == high) or low > high:
        raise Mistake(f"--over {text}: A has to be below B and N at least 2, or A = B and N = 1")
    return name, [float(f"{low + (high - low) * k / max(count - 1, 1):.12g}") for k in range(count)]


def start_value(table, name, value):
    """The name and the value in SI of a setting that the FMU takes; `None` where the motion alone has it."""
    for known, row in table.items():
        suffixes = {f"{known}_{unit}": unit for unit in row["keySuffixes"]} | {known: None}
        if name not in suffixes or row["causality"] != "parameter":
            continue
        if row["nativeOnly"]:
            return None
        if row["type"] != "Real":
            raise Mistake(f"{name} is no number; write it into the scene file")
        return known, float(value) * UNITS[suffixes[name]] if suffixes[name] else float(value)
    raise Mistake(f"{name}: there is no such parameter; `coilwind variables` lists them")


def motion_of(command, scene, settings, step):
    words = [word for name, value in settings for word in ("--set", f"{name}={value}")]
    done = subprocess.run([command, "motion", scene, "--step", repr(step), *words], capture_output=True, text=True, check=False)
    if done.returncode:
        raise Mistake((done.stderr.strip().splitlines() or ["the scene has no motion"])[0])
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    return [[float(row[name]) for name in ("time", "spindle_speed", "nozzle_position")] for row in rows]


def tasks_of(args):
    """Every run, in the order of the grid: names of what is swept, and a task a run."""
    listed = subprocess.run([args.command, "variables", "--json"], capture_output=True, text=True, check=True).stdout
    table = {row["name"]: row for row in json.loads(listed)}
    swept = dict(values_of(text) for text in args.over)
    given = []
    for text in args.set:
        name, equals, value = text.partition("=")
        if not equals:
            raise Mistake(f"--set {text}: expected NAME=VALUE")
        given.append((name, value))
    scene, files = args.scene, {}
    if args.ensemble < 1:
        raise Mistake(f"--ensemble {args.ensemble}: at least 1")
    tasks = []
    for point in itertools.product(*swept.values()):
        settings = [*given, *zip(swept, point)]
        try:
            starts = [start_value(table, name, value) for name, value in settings]
        except ValueError as error:
            raise Mistake(f"--set: {error}") from None
        motion = motion_of(args.command, args.scene, settings, args.step)
        # The command has told by now what is wrong with a scene.
        if not tasks and Path(scene).is_file():
            scene, files = carried(scene, [name for name in table if name.endswith(".file") and name != "scene.file"])
            scene += "\n"
        for member in range(args.ensemble):
            offset = SPREAD * (2.0 * member / (args.ensemble - 1) - 1.0) if args.ensemble > 1 else 0.0
            tasks.append({
                "run": len(tasks), "scene": scene, "files": files, "parameters": dict(start for start in starts if start), "motion": motion,
                "offset": offset, "columns": [*point, member + 1], "beside": BESIDE,
            })
    return list(swept), tasks


def plugin_of(fmu, files):
    """Unpacks the FMU and the files of the scene on every worker, also on one that is started in place of a dead one."""
    from distributed import WorkerPlugin

    whole = hashlib.sha256(b"".join([fmu, *(part for name, data in files.items() for part in (name.encode(), data))]))

    class Fmu(WorkerPlugin):
        name = f"coilwind-{whole.hexdigest()[:16]}"

        def setup(self, worker):
            self.folder = tempfile.TemporaryDirectory()
            self.unpacked = unpack(fmu, self.folder.name, files)

        def teardown(self, worker):
            self.folder.cleanup()

    return Fmu()


def wind_on_worker(plugin, task):
    from distributed import get_worker

    worker = get_worker()
    return {**wind(worker.plugins[plugin].unpacked, task), "worker": worker.address}


def connect(address):
    """A client of the scheduler at `address`; a mistake where there is none."""
    from distributed import Client
    from distributed.core import rpc

    async def kind():
        async with rpc(address, timeout=ANSWER) as there:
            return (await asyncio.wait_for(there.identity(n_workers=0), ANSWER + 1.0))["type"]

    # The client of Dask itself waits for ever for an answer that is not Dask's.
    try:
        if asyncio.run(kind()) == "Scheduler":
            return Client(address, timeout=ANSWER)
        reason = "there is a part of Dask, but no scheduler"
    except TimeoutError:
        reason = f"no answer of Dask within {ANSWER:g} s"
    except OSError as error:
        reason = f"there is no scheduler: {error}"
    except ValueError as error:
        reason = str(error)
    except Exception as error:
        # Bytes of another program can make anything of the protocol, such as a message of exabytes.
        reason = f"what answers is no scheduler of Dask ({type(error).__name__})"
    raise Mistake(f"--scheduler {address}: {reason}; start one with dask scheduler, and give the address that it prints")


def wind_all(client, fmu, tasks, keep, wait=60.0):
    """Winds the tasks on a cluster, and gives each with its report to `keep` as it ends.

    Raises `Stuck` where the scheduler is lost or has no worker for `wait` seconds; `Mistake` where no worker can wind.
    """
    # They are the same for every task, and may be large.
    plugin = plugin_of(fmu, tasks[0].get("files", {}))
    address = client.scheduler.address
    lost = Stuck(f"the scheduler {address} was lost")
    ended = queue.SimpleQueue()
    try:
        client.register_plugin(plugin)
        light = [{name: part for name, part in task.items() if name != "files"} for task in tasks]
        futures = {client.submit(wind_on_worker, plugin.name, sent, pure=False, retries=2): task for sent, task in zip(light, tasks)}
    except OSError:
        raise lost from None
    except Exception as error:
        raise cannot_wind(error) from None
    for future in futures:
        future.add_done_callback(ended.put)
    seen = time.monotonic()
    told_so = False
    while futures:
        try:
            future = ended.get(timeout=LOOK)
        except queue.Empty:
            try:
                workers = client.sync(client.scheduler.identity, n_workers=1, callback_timeout=BUSY)["workers"]
            except (OSError, TimeoutError):
                raise lost from None
            without = time.monotonic() - seen
            if workers:
                seen, told_so = time.monotonic(), False
            elif without > wait:
                raise Stuck(f"the scheduler {address} had no worker for {wait:g} s; start some with: dask worker {address}") from None
            elif without > SILENT and not told_so:
                told_so = True
                print(f"waiting up to {wait:g} s for a worker; start some with: dask worker {address}", file=sys.stderr, flush=True)
            continue
        seen = time.monotonic()
        if future.status in ("lost", "pending"):
            # its worker died with the result before that was fetched; the scheduler has the run wound again
            threading.Timer(LOOK, ended.put, [future]).start()
            continue
        task = futures.pop(future)
        if future.status not in ("finished", "error"):
            raise lost
        report = report_of(future)
        if "refused" in report:
            raise Mistake(f"the FMU does not begin run {task['run']}: {report['refused']}")
        keep(task, report)


def report_of(future):
    from distributed import KilledWorker

    try:
        return future.result()
    except KilledWorker:
        result = {name: "" for name in RESULTS} | {"outcome": "failed", "reason": f"its worker died {DEATHS} times"}
        return {"result": result, "began": 0.0, "ended": 0.0, "worker": ""}
    except Exception as error:
        raise cannot_wind(error) from None


def cannot_wind(error):
    return Mistake(f"a worker cannot wind ({type(error).__name__}: {error}); its Python needs the packages of requirements-study.txt")


def ledger_of(folder, names, tasks, plan, force=False):
    return Ledger(folder, plan, [*names, "member", *RESULTS], [task["columns"] for task in tasks], force)


def keep_in(ledger, task, report):
    row = [*task["columns"], *(report["result"][name] for name in RESULTS)]
    ledger.add(task["run"], row, [report["worker"], report["began"], report["ended"] - report["began"]])


def plan_of(args, tasks, fmu):
    """What makes a sweep the same sweep."""
    motions = json.dumps([task["motion"] for task in tasks]).encode()
    files = {name: hashlib.sha256(data).hexdigest() for name, data in tasks[0]["files"].items()}
    return {
        "over": args.over, "ensemble": args.ensemble, "set": args.set, "step": args.step, "scene": tasks[0]["scene"],
        "motion": hashlib.sha256(motions).hexdigest(), "fmu": hashlib.sha256(fmu).hexdigest(),
    } | ({"files": files} if files else {})


def most_at_once(reports):
    """Workers that wound at the same time, at most: one that is started in place of a dead one is not another."""
    changes = sorted((report[edge], sign) for report in reports for edge, sign in (("ended", -1), ("began", 1)))
    return max(itertools.accumulate((sign for _, sign in changes), initial=0))


def overhead(reports):
    """Median time between two runs of a worker, s: what Dask costs a run. A worker that winds several at once does not tell."""
    of_worker = {}
    for report in reports:
        of_worker.setdefault(report["worker"], []).append((report["began"], report["ended"]))
    between = []
    for runs in of_worker.values():
        times = [b[0] - a[1] for a, b in itertools.pairwise(sorted(runs))]
        between += times if all(time >= 0.0 for time in times) else []
    return statistics.median(between) if between else math.nan


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help="scene file, or the name of a packed scene")
    parser.add_argument("--over", action="append", required=True, metavar="NAME=A:B:N", help="N values from A to B; may be given several times")
    parser.add_argument("--ensemble", type=int, default=1, metavar="K", help="runs a point, with the nozzle moved as in coilwind sweep")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE")
    parser.add_argument("--out", type=Path, default=Path("sweep"), metavar="DIR")
    parser.add_argument("--force", action="store_true", help="overwrite the sweep or the run that DIR holds")
    parser.add_argument("--step", type=float, default=5e-4, metavar="H", help="communication step, s (default: 5e-4)")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a cluster, such as tcp://host:8786 (default: workers on this machine)")
    parser.add_argument("--wait", type=float, default=60.0, metavar="S", help="give up after so long without a worker, s (default: 60)")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), metavar="N", help="without --scheduler (default: all cores)")
    parser.add_argument("--fmu", type=Path, default=folders.FMU)
    parser.add_argument("--quiet", action="store_true", help="no progress and no closing words; only errors, and that workers are missing")
    parser.add_argument("--command", type=Path, default=folders.COMMAND, help=argparse.SUPPRESS)
    args = parser.parse_args()
    with told(parser.prog):
        run(args)


def run(args):
    if args.workers < 1:
        raise Mistake(f"--workers {args.workers} has to be at least 1")
    if not 0.0 < args.wait < math.inf:
        raise Mistake(f"--wait {args.wait:g} has to be above 0 s")
    folders.need(args.command, folders.COMMAND_BUILD)
    folders.need(args.fmu, folders.FMU_BUILD)
    folders.refuse_occupied(args.out, args.force, "another sweep")
    if args.force and args.out.resolve() in Path(args.scene).resolve().parents:
        raise Mistake(f"{args.scene} lies in {args.out}, which --force empties; give another folder with --out")
    names, tasks = tasks_of(args)
    fmu = args.fmu.read_bytes()
    ledger = ledger_of(args.out, names, tasks, plan_of(args, tasks, fmu), args.force)
    fresh = [task for task in tasks if task["run"] not in ledger.rows]
    began, reports = time.monotonic(), []
    if fresh:
        progress = None if args.quiet else Progress("runs", len(tasks), before=len(ledger.rows), logged=True)
        reports = wind_fresh(args, fmu, fresh, ledger, progress)
    if args.quiet:
        return
    took = time.monotonic() - began
    defects, done = ledger.count("defect", "true"), ledger.count("outcome", "done")
    unjudged = ledger.count("judged", "false", outcome="done")
    if unjudged:
        print(
            f"warning: in {unjudged} of {len(tasks)} runs no turn came to rest beside another, so nothing could be compared; "
            "wind more turns with --set spindle.turns=N", file=sys.stderr,
        )
    workers = most_at_once(reports)
    print(
        f"{len(tasks)} runs, {len(fresh)} of them new; {defects} with a defect, {unjudged} not judged, {len(tasks) - done} that failed; "
        f"{took:.1f} s on {workers} worker{'' if workers == 1 else 's'}"
    )
    if reports:
        wound = sum(report["ended"] - report["began"] for report in reports)
        between = overhead(reports)
        more = "" if math.isnan(between) else f" and {1e3 * between:.0f} ms more between runs"
        print(f"a run took {wound / len(reports):.3f} s{more}")
    print(f"tables: {args.out / ROWS}, {args.out / TIMES}")


def wind_fresh(args, fmu, tasks, ledger, progress):
    """The reports of these tasks, whose rows the ledger keeps as they come."""
    reports = []

    def keep(task, report):
        reports.append(report)
        keep_in(ledger, task, report)
        if progress is not None:
            progress.step()

    with cluster_of(args) as client:
        ledger.begin()
        try:
            wind_all(client, fmu, tasks, keep, args.wait)
            ledger.write()
        except (KeyboardInterrupt, Mistake) as stop:
            # A full disk may have room again for what came meanwhile; if not, the table of before stays.
            with contextlib.suppress(Stuck):
                ledger.write()
            kept = f"{ledger.kept} runs are kept; go on with: {same_command()}"
            if isinstance(stop, KeyboardInterrupt):
                raise Interrupted(f"interrupted; {kept}") from None
            raise type(stop)(f"{stop}; {kept}") from None
    return reports


@contextlib.contextmanager
def cluster_of(args):
    """A client of the scheduler that is named, or of processes of this machine."""
    import logging

    import dask
    from distributed import Client, LocalCluster

    # Dask tells of dead workers at length; the runs are wound again all the same.
    for name in ("distributed", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    dask.config.set({"distributed.scheduler.allowed-failures": DEATHS})
    with contextlib.ExitStack() as stack:
        if args.scheduler is None:
            cluster = begun(lambda: LocalCluster(
                n_workers=args.workers, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=logging.CRITICAL,
                preload=[DEAF],
            ))
            stack.callback(cluster.close)
            client = Client(cluster)
        else:
            client = connect(args.scheduler)
        stack.callback(client.close, timeout=ANSWER)
        yield client


def begun(cluster):
    """The workers of this machine. Where one dies as they start, they start again, as often as the worker of a run may die."""
    for _ in range(DEATHS):
        try:
            return cluster()
        except RuntimeError as error:
            died = error
    raise Stuck(f"the workers did not start: {died}; try fewer with --workers")


if __name__ == "__main__":
    main()
