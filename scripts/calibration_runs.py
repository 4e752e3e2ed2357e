"""Runs of a scene as a measurement would see them, for scripts/calibrate.py."""

import json
import subprocess
import tempfile
import threading
import tomllib
from pathlib import Path

import numpy as np

from calibration_curves import TURN, ZERO_REACH, columns
from failure import Mistake
from progress import Progress

# Share of measured heights that has to lie on settled wire.
SETTLED = 0.8
# Share of the run's turns: a curve over less has another unit of the angle (1/57).
FOREIGN_ANGLE = 0.04


class Model:
    """Runs of the scene, as measured."""

    def __init__(self, command, scene, sets, names, curves, folder):
        self.command, self.scene, self.sets = command, scene, sets
        self.names, self.curves, self.folder = names, curves, Path(folder)
        # Files whose angle has an unknown zero. What lies so near to an end of the run that it might be beyond it is left out.
        self.zeros, self.room = [], 0.0
        self.runs, self.progress = 0, Progress("runs")
        self.going, self.stopped, self.lock = set(), False, threading.Lock()
        listed = subprocess.run([command, "variables", "--json"], capture_output=True, text=True, check=True).stdout
        self.table = {row["name"]: row for row in json.loads(listed)}

    def wind(self, values, zeros=()):
        """Computed curves with these values of the parameters, and these zeros (rad) of the files that have one."""
        out, zero = self.run(values), dict(zip(self.zeros, zeros))
        return [self.compare(curve, out, zero.get(curve.source, 0.0)) for curve in self.curves]

    def turned(self, values, zeros):
        """Computed curves as they would be measured with each of these zeros (rad) of the angle."""
        out = self.run(values)
        return [[self.compare(curve, out, zero) for curve in self.curves] for zero in zeros]

    def fit_zeros(self):
        self.zeros, self.room = list(dict.fromkeys(curve.source for curve in self.curves)), ZERO_REACH

    def repeats(self):
        """After which angle (rad) the core looks the same again."""
        core = self.settings()["core"]
        if core["shape"] != "rounded-box":
            return TURN
        return TURN / 4.0 if core["width_x"] == core["height_z"] else TURN / 2.0

    def settings(self):
        """The scene with its settings, as a run leaves it."""
        return tomllib.loads((self.run([]) / "scene.toml").read_text(encoding="utf-8"))

    def value(self, name):
        """What a parameter is in the scene, with its settings."""
        # A setting is taken as it is: the scene may not take it without what is fitted.
        if text := next((text for text in self.sets if text.partition("=")[0].strip() == name), None):
            return float(text.partition("=")[2])
        found = self.settings()
        for key in name.split("."):
            found = found.get(key, {}) if isinstance(found, dict) else {}
        return float(self.table[name]["start"] if found == {} else found)

    def keys_of(self, name):
        """The names under which --set takes this parameter, in whatever unit."""
        return {name, *(f"{name}_{unit}" for unit in self.table[name]["keySuffixes"])}

    def run(self, values):
        """The folder of a run."""
        out = Path(tempfile.mkdtemp(dir=self.folder))
        words = [f"{name}={value!r}" for name, value in zip(self.names, map(float, values))]
        # What is fitted takes the place of its --set, which was its start.
        fitted = {key for name, _ in zip(self.names, values) for key in self.keys_of(name)}
        known = [text for text in self.sets if text.partition("=")[0].strip() not in fitted]
        words = [word for setting in [*known, *words] for word in ("--set", setting)]
        files = ["--no-geometry", "--no-report", "--quiet", "--force", "--out", out]
        code, said = self.start([self.command, "run", self.scene, *words, *files])
        self.runs += 1
        with self.lock:
            if not self.stopped:
                self.progress.step()
        if code:
            reason = (said.strip().splitlines() or ["the run failed"])[0]
            if whole := next((name for name, _ in zip(self.names, values) if name in reason and "not a whole number" in reason), None):
                raise Mistake(f"--fit {whole}: it is counted in whole numbers and cannot be fitted; give it with --set")
            raise Mistake(f"with {', '.join(words[1::2]) or self.scene}: {reason}")
        return out

    def start(self, line):
        """Exit code of a command and what it said. `stop` ends it."""
        with self.lock:
            if self.stopped:
                raise Mistake("stopped")
            # In a session of its own: Ctrl-C on a terminal would have it write its results, which nobody reads.
            child = subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True)
            self.going.add(child)
        try:
            said = child.communicate()[1]
        except BaseException:
            child.kill()
            raise
        with self.lock:
            self.going.remove(child)
        return child.returncode, said

    def stop(self):
        """Ends the runs that go on; none begins after it."""
        with self.lock:
            self.stopped = True
            for child in self.going:
                child.kill()

    def compare(self, curve, out, zero=0.0):
        if curve.quantity == "height":
            angle, values = columns(out / "stations.csv", "angle", "height")
        else:
            column = {"tension": "wire_tension", "coil_width": "coil_width", "resistance": "wire_length"}[curve.quantity]
            angle, values = columns(out / "history.csv", "spindle_angle", column)
            if curve.quantity == "resistance":
                product = json.loads((out / "summary.json").read_text(encoding="utf-8"))["product"]
                if not product["wire_length_m"]:
                    raise Mistake("no wire has settled; wind more turns to compare resistances")
                values = values * product["resistance_ohm"] / product["wire_length_m"]
        angle = np.abs(angle)
        covered = within(curve.angle, angle, self.room)
        # How much wire settles depends on the parameters a little; what has not counts for nothing.
        if np.mean(covered) < (SETTLED if curve.quantity == "height" or self.room else 1.0):
            low, high = (angle[0], angle[-1]) if angle.size else (0.0, 0.0)
            raise Mistake(
                f"{curve.source}: {curve.column} is measured from {curve.angle[0] / TURN:.2f} to {curve.angle[-1] / TURN:.2f} turns, "
                f"{'settled wire of the run goes' if curve.quantity == 'height' else 'the run goes'} from {low / TURN:.2f} to "
                f"{high / TURN:.2f}; wind more with --set spindle.turns=N, or cut the file"
                f"{f'; {np.degrees(self.room):.0f} degrees at either end are left out' if self.room else ''}"
            )
        curve.share = np.ptp(curve.angle) / np.ptp(angle)
        if curve.share < FOREIGN_ANGLE:
            raise Mistake(
                f"{curve.source}: {curve.column} is measured over {np.ptp(curve.angle) / TURN:.3g} of the {np.ptp(angle) / TURN:.3g} turns of the run; "
                "is the angle in the unit of its column (angle_deg, angle_rad, turns)? If so, wind less with --set spindle.turns=N"
            )
        at = curve.angle - zero
        return np.where(covered & within(at, angle), np.interp(at, angle, values), np.nan)


def within(at, angle, room=0.0):
    """Which of these places lie within a run, so far from its ends."""
    return (at >= angle[0] + room - 1e-6) & (at <= angle[-1] - room + 1e-6) if angle.size > 1 else np.zeros(at.size, bool)
