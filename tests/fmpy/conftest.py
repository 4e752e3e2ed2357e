"""The FMU under test and a thin wrapper that keeps its messages."""

import ctypes
import os
import shutil
import subprocess
import sys
from pathlib import Path

import fmpy
import pytest
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)
from fmpy.logging import addLoggerProxy

ROOT = Path(__file__).resolve().parents[2]
# The input signals are those of the demonstration.
sys.path.insert(0, str(ROOT / "scripts"))
FMU = Path(os.environ.get("COILWIND_FMU", ROOT / "target/fmu/CoilWinding.fmu"))
COMMAND = Path(os.environ.get("COILWIND_COMMAND", ROOT / "target/release/coilwind"))

# Importers change the working directory.
STARTED_IN = Path.cwd()

OK, WARNING, DISCARD, ERROR, FATAL = range(5)


def need(stage):
    """Skips a test, with the reason, on machines where its tools cannot be had."""
    words = [ROOT / "scripts/missing_tools.sh", stage]
    said = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    if said:
        pytest.skip(f"{stage}: " + " ".join(said.split()))


def python_of(variable, environment):
    """The Python that an environment variable names, as `scripts/venv.sh ENVIRONMENT` prints it."""
    need("importers")
    path = os.environ.get(variable)
    assert path, f"set {variable} to what scripts/venv.sh {environment} prints"
    return str(STARTED_IN / path)


class Slave:
    """One instance of the FMU; `status` calls return the status, the rest raise on an error."""

    def __init__(self, unzipped, description, name="slave", logging_on=True):
        self.log = []
        self.description = description
        self.variables = {v.name: v for v in description.modelVariables}
        self.fmu = FMU2Slave(
            guid=description.guid,
            unzipDirectory=unzipped,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=name,
        )

        def keep(_environment, instance, status, category, message):
            self.log.append((instance.decode(), status, category.decode(), message.decode()))

        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(keep)
        addLoggerProxy(ctypes.byref(self.callbacks))
        self.fmu.instantiate(callbacks=self.callbacks, loggingOn=logging_on)
        assert self.fmu.component

    def references(self, names):
        return [self.variables[name].valueReference for name in names]

    def set(self, **values):
        """Sets variables by name, with `__` for the dot."""
        for name, value in values.items():
            name = name.replace("__", ".")
            setter = getattr(self.fmu, "set" + self.variables[name].type)
            setter(self.references([name]), [value])

    def get(self, name):
        getter = getattr(self.fmu, "get" + self.variables[name].type)
        return getter(self.references([name]))[0]

    def outputs(self):
        """Every output as a dictionary."""
        return {
            v.name: self.get(v.name)
            for v in self.description.modelVariables
            if v.causality == "output"
        }

    def start(self, start_time=0.0, stop_time=None, inputs=None, **parameters):
        """From instantiated to the first communication point."""
        self.fmu.setupExperiment(startTime=start_time, stopTime=stop_time)
        self.set(**parameters)
        self.fmu.enterInitializationMode()
        self.set(**(inputs or {}))
        self.fmu.exitInitializationMode()

    def reason(self):
        """Text of the last message."""
        return self.log[-1][3]

    def free(self):
        # fmpy unloads the library with its only instance; others may still use it.
        self.fmu.fmi2FreeInstance(self.fmu.component)


@pytest.fixture(scope="session")
def fmu_path():
    assert FMU.is_file(), f"{FMU} is missing: run scripts/build_fmu.sh"
    return str(FMU)


@pytest.fixture(scope="session")
def description(fmu_path):
    return fmpy.read_model_description(fmu_path)


@pytest.fixture(scope="session")
def unzipped(fmu_path, tmp_path_factory):
    # A path that needs percent-encoding, as users have them.
    directory = tmp_path_factory.mktemp("unzipped") / "with space ü"
    fmpy.extract(fmu_path, str(directory))
    yield str(directory)
    shutil.rmtree(directory, ignore_errors=True)


@pytest.fixture
def make_slave(unzipped, description):
    """Makes any number of instances and frees them at the end of the test."""
    slaves = []

    def make(name="slave", **options):
        slaves.append(Slave(unzipped, description, name, **options))
        return slaves[-1]

    yield make
    for slave in slaves:
        slave.free()


@pytest.fixture
def slave(make_slave):
    return make_slave()


@pytest.fixture(scope="session")
def command():
    assert COMMAND.is_file(), f"{COMMAND} is missing: run cargo build --release"
    return str(COMMAND)
