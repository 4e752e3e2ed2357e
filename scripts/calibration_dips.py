"""A wider search for scripts/calibrate.py, where its first one leaves what is no noise.

Curves ring, or follow a parameter in steps, so that the sum of squares has many dips, and a search by slopes ends in the nearest.
Places spread evenly in a box around the best, which halves from round to round, find the others (Halton, Numer. Math. 2, 1960).
"""

import numpy as np

from calibration_curves import rms
from calibration_noise import LEVEL, autocorrelation, chance, from_row_to_row
from calibration_rest import AUTOCORRELATED
from failure import Mistake

# Half the first box, in the logarithms of the parameters: a factor of 3. Rounds, places of a round for each parameter, and how many of
# the best places a search begins at.
BOX, ROUNDS, PLACES, FOLLOWED = np.log(3.0), 4, 12, 3
# What is left, over what rows next to each other differ by, from which on it is looked for another dip.
FAR = 1.5
# A dip is another one where its sum of squares is lower by this share.
LOWER = 1e-3


def is_noise(rest):
    """Whether what is left of a curve may be noise: it does not repeat, and is not far above what rows next to each other differ by."""
    noise = from_row_to_row(rest)
    return chance(rest) > LEVEL and autocorrelation(rest) < AUTOCORRELATED and not rms(rest) > FAR * noise


def deepest(fit, found):
    """The solution, or that of a deeper dip where this one leaves what is no noise."""
    from scipy.stats import qmc

    if all(is_noise(curve.values - values) for curve, values in zip(fit.model.curves, fit.computed([found.x])[0])):
        return found
    count, centre = fit.starts.size, found.x
    spread = qmc.Halton(count, scramble=False)
    # The first of them is a corner.
    spread.fast_forward(1)
    costs, lowest = {}, found.cost
    for turn in range(ROUNDS):
        box = BOX / 2**turn * (2.0 * spread.random(PLACES * count) - 1.0)
        points = [fit.inside(fit.clipped(centre + np.pad(one, (0, fit.size - count)))) for one in box]
        costs |= zip(map(tuple, points), fit.costs(points))
        best = min(costs, key=costs.get)
        if costs[best] < lowest:
            centre, lowest = np.array(best), costs[best]
    places = [np.array(place) for place in sorted(costs, key=costs.get)[:FOLLOWED] if np.isfinite(costs[place])]
    # A dip at an end of the range would be no fit.
    ends = [end for place in places if (end := followed(fit, place)) and fit.is_within(end)]
    end = min(ends, key=lambda one: one.cost, default=found)
    return fit.settle(end) if end.cost < (1.0 - LOWER) * found.cost else found


def followed(fit, place):
    """The solution that a search from a place ends in; `None` where it comes to values that the scene refuses."""
    try:
        return fit.solve(place)
    except Mistake:
        if fit.model.stopped:
            raise
        return None
