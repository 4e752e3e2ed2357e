"""Winds with libcosim: `drive_libcosim.py FMU RESULT.json`; one object per step."""

import json
import sys
from pathlib import Path

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave
from short_wind import OUTPUTS, SCENE, STEP, STEPS, as_text, inputs_at


def main(fmu, result):
    # libcosim counts nanoseconds.
    execution = CosimExecution.from_step_size(step_size=round(STEP * 1e9))
    slave = execution.add_local_slave(CosimLocalSlave(fmu_path=fmu, instance_name="winder"))
    references = {
        variable.name.decode(): variable.reference for variable in execution.slave_variables(slave)
    }
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer=observer)
    manipulator = CosimManipulator.create_override()
    execution.add_manipulator(manipulator=manipulator)
    if not execution.string_initial_value(slave, references["scene.file"], SCENE):
        raise SystemExit("scene.file was not taken")
    rows = []
    for k in range(STEPS):
        inputs = inputs_at(k)
        if not manipulator.slave_real_values(
            slave, [references[name] for name in inputs], list(inputs.values())
        ):
            raise SystemExit(f"step {k}: inputs were not taken")
        if not execution.step():
            raise SystemExit(f"step {k} failed: {execution.status()}")
        values = observer.last_real_values(slave, [references[name] for name in OUTPUTS])
        rows.append({name: as_text(value) for name, value in zip(OUTPUTS, values)})
    Path(result).write_text(json.dumps(rows))


main(*sys.argv[1:])
