#!/usr/bin/env python3
"""A winding machine of four FMUs, run by two masters.

    $(scripts/venv.sh machine) examples/machine/run.py [--fmu target/fmu/CoilWinding.fmu] [--out target/machine]

Packs the drives and the dancer as FMUs with PythonFMU, joins them with the coil in a System Structure (WindingMachine.ssp), and
runs that with fmpy and with libcosim. Leaves machine.csv and machine.png: torque and speed of the spindle, tension of the wire,
and the corners of the core within a turn.
"""

import argparse
import csv
import json
import math
import subprocess
import sys
import zipfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import fmpy
import matplotlib.pyplot as plt
from fmpy.fmi2 import FMU2Slave
from fmpy.ssp.ssd import read_ssd

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
MODELS = {"SpindleDrive": "spindle_drive.py", "TraverseDrive": "traverse_drive.py", "Dancer": "dancer.py"}
STEP = 2e-4
"""Communication step, s."""
STOP = 0.25
"""End of the run, s: three and a half turns."""
SHOWN = (
    ("coil", "wire_tension"),
    ("coil", "spindle_torque_total"),
    ("coil", "spindle_angle"),
    ("coil", "tension_setpoint"),
    ("spindle", "setpoint"),
    ("spindle", "speed"),
    ("spindle", "torque"),
    ("dancer", "position"),
    ("traverse", "position"),
    ("coil", "free_length"),
)
LANDED = 2e-3
"""A free span that is shorter by so much, m, after a step has landed on a corner."""
BOUNCE = 25
"""Steps after a landing within which another one is the same."""


def pack(fmu, out):
    """The archive of the system with the FMUs of its parts."""
    for script in MODELS.values():
        command = [sys.executable, "-m", "pythonfmu", "build", "-f", HERE / script, "-d", out]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    archive = out / "WindingMachine.ssp"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as ssp:
        ssp.write(HERE / "SystemStructure.ssd", "SystemStructure.ssd")
        ssp.write(fmu, "resources/CoilWinding.fmu")
        for model in MODELS:
            ssp.write(out / f"{model}.fmu", f"resources/{model}.fmu")
    return archive


class Part:
    """One FMU of the system."""

    def __init__(self, name, path, folder):
        description = fmpy.read_model_description(path)
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        self.fmu = FMU2Slave(
            guid=description.guid,
            unzipDirectory=fmpy.extract(path, str(folder / name)),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.fmu.instantiate()

    def get(self, name):
        return self.fmu.getReal([self.references[name]])[0]

    def set(self, name, value):
        self.fmu.setReal([self.references[name]], [value])


def by_fmpy(archive, out):
    """Rows of the run by a master that steps all parts side by side (Jacobi), after the connections of the archive."""
    folder = out / "parts"
    with zipfile.ZipFile(archive) as ssp:
        ssp.extractall(folder)
    system = read_ssd(str(archive)).system
    parts = {e.name: Part(e.name, str(folder / e.source), folder) for e in system.elements}

    def transfer():
        # all outputs are read before one of them is handed on
        wires = [(c, parts[c.startElement].get(c.startConnector)) for c in system.connections]
        for wire, value in wires:
            parts[wire.endElement].set(wire.endConnector, value)

    for part in parts.values():
        part.fmu.setupExperiment()
        part.fmu.enterInitializationMode()
    transfer()
    for part in parts.values():
        part.fmu.exitInitializationMode()
    rows = []
    for k in range(round(STOP / STEP)):
        transfer()
        for part in parts.values():
            part.fmu.doStep(k * STEP, STEP)
        rows.append([(k + 1) * STEP, *(parts[part].get(name) for part, name in SHOWN)])
    for part in parts.values():
        part.fmu.terminate()
        part.fmu.freeInstance()
    return rows


BY_LIBCOSIM = """
import json, sys
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver
archive, step, count, shown = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), json.loads(sys.argv[4])
execution = CosimExecution.from_ssp_file(ssp_path=archive, step_size=step)
observer = CosimObserver.create_last_value()
execution.add_observer(observer)
if not execution.step(count):
    raise SystemExit("libcosim did not go on")
slaves = {execution.slave_infos()[i].name.decode(): execution.slave_infos()[i].index for i in range(execution.num_slaves())}
values = []
for part, name, reference in shown:
    values.append(observer.last_real_values(slaves[part], [reference])[0])
# its log goes to the same place
print("values:" + json.dumps(values))
"""


def by_libcosim(archive, out):
    """Last values of the run by libcosim's master, which counts time in ns, in the order of SHOWN. It gets a process of its own,
    as both masters load the parts."""
    shown = []
    for part, name in SHOWN:
        source = {"coil": "CoilWinding", "spindle": "SpindleDrive", "traverse": "TraverseDrive", "dancer": "Dancer"}[part]
        description = fmpy.read_model_description(str(out / "parts/resources" / f"{source}.fmu"))
        shown.append((part, name, {v.name: v.valueReference for v in description.modelVariables}[name]))
    arguments = [str(archive), str(round(1e9 * STEP)), str(round(STOP / STEP)), json.dumps(shown)]
    ran = subprocess.run([sys.executable, "-c", BY_LIBCOSIM, *arguments], capture_output=True, text=True, check=False)
    if ran.returncode:
        sys.exit(f"run.py: libcosim did not run the system\n{ran.stderr[-2000:]}")
    told = next(line for line in ran.stdout.splitlines() if line.startswith("values:"))
    return json.loads(told.removeprefix("values:"))


def plot(rows, path):
    column = {"time": 0} | {f"{part}.{name}": k + 1 for k, (part, name) in enumerate(SHOWN)}
    data = {name: [row[k] for row in rows] for name, k in column.items()}
    angle, free = data["coil.spindle_angle"], data["coil.free_length"]
    # (wire that bounces lands twice)
    landed = [k for k in range(1, len(rows)) if free[k] < free[k - 1] - LANDED]
    landings = [k for before, k in zip([-len(rows), *landed], landed) if k > before + BOUNCE]
    figure, axes = plt.subplots(3, 2, figsize=(11, 8), sharex="col", constrained_layout=True)
    late = [k for k, turned in enumerate(angle) if turned > angle[-1] - math.tau]
    for side, points in enumerate((range(len(rows)), late)):
        across = [1e3 * data["time"][k] if side == 0 else math.degrees(angle[k] - angle[-1]) + 360 for k in points]

        def draw(row, name, label, side=side, points=points, across=across):
            axes[row][side].plot(across, [data[name][k] for k in points], label=label, linewidth=1)

        draw(0, "spindle.torque", "of the drive")
        draw(0, "coil.spindle_torque_total", "of the wire")
        draw(1, "spindle.setpoint", "asked for")
        draw(1, "spindle.speed", "of the spindle")
        draw(2, "coil.wire_tension", "of the wire")
        draw(2, "coil.tension_setpoint", "pull of the dancer")
    for row, label in enumerate(("torque N m", "speed rad/s", "tension N")):
        for k in landings:
            if k in late:
                place = math.degrees(angle[k] - angle[-1]) + 360
                axes[row][1].axvline(place, color="0.6", linestyle="--", linewidth=1, zorder=0)
        axes[row][0].set_ylabel(label)
        axes[row][0].legend(loc="best", fontsize="small")
    axes[0][0].set_title("the whole run")
    axes[0][1].set_title("the last turn; dashed: wire lands on a corner of the core")
    axes[2][0].set_xlabel("time ms")
    axes[2][1].set_xlabel("angle of the core deg")
    axes[2][1].set_xticks(range(0, 361, 90))
    figure.savefig(path, dpi=100)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fmu", type=Path, default=ROOT / "target/fmu/CoilWinding.fmu")
    parser.add_argument("--out", type=Path, default=ROOT / "target/machine")
    arguments = parser.parse_args()
    if not arguments.fmu.is_file():
        sys.exit(f"run.py: {arguments.fmu} is missing; run scripts/build_fmu.sh")
    # URIs of the unpacked FMUs take no path that is relative.
    out = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    archive = pack(arguments.fmu, out)
    rows = by_fmpy(archive, out)
    with open(out / "machine.csv", "w", encoding="ascii", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["time", *(f"{part}.{name}" for part, name in SHOWN)])
        writer.writerows([repr(value) for value in row] for row in rows)
    plot(rows, out / "machine.png")
    last = by_libcosim(archive, out)
    print(f"{'at the end':>30} {'fmpy':>14} {'libcosim':>14}")
    for (part, name), here, there in zip(SHOWN, rows[-1][1:], last):
        print(f"{part + '.' + name:>30} {here:14.8g} {there:14.8g}")
    torque = [row[1 + SHOWN.index(("spindle", "torque"))] for row in rows]
    full = [row for row in rows if row[0] > 0.2]
    speed = [row[1 + SHOWN.index(("spindle", "speed"))] for row in full]
    print(f"largest torque {max(torque):.3f} N m; at full speed it dips to {min(speed):.2f} and rises to {max(speed):.2f} rad/s")
    print(f"{arguments.out / 'machine.png'}, {arguments.out / 'machine.csv'}, {arguments.out / archive.name}")


if __name__ == "__main__":
    main()
