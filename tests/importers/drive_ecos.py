"""Winds with Ecos: `drive_ecos.py FMU RESULT.json`; one object per step."""

import ctypes
import json
import sys
from pathlib import Path

from short_wind import OUTPUTS, SCENE, STEP, STEPS, as_text, inputs_at


def load_tbb():
    """Ecos links against oneTBB, which comes as a package of its own, in the environment's lib."""
    if sys.platform == "linux":
        ctypes.CDLL(str(Path(sys.prefix) / "lib" / "libtbb.so.12"), mode=ctypes.RTLD_GLOBAL)


def main(fmu, result):
    load_tbb()
    from ecospy import EcosSimulation, EcosSimulationStructure

    with EcosSimulationStructure() as structure:
        structure.add_model("winder", fmu)
        structure.add_parameter_set("start", {"winder::scene.file": SCENE})
        with EcosSimulation(structure=structure, step_size=STEP) as simulation:
            if not simulation.init(0, "start"):
                raise SystemExit("the simulation did not start")
            rows = []
            for k in range(STEPS):
                for name, value in inputs_at(k).items():
                    simulation.set_real(f"winder::{name}", value)
                simulation.step()
                rows.append({
                    name: as_text(simulation.get_real(f"winder::{name}")) for name in OUTPUTS
                })
            simulation.terminate()
    Path(result).write_text(json.dumps(rows))


main(*sys.argv[1:])
