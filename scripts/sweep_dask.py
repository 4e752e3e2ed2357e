#!/usr/bin/env python3
"""Sweeps a scene through the FMU, on a cluster of Dask.

    sweep_dask.py fig8 --over spindle.speed=100:400:4 --ensemble 4 --set spindle.turns=2.5 --out target/speeds
    sweep_dask.py SCENE.toml --over tensioner.tension=5:15:3 --scheduler tcp://HOST:8786

The Python is that of `scripts/venv.sh study`. Without --scheduler the workers are processes of this machine. The FMU and the
scene travel to the workers; they need fmpy and dask, and no coilwind. Each run follows the scene's own motion, as `coilwind
motion` samples it. A run whose worker dies is wound again elsewhere.

DIR gets sweep.csv, a row a run in the order of the grid, the same bytes for any number of workers; and times.csv, which says
where and how long each run was wound.
"""

import argparse
import csv
import hashlib
import io
import itertools
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# Spread of the members' nozzle distance about the scene's, wire diameters, as in `coilwind sweep`.
SPREAD = 0.5
# Deaths of its worker that a run survives.
DEATHS = 10
UNITS = {
    "m": 1.0, "mm": 1e-3, "um": 1e-6, "kg": 1.0, "g": 1e-3, "Pa": 1.0, "MPa": 1e6, "GPa": 1e9,
    "rad": 1.0, "deg": math.pi / 180.0, "rad_per_s": 1.0, "rpm": math.pi / 30.0,
}
# Files of a sweep, this script's first; the others are those of `coilwind sweep`.
FILES = ["sweep.csv", "times.csv", "sweep.json", "ensemble.csv", "map.svg", "map.html"]
COUNTS = ["bulge", "gap", "overlap", "break", "slack"]
RESULTS = [
    "outcome", "reason", "defect", *(f"defects_{kind}" for kind in COUNTS),
    "gap_max_m", "bulge_max_m", "tension_min_N", "tension_max_N", "turns_settled",
]


class Mistake(Exception):
    """What the user can mend, in a line."""


# What workers do. It is sent to them whole, so it imports what it needs.


def unpack(fmu, folder):
    """Unpacks the bytes of an FMU; what `wind` needs of it."""
    import fmpy

    path = Path(folder) / "sweep.fmu"
    path.write_bytes(fmu)
    description = fmpy.read_model_description(str(path))
    return {
        "folder": fmpy.extract(str(path), str(Path(folder) / "fmu")),
        "guid": description.guid,
        "model": description.coSimulation.modelIdentifier,
        "references": {variable.name: variable.valueReference for variable in description.modelVariables},
    }


def wind(fmu, task):
    """One run: its results, and when and how long it was wound."""
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
    with tempfile.TemporaryDirectory() as folder:
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
                slave.setReal([reference["nozzle.distance"]], [get("nozzle.distance") + task["offset"] * get("wire.diameter")])
            slave.exitInitializationMode()
            for row, after in zip(motion, motion[1:]):
                slave.setReal(inputs, row[1:])
                slave.doStep(row[0], after[0] - row[0])
                gap, bulge, least, most = slave.getReal(wanted)
                extremes["gap_width"] = max(extremes["gap_width"], gap)
                extremes["bulge_height"] = max(extremes["bulge_height"], bulge)
                extremes["wire_tension_min"] = min(extremes["wire_tension_min"], least)
                extremes["wire_tension_max"] = max(extremes["wire_tension_max"], most)
        except FMICallException as error:
            result = {"outcome": "failed", "reason": said[0] if said else str(error)}
        values = slave.getInteger([reference[name] for name in counts])
        settled = get("turns_settled")
        slave.freeInstance()
    result["defect"] = str(any(values)).lower()
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
    scene = args.scene
    if Path(scene).is_file():
        scene = Path(scene).read_text(encoding="utf-8") + "\n"
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
        for member in range(args.ensemble):
            offset = SPREAD * (2.0 * member / (args.ensemble - 1) - 1.0) if args.ensemble > 1 else 0.0
            tasks.append({
                "run": len(tasks), "scene": scene, "parameters": dict(start for start in starts if start), "motion": motion,
                "offset": offset, "columns": [*point, member + 1],
            })
    return list(swept), tasks


def plugin_of(fmu):
    """Unpacks the FMU on every worker, also on one that is started in place of a dead one."""
    from distributed import WorkerPlugin

    class Fmu(WorkerPlugin):
        name = f"coilwind-{hashlib.sha256(fmu).hexdigest()[:16]}"

        def setup(self, worker):
            self.folder = tempfile.TemporaryDirectory()
            self.unpacked = unpack(fmu, self.folder.name)

        def teardown(self, worker):
            self.folder.cleanup()

    return Fmu()


def wind_on_worker(plugin, task):
    from distributed import get_worker

    worker = get_worker()
    return {**wind(worker.plugins[plugin].unpacked, task), "worker": worker.address}


def wind_all(client, fmu, tasks, ended=lambda count: None):
    """Winds the tasks on a cluster; their reports in the order of the tasks. `ended` hears how many have ended."""
    from distributed import KilledWorker, as_completed

    plugin = plugin_of(fmu)
    client.register_plugin(plugin)
    futures = {client.submit(wind_on_worker, plugin.name, task, pure=False, retries=2): task["run"] for task in tasks}
    reports = {}
    for future in as_completed(futures):
        try:
            reports[futures[future]] = future.result()
        except KilledWorker:
            result = {name: "" for name in RESULTS} | {"outcome": "failed", "reason": f"its worker died {DEATHS} times"}
            reports[futures[future]] = {"result": result, "began": 0.0, "ended": 0.0, "worker": ""}
        ended(len(reports))
    return [reports[task["run"]] for task in tasks]


def refuse_occupied(folder, force):
    """A mistake where the folder holds a sweep, unless `force` says otherwise."""
    if not force and any((folder / name).exists() for name in FILES):
        raise Mistake(f"{folder} holds another sweep; add --force to overwrite it, or --out for another folder")


def write(folder, names, tasks, reports):
    folder.mkdir(parents=True, exist_ok=True)
    for name in FILES:
        (folder / name).unlink(missing_ok=True)
    with open(folder / "sweep.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([*names, "member", *RESULTS])
        for task, report in zip(tasks, reports):
            writer.writerow([*task["columns"], *(report["result"][name] for name in RESULTS)])
    with open(folder / "times.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["run", "worker", "began", "wound_s"])
        for task, report in zip(tasks, reports):
            writer.writerow([task["run"], report["worker"], report["began"], report["ended"] - report["began"]])


def overhead(reports):
    """Median time between two runs of a worker, s: what Dask costs a run."""
    of_worker = {}
    for report in reports:
        of_worker.setdefault(report["worker"], []).append((report["began"], report["ended"]))
    between = [b[0] - a[1] for runs in of_worker.values() for a, b in itertools.pairwise(sorted(runs))]
    return statistics.median(between) if between else math.nan


class Progress:
    def __init__(self, count, quiet):
        self.count, self.quiet, self.began = count, quiet, time.monotonic()

    def __call__(self, ended):
        if self.quiet:
            return
        took = time.monotonic() - self.began
        left = took / ended * (self.count - ended)
        end = "\n" if ended == self.count or not sys.stderr.isatty() else "\r"
        print(f"{ended} of {self.count} runs, {took:.0f} s, {left:.0f} s left   ", end=end, file=sys.stderr, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help="scene file, or the name of a packed scene")
    parser.add_argument("--over", action="append", required=True, metavar="NAME=A:B:N", help="N values from A to B; may be given several times")
    parser.add_argument("--ensemble", type=int, default=1, metavar="K", help="runs a point, with the nozzle moved as in coilwind sweep")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE")
    parser.add_argument("--out", type=Path, default=Path("sweep"), metavar="DIR")
    parser.add_argument("--force", action="store_true", help="overwrite the sweep that DIR holds")
    parser.add_argument("--step", type=float, default=5e-4, metavar="H", help="communication step, s (default: 5e-4)")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a cluster, such as tcp://host:8786 (default: workers on this machine)")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), metavar="N", help="without --scheduler (default: all cores)")
    parser.add_argument("--fmu", type=Path, default=ROOT / "target/fmu/CoilWinding.fmu")
    parser.add_argument("--quiet", action="store_true")
    parser.add_argument("--command", default=os.environ.get("COILWIND_COMMAND") or str(ROOT / "target/release/coilwind"), help=argparse.SUPPRESS)
    args = parser.parse_args()
    try:
        run(args)
    except Mistake as mistake:
        print(f"sweep_dask.py: {mistake}", file=sys.stderr)
        sys.exit(2)


def run(args):
    import logging

    import dask
    from distributed import Client, LocalCluster

    for path, build in ((Path(args.command), "cargo build --release"), (args.fmu, "scripts/build_fmu.sh")):
        if not path.is_file():
            raise Mistake(f"{path} is missing; build it with {build}")
    refuse_occupied(args.out, args.force)
    names, tasks = tasks_of(args)
    fmu = args.fmu.read_bytes()
    # Dask tells of dead workers at length; the runs are wound again all the same.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    dask.config.set({"distributed.scheduler.allowed-failures": DEATHS})
    cluster = None
    try:
        if args.scheduler is None:
            cluster = LocalCluster(n_workers=args.workers, threads_per_worker=1, processes=True, dashboard_address=None)
        client = Client(cluster or args.scheduler, timeout=5)
    except (OSError, ValueError, TimeoutError) as error:
        raise Mistake(f"--scheduler {args.scheduler}: there is no scheduler ({error}); start one with: dask scheduler") from None
    try:
        began = time.monotonic()
        reports = wind_all(client, fmu, tasks, Progress(len(tasks), args.quiet))
        took = time.monotonic() - began
    finally:
        client.close()
        if cluster is not None:
            cluster.close()
    write(args.out, names, tasks, reports)
    defects = sum(report["result"]["defect"] == "true" for report in reports)
    failed = sum(report["result"]["outcome"] != "done" for report in reports)
    wound = sum(report["ended"] - report["began"] for report in reports)
    workers = len({report["worker"] for report in reports})
    print(f"{len(tasks)} runs, {defects} with a defect, {failed} that failed; {took:.1f} s on {workers} workers")
    between = overhead(reports)
    more = "" if math.isnan(between) else f" and {1e3 * between:.0f} ms more between runs"
    print(f"a run took {wound / len(tasks):.3f} s{more}")
    print(f"tables: {args.out / 'sweep.csv'}, {args.out / 'times.csv'}")


if __name__ == "__main__":
    main()
