"""The FMU as a machine that a controller talks to: set inputs, step, read outputs. Used by control.py."""

import tempfile

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave

INPUTS = ["spindle_speed", "nozzle_position", "tension_setpoint"]


class Winder:
    """One winding run in steps of `step` s."""

    unpacked = {}

    def __init__(self, fmu, scene, step, inputs):
        if fmu not in self.unpacked:
            self.unpacked[fmu] = tempfile.TemporaryDirectory()
            fmpy.extract(fmu, self.unpacked[fmu].name)
        description = fmpy.read_model_description(fmu)
        self.reference = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.type = {variable.name: variable.type for variable in description.modelVariables}
        self.step, self.time = step, 0.0
        self.fmu = FMU2Slave(
            guid=description.guid, unzipDirectory=self.unpacked[fmu].name,
            modelIdentifier=description.coSimulation.modelIdentifier, instanceName="winder",
        )
        self.fmu.instantiate()
        for name, value in scene.items():
            put = self.fmu.setString if isinstance(value, str) else self.fmu.setReal
            put([self.reference[name]], [value])
        self.fmu.setupExperiment(startTime=0.0)
        self.set(inputs)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def set(self, inputs):
        self.fmu.setReal([self.reference[name] for name in INPUTS], [float(value) for value in inputs])

    def get(self, *names):
        read = {"Real": self.fmu.getReal, "Integer": self.fmu.getInteger}
        return [read[self.type[name]]([self.reference[name]])[0] for name in names]

    def advance(self, inputs):
        """A step with these inputs."""
        self.set(inputs)
        self.fmu.doStep(self.time, self.step)
        self.time += self.step

    def close(self):
        self.fmu.freeInstance()


def wind(fmu, scene, step, turns, law, outputs):
    """Winds with `law(angle, time, read)` for the inputs of the next step; the outputs after each step, by name."""
    winder = Winder(fmu, scene, step, law(0.0, 0.0, {name: 0.0 for name in outputs}))
    rows = []
    try:
        read = dict(zip(outputs, winder.get(*outputs)))
        while read["spindle_angle"] < 2.0 * np.pi * turns:
            winder.advance(law(read["spindle_angle"], winder.time, read))
            read = dict(zip(outputs, winder.get(*outputs)))
            rows.append([winder.time, *read.values()])
    finally:
        winder.close()
    return dict(zip(["time", *outputs], np.array(rows).T))
