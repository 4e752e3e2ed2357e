"""What a fit leaves of a curve, and what that tells of the measurement, for scripts/calibrate.py."""

from dataclasses import dataclass

import numpy as np

from calibration_curves import Curve, rms
from calibration_noise import LEVEL, autocorrelation, chance, chance_of_mean, chance_of_turn

# Of 1: above it, residuals may be no noise although a slow sensor could make them.
AUTOCORRELATED = 0.5
# Share of the run's turns: a curve over less is told of.
SHORT = 0.25
# What to look at where a measured quantity lies off as a whole.
REMEDIES = {
    "tension": "check zero and scale of the sensor, and that tensioner.tension is what was set; or fit that too",
    "coil_width": "check where the width is measured from, and wire.enamelled_diameter",
    "height": "check where the height is measured from, and the size of the core",
    "resistance": "check leads and temperature, and wire.diameter",
}


@dataclass
class Rest:
    """Measured less fitted values of a curve, with the chances that noise is like that."""

    curve: Curve
    values: np.ndarray
    along: float
    repeats: float
    mean: float
    # of a turn of the angle, and the zero (rad) by which it is explained best
    turn: float
    zero: float

    @property
    def doubtful(self):
        """Whether it is no noise, so that values and intervals may be wrong."""
        return min(self.repeats, self.mean, self.turn) < LEVEL

    def record(self):
        """As it is kept, in the unit of the curve."""
        unit = self.curve.unit
        return {
            "rms": rms(self.values) / unit, "mean": float(np.nanmean(self.values)) / unit, "autocorrelation": self.along,
            "chances_of_noise": {"repeats": self.repeats, "mean": self.mean, "turned": self.turn}, "doubtful": self.doubtful,
        }

    def warnings(self):
        curve, wrong = self.curve, "fitted values and intervals may be wrong"
        if self.turn < LEVEL:
            yield (
                f"{curve.column} looks as if its angle were some {abs(np.degrees(self.zero)):.0f} deg too {'large' if self.zero > 0.0 else 'small'} "
                f"(noise does so with a chance of {self.turn:.1g}), and {wrong}: check where the angle is zero, or fit that with --fit-angle-zero; "
                "where it is right, the search has ended beside the best values: begin at others with --fit NAME=START"
            )
        if self.repeats < LEVEL:
            yield (
                f"what is left of {curve.column} is no noise, it repeats along the angle (noise does so with a chance of {self.repeats:.1g}): "
                f"the scene differs from the machine in something else, or its angle is off by more than 15 deg, and {wrong}; see residuals.png"
            )
        elif self.along > AUTOCORRELATED:
            yield (
                f"what is left of {curve.column} correlates from row to row ({self.along:.2f}): it is no noise, or that of a slow sensor; "
                "if the scene differs from the machine in something else, the intervals may be too narrow"
            )
        if self.mean < LEVEL:
            off, unit = np.nanmean(self.values) / curve.unit, curve.column.rpartition("_")[2]
            yield (
                f"measured {curve.column} is {abs(off):.3g} {unit} {'above' if off > 0.0 else 'below'} the fit on average "
                f"(noise lies so far off with a chance of {self.mean:.1g}), and {wrong}: {REMEDIES[curve.quantity]}"
            )
        if curve.share < SHORT:
            yield f"{curve.column} is measured over {curve.share:.0%} of the turns of the run: see that the angle is in the unit of its column"


def rests_of(curves, computed, slopes=None, zeros=(), turned=()):
    """The rest of each curve. `slopes` are what parameters change of all curves, `turned` the curves computed with each of these zeros."""
    ends = np.cumsum([curve.angle.size for curve in curves])[:-1]
    for place, (curve, values) in enumerate(zip(curves, computed)):
        rest = curve.values - values
        turn, best = 1.0, 0
        if turned:
            turn, best = chance_of_turn(rest, np.split(slopes, ends)[place], [run[place] - values for run in turned])
        yield Rest(curve, rest, autocorrelation(rest), chance(rest), chance_of_mean(rest), turn, float(zeros[best]) if len(zeros) else 0.0)
