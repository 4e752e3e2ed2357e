"""Whether the zero of a measured angle may lie beyond those that scripts/calibrate.py fits.

Curves ring, so that a zero within reach may take one ringing for another, at parameters that are wrong. Zeros beyond are looked at from
the runs round the solution, with the parameters that would suit each of them as far as slopes tell. What looks good is wound.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from calibration_curves import TURN, ZERO_REACH
from calibration_fit import DIFFERENCE, REACH
from calibration_noise import LEVEL, autocorrelation
from failure import Mistake

# Of the values of a file that the fit counts: a zero that leaves fewer to compare tells nothing.
COMPARED = 0.5
# How often parameters are moved to where slopes lead, and how far around (degrees) the zero is then looked for again.
ROUNDS, AROUND = 2, 3


@dataclass
class Beyond:
    """A zero (rad) out of reach that explains a file better than the fitted one, or as well within noise."""

    source: Path
    zero: float
    better: bool
    # after which angle the core looks the same again, rad
    repeats: float

    def warning(self):
        zero, again = np.degrees(self.zero), self.repeats / TURN
        return (
            f"the zero of {self.source} may lie beyond {np.degrees(ZERO_REACH):.0f} deg, near {zero:.0f} deg"
            f"{f' or {again:g} of a turn from there' if again < 1.0 else ''}: that fits {'better' if self.better else 'as well, within noise'}, "
            f"and fitted values and intervals may be wrong; take {zero:.0f} deg from the angles of that file and fit again"
        )


class Look:
    """Runs at these logarithms of the parameters and beside them, over a file with each of these zeros (rad)."""

    def __init__(self, fit, logs, zeros):
        self.fit, self.logs = fit, logs
        steps = [sign * step for step in DIFFERENCE * np.eye(logs.size) for sign in (1, -1)]
        values = [fit.values(logs + step) for step in (0.0 * logs, *steps)]
        self.runs = list(fit.pool.map(lambda one: fit.model.turned(one, zeros), values))

    def rest(self, source, place):
        """Residuals of a file with the zero at this place, NaN without a run to compare, and a column of slopes for each parameter."""
        middle, *sides = [self.left(source, run[place]) for run in self.runs]
        return middle, np.column_stack([(high - low) / (2 * DIFFERENCE) for high, low in zip(sides[::2], sides[1::2])])

    def left(self, source, computed):
        curves = zip(self.fit.model.curves, computed)
        return np.concatenate([(values - curve.values) / curve.sigma for curve, values in curves if curve.source == source])


def suited(middle, slopes):
    """Where slopes lead from here, and what is left there."""
    rows = np.isfinite(middle) & np.all(np.isfinite(slopes), axis=1)
    step = -np.linalg.lstsq(slopes[rows], middle[rows], rcond=None)[0]
    return step, middle + slopes @ step


def worse_by(within, beyond):
    """By how much one rest is less likely than another, twice the logarithm of the likelihood, over the values that both have."""
    rows = np.isfinite(within) & np.isfinite(beyond)
    if rows.sum() < COMPARED * np.isfinite(within).sum():
        return np.inf
    # Noise that correlates along the curve counts for fewer values.
    share = max(autocorrelation(within[rows]), 0.0)
    own = rows.sum() * (1.0 - share) / (1.0 + share)
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(own * np.log(np.sum(beyond[rows] ** 2) / np.sum(within[rows] ** 2)))


def beyond_reach(fit, answer):
    """A zero out of reach for each file that has one which fits better than the fitted one, or as well within noise."""
    if not fit.model.zeros:
        return []
    try:
        return list(found(fit, answer))
    except Mistake:
        if fit.model.stopped:
            raise
        # The scene refuses values beside the solution: there is no telling.
        return []


def found(fit, answer):
    from scipy import stats

    logs, fitted = np.array(answer.found.x[: fit.starts.size]), fit.zeros(answer.found.x)
    repeats, reach = fit.model.repeats(), np.degrees(ZERO_REACH)
    far = np.radians([zero for zero in np.arange(-np.degrees(repeats) // 2, np.degrees(repeats) // 2 + 1.0) if abs(zero) > reach])
    look = Look(fit, logs, [*fitted, *far])
    enough = stats.chi2.isf(LEVEL, 1)
    for place, source in enumerate(fit.model.zeros):
        _, within = suited(*look.rest(source, place))
        others = [suited(*look.rest(source, fitted.size + one)) for one in range(far.size)]
        worse = [worse_by(within, left) for _, left in others]
        best = int(np.argmin(worse))
        if not worse[best] < enough:
            continue
        zero, there, wound = far[best], logs + others[best][0], np.inf
        for _ in range(ROUNDS):
            there = np.clip(there, -np.log(REACH), np.log(REACH))
            zeros = [one for one in zero + np.radians(np.arange(-AROUND, AROUND + 1)) if abs(one) > ZERO_REACH]
            closer = Look(fit, there, zeros)
            rests = [closer.rest(source, one) for one in range(len(zeros))]
            left = [worse_by(within, middle) for middle, _ in rests]
            wound = min(wound, *left)
            zero, step = zeros[int(np.argmin(left))], suited(*rests[int(np.argmin(left))])[0]
            there = there + step
        if wound < enough:
            yield Beyond(source, float(zero), wound < -enough, repeats)
