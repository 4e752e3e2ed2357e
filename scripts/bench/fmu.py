"""The FMU in fmpy's master against `coilwind run --inputs`: the same scene, samples and communication grid."""

import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import fmpy

# the signals of the demonstration
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from signals import duration, winding_signals, write_csv  # noqa: E402

SPEED = 300.0
PITCH = 0.7e-3
TENSION = 15.0
# communication steps a turn: the demonstration's 0.005 rad
STEPS = 1257


def compare(command, fmu, quick):
    """CPU seconds of both (medians), whether both end with the same fed length, and what was run."""
    turns = 0.25 if quick else 2.5
    steps = round(STEPS * turns)
    signals = winding_signals(SPEED, turns, PITCH, 0.0, steps, TENSION)
    size = duration(SPEED, turns) / steps
    description = fmpy.read_model_description(str(fmu))
    driven, native, same = [], [], True
    with tempfile.TemporaryDirectory() as folder:
        unzipped = fmpy.extract(str(fmu), str(Path(folder) / "fmu"))
        inputs = Path(folder) / "inputs.csv"
        write_csv(signals, inputs)
        words = [command, "run", "fig8", "--inputs", inputs, "--step", repr(size), "--force", "--out", folder]
        for _ in range(1 if quick else 5):
            began = time.process_time()
            result = fmpy.simulate_fmu(
                unzipped,
                model_description=description,
                stop_time=float(signals["time"][-1]),
                output_interval=size,
                start_values={"scene.file": "fig8"},
                input=signals,
                output=["wire_tension", "fed_length", "defect_code"],
            )
            driven.append(time.process_time() - began)
            began = resource.getrusage(resource.RUSAGE_CHILDREN)
            subprocess.run([*words, "--no-geometry", "--quiet"], check=True)
            ended = resource.getrusage(resource.RUSAGE_CHILDREN)
            native.append(ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime)
            same &= float(result["fed_length"][-1]) == last_of(Path(folder) / "history.csv", "fed_length")
    return {
        "scene": "fig8",
        "omega": SPEED,
        "turns": turns,
        "communication_steps": steps,
        "fmu_cpu_s": statistics.median(driven),
        "native_cpu_s": statistics.median(native),
        "same_fed_length": same,
    }


def last_of(table, column):
    lines = table.read_text(encoding="utf-8").splitlines()
    return float(lines[-1].split(",")[lines[0].split(",").index(column)])
