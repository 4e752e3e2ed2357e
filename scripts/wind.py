#!/usr/bin/env python3
"""Winds one coil: the FMU, driven by fmpy along a speed ramp and an angle-synchronous traverse.

    wind.py --speed 500 --out target/demo/500

The FMU leaves history.csv, summary.json, tables, geometry and picture in the directory. Lines on
standard output tell how far it is: simulated time over its end, turns of the spindle, wall time in s.
Exit codes: 0 done, 1 the run failed, 130 interrupted; the files are usable in each case.
"""

import argparse
import math
import signal
import sys
import time
from pathlib import Path

import fmpy
from fmpy.fmi1 import FMICallException
from signals import duration, winding_signals

PITCH = 0.7e-3
"""Traverse per turn of Fig. 8, m."""
TENSION = 15.0
"""Pull of the tensioner in Fig. 8, N."""
STEP_ANGLE = 0.005
"""Core angle per communication step, rad: held speeds jump by 0.3 % of the final one in the ramp."""
PROGRESS_S = 0.5


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/fmu/CoilWinding.fmu"))
    parser.add_argument("--scene", default="fig8", help="scene.file of the FMU")
    parser.add_argument("--speed", type=float, required=True, help="spindle speed, rad/s")
    parser.add_argument("--turns", type=float, default=2.5, help="turns of the spindle")
    parser.add_argument("--out", type=Path, required=True, help="directory of the results")
    arguments = parser.parse_args()

    steps = math.ceil(duration(arguments.speed, arguments.turns) * arguments.speed / STEP_ANGLE)
    signals = winding_signals(arguments.speed, arguments.turns, PITCH, 0.0, steps, TENSION)
    end = float(signals["time"][-1])
    progress = Progress(end)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, progress.stop)

    # From an earlier run, they would pass for results of this one.
    for name in ("summary.json", "history.csv"):
        (arguments.out / name).unlink(missing_ok=True)
    try:
        fmpy.simulate_fmu(
            str(arguments.fmu),
            stop_time=end,
            output_interval=duration(arguments.speed, arguments.turns) / steps,
            start_values={"scene.file": arguments.scene, "output.directory": str(arguments.out)},
            input=signals,
            output=["spindle_angle"],
            step_finished=progress.step_finished,
            debug_logging=True,
            logger=log,
        )
    except FMICallException:
        # The FMU has given its reason through the logger.
        sys.exit(1)
    sys.exit(130 if progress.stopped else 0)


class Progress:
    """Tells how far the run is, and stops it when a signal came."""

    def __init__(self, end):
        self.end = end
        self.began = self.told = time.monotonic()
        self.stopped = False

    def stop(self, _number, _frame):
        self.stopped = True

    def step_finished(self, reached, recorder):
        """fmpy calls this after every step; False ends the run."""
        now = time.monotonic()
        if now - self.told >= PROGRESS_S or reached >= self.end:
            self.told = now
            turns = recorder.rows[-1][1] / (2 * math.pi)
            print(f"{reached / self.end:.5f} {turns:.4f} {now - self.began:.1f}", flush=True)
        return not self.stopped


def log(_environment, _instance, status, category, message):
    """Turns and defects, warnings and errors, on standard error."""
    category, message = category.decode(), message.decode()
    if status > 0 or category == "logEvents":
        print(message, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
