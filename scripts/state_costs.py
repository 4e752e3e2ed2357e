#!/usr/bin/env python3
"""What states and directional derivatives cost on the way through a long wind, as a master sees it.

    $(scripts/venv.sh) scripts/state_costs.py [--fmu target/fmu/CoilWinding.fmu] [--turns 100]

Winds the wire of fig8 on a core of 160 mm length at 500 rad/s. Prints a table in Markdown: CPU times, medians over 20
steps, and the memory that a state of each step needs beside that of the step before.
"""

import argparse
import math
import tempfile
import time
from pathlib import Path
from statistics import median

import fmpy
from fmpy.fmi2 import FMU2Slave

ROOT = Path(__file__).resolve().parents[1]
SPEED, STEP, PITCH = 500.0, 1e-3, 0.75e-3
"""Of the core, rad/s; of communication, s; of the coil, m."""
SCENE = {"core.length_y": 0.16, "start.clamp_y": -0.07, "nozzle.y_start": -0.07}
STEPS = 20
"""Over which a row is measured, one after the other."""
COLUMNS = ("turns", "bytes kB", "to bytes ms", "from bytes ms", "get ms", "set ms", "memory MB", "step ms", "derivative ms")


def spent(call, times):
    """The result of a call, whose CPU time in ms joins `times`."""
    began = time.thread_time()
    result = call()
    times.append(1e3 * (time.thread_time() - began))
    return result


def resident():
    """Resident memory, MB."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * 4096 / 2**20


def costs(fmu, reference, step, kept):
    """A row of the table, measured over the next steps. Their states join those that are kept, so that none takes the memory of
    another one."""
    save, load, get, put, steps, slopes = [], [], [], [], [], []
    unknowns, knowns = [reference["wire_tension"]], [reference["tension_setpoint"]]
    states, before = [], resident()
    for _ in range(STEPS):
        spent(step, steps)
        states.append(spent(fmu.getFMUstate, get))
    memory = (resident() - before) / STEPS
    for state in states:
        spent(lambda: fmu.setFMUstate(state), put)
        spent(lambda: fmu.getDirectionalDerivative(unknowns, knowns, [1.0]), slopes)
    for state in states[-5:]:
        data = spent(lambda: fmu.serializeFMUstate(state), save)
        fmu.freeFMUstate(spent(lambda: fmu.deSerializeFMUstate(data), load))
    kept += states
    return len(data) / 1024, median(save), median(load), median(get), median(put), memory, median(steps), median(slopes)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fmu", default=str(ROOT / "target/fmu/CoilWinding.fmu"))
    parser.add_argument("--turns", type=float, default=100.0)
    arguments = parser.parse_args()
    description = fmpy.read_model_description(arguments.fmu)
    reference = {v.name: v.valueReference for v in description.modelVariables}
    with tempfile.TemporaryDirectory() as folder:
        fmu = FMU2Slave(
            guid=description.guid, unzipDirectory=fmpy.extract(arguments.fmu, folder),
            modelIdentifier=description.coSimulation.modelIdentifier, instanceName="winder",
        )
        fmu.instantiate()
        fmu.setString([reference["scene.file"]], ["fig8"])
        fmu.setReal([reference[name] for name in SCENE], list(SCENE.values()))
        fmu.setupExperiment()
        fmu.enterInitializationMode()
        fmu.exitInitializationMode()
        print("| " + " | ".join(COLUMNS) + " |\n" + "|---:" * len(COLUMNS) + "|")
        inputs = [reference["spindle_speed"], reference["nozzle_position"]]
        steps, angle = 0, 0.0

        def step():
            nonlocal steps, angle
            speed = min(SPEED, 50.0 * (steps + 0.5))
            angle += speed * STEP
            fmu.setReal(inputs, [speed, SCENE["nozzle.y_start"] + PITCH * angle / math.tau])
            fmu.doStep(steps * STEP, STEP)
            steps += 1
            return fmu.getReal([reference["turns_wound"]])[0]

        kept = []
        for _ in range(20):
            step()
        # work space is taken once
        costs(fmu, reference, step, kept)
        goal = 1.0
        while goal <= arguments.turns:
            turns = 0.0
            while turns < goal:
                turns = step()
            row = costs(fmu, reference, step, kept)
            print(f"| {turns:.0f} | " + " | ".join(f"{value:.3g}" for value in row) + " |", flush=True)
            goal *= 10.0
        for state in kept:
            fmu.freeFMUstate(state)
        fmu.terminate()
        fmu.freeInstance()


main()
