#!/usr/bin/env python3
"""Files of the FMI cross check for the FMU: inputs, reference results and options.

    scripts/cross_check.py [--fmu target/fmu/CoilWinding.fmu] [--out target/cross_check]

Writes CoilWinding_in.csv, CoilWinding_ref.csv and CoilWinding_ref.opt. A cross check sets no parameters, so that the scene
is the default one: a ramp to 100 rad/s and a turn and a half. Inputs are held over each step. fmpy computes the reference.
"""

import argparse
import csv
import sys
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave
from signals import duration, winding_signals, write_csv

ROOT = Path(__file__).resolve().parent.parent
SPEED, TURNS, PITCH, STEPS = 100.0, 1.5, 0.7e-3, 250
OUTPUTS = ("wire_tension", "spindle_torque", "spindle_angle", "fed_length", "free_length", "turns_wound", "defect_code")


def reference(fmu, signals, step):
    """Outputs at every communication point, by name."""
    description = fmpy.read_model_description(fmu)
    variables = {v.name: v for v in description.modelVariables}
    slave = FMU2Slave(
        guid=description.guid,
        unzipDirectory=fmpy.extract(fmu),
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="cross_check",
    )
    slave.instantiate()
    inputs = [variables[name].valueReference for name in signals.dtype.names[1:]]

    def values():
        getters = {"Real": slave.getReal, "Integer": slave.getInteger}
        return [getters[variables[name].type]([variables[name].valueReference])[0] for name in OUTPUTS]

    slave.setupExperiment(tolerance=float(description.defaultExperiment.tolerance))
    slave.enterInitializationMode()
    slave.setReal(inputs, list(signals[0])[1:])
    slave.exitInitializationMode()
    rows = [values()]
    for k in range(STEPS):
        slave.setReal(inputs, [float(x) for x in list(signals[k])[1:]])
        slave.doStep(float(signals["time"][k]), step)
        rows.append(values())
    slave.terminate()
    slave.freeInstance()
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fmu", default=ROOT / "target/fmu/CoilWinding.fmu", type=Path)
    parser.add_argument("--out", default=ROOT / "target/cross_check", type=Path)
    arguments = parser.parse_args()
    if not arguments.fmu.is_file():
        sys.exit(f"cross_check.py: {arguments.fmu} is missing; run scripts/build_fmu.sh")
    arguments.out.mkdir(parents=True, exist_ok=True)
    signals = winding_signals(SPEED, TURNS, PITCH, 0.0, STEPS, tension=15.0)
    step = duration(SPEED, TURNS) / STEPS
    write_csv(signals, arguments.out / "CoilWinding_in.csv")
    rows = reference(str(arguments.fmu), signals, step)
    with open(arguments.out / "CoilWinding_ref.csv", "w", encoding="ascii", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["time", *OUTPUTS])
        for time, row in zip(signals["time"], rows):
            writer.writerow([repr(float(time)), *(repr(value) for value in row)])
    options = {"StartTime": 0.0, "StopTime": float(signals["time"][-1]), "StepSize": step, "RelTol": 1e-4}
    text = "".join(f"{name}, {value!r}\n" for name, value in options.items())
    (arguments.out / "CoilWinding_ref.opt").write_text(text, encoding="ascii")
    assert np.ptp([row[0] for row in rows]) > 1.0, "the wire was not wound"
    print(f"{STEPS + 1} points in {arguments.out}")


if __name__ == "__main__":
    main()
