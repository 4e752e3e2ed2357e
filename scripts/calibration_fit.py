"""Least squares over the parameters of a scene, for scripts/calibrate.py."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

import response_surface as surfaces
from calibration_curves import LEAST, ZERO_REACH, check_levels, rms, too_few
from calibration_dips import deepest
from calibration_noise import autocorrelation
from calibration_rest import AUTOCORRELATED
from failure import Mistake

# Differences of the logarithm of a parameter, both ways: large against what a run's adaptive steps scatter by.
DIFFERENCE = 0.03
# How far around a solution is looked for a better one, in the logarithms, and how often.
LOOKS = (0.01, 0.03, 0.06)
ROUNDS = 4
# How often the axes of a response surface are halved where the scene refuses their ends.
HALVINGS = 4
# A parameter may go as far from its start, as a factor.
REACH = 10.0
# Of the way there, in the logarithm: from here on it is at the end of its range.
NEAR = 0.99
# A zero of an angle (rad) for 1 of what a logarithm is for a parameter.
ZERO = ZERO_REACH / np.log(REACH)
# The zeros of an angle that are looked at: each whole degree within reach.
ANGLES = np.radians(np.arange(-14.0, 15.0))
# By how many variances of a residual the runs at the minimum of a response surface may be worse than at another place: they scatter by a few.
WORSE = 10.0
# By how many of them a run is worse at the end of an interval of 95 %.
AS_GOOD = 4.0
# How far beyond an end of an interval it is looked first, and by how much farther next, as factors. Ends found so are that much too near at most.
BEYOND, FARTHER = 1.5, 1.5
# Parameters of which a scene takes the first only where it is at least the second, and what rounding may take from their room.
ORDERED = [("friction.static", "friction.kinetic")]
ROUNDING = 1e-9
# Of 1: above it, two parameters cannot be told apart.
CORRELATED = 0.95
# Of the sum of squares: less than this is no gain over the start.
GAIN = 0.01
# Rest over variation of a curve from which on a solution is none; one that hardly varies counts as varying by this share of its level.
FAR_MORE, LEVEL = 3.0, 0.1


class Fit:
    """Least squares over the logarithms of the parameters, relative to where they start.

    Zeros of angles, where they are fitted, follow the parameters, in units that give them the same range.
    """

    def __init__(self, model, starts, threads):
        self.model, self.starts = model, np.array(starts)
        self.pool = ThreadPoolExecutor(threads)
        self.seen, self.limits = {}, limits_of(model, starts)
        self.size = len(starts) + len(model.zeros)

    def computed(self, points):
        """Curves at several points at once."""
        keys = [tuple(self.inside(point)) for point in points]
        fresh = [key for key in dict.fromkeys(keys) if key not in self.seen]
        # Kept as they come, so that a fit that is stopped has them.
        for key in self.pool.map(self.look, fresh):
            assert key in self.seen
        return [self.seen[key] for key in keys]

    def look(self, key):
        self.seen[key] = self.model.wind(self.values(key), self.zeros(key))
        return key

    def inside(self, point):
        """The nearest point that a scene takes: a search and its differences step over the line where they do not know of it."""
        point = np.array(point)
        for slope, room in self.limits:
            over = slope @ point[: slope.size] - room
            point[: slope.size] -= max(over, 0.0) * slope / (slope @ slope)
        return point

    def values(self, point):
        """The parameters at a point."""
        return self.starts * np.exp(self.inside(point)[: self.starts.size])

    def zeros(self, point):
        """The zeros of angles (rad) at a point."""
        return ZERO * np.array(point[self.starts.size :])

    def stop(self):
        """Ends the runs that go on, and waits for their end."""
        self.model.stop()
        self.pool.shutdown(cancel_futures=True)

    def best(self):
        """The best point so far and its curves; `None` before the first run has ended."""
        return min(self.seen.items(), key=lambda item: np.sum(self.weighed(item[1]) ** 2), default=None)

    def weighed(self, computed, missing=0.0):
        """Residuals by their noise; `missing` where a curve has no settled wire to compare with."""
        pieces = [np.nan_to_num((values - curve.values) / curve.sigma, nan=missing) for curve, values in zip(self.model.curves, computed)]
        return np.concatenate(pieces)

    def clipped(self, point):
        """The nearest point within the range of the parameters."""
        return np.clip(point, -np.log(REACH), np.log(REACH))

    def costs(self, points):
        """Half the sums of squares at several points at once; infinite where a scene refuses it."""

        def cost(point):
            try:
                self.look(tuple(self.inside(point)))
            except Mistake:
                if self.model.stopped:
                    raise
                return np.inf
            return 0.5 * np.sum(self.residuals(point) ** 2)

        return list(self.pool.map(cost, points))

    def residuals(self, point):
        return self.weighed(self.computed([point])[0])

    def jacobian(self, point):
        middle = self.inside(point)
        steps = DIFFERENCE * np.eye(len(middle))
        points = [self.inside(middle + sign * step) for step in steps for sign in (1, -1)]
        found = [self.weighed(computed) - self.residuals(middle) for computed in self.computed(points)]
        # Central differences, except where a step ends at a limit of the scene.
        return np.linalg.lstsq(np.array(points) - middle, np.array(found), rcond=None)[0].T

    def surface(self, centre, axes):
        """The response surface round a point, along axes that are shortened where the range or the scene ends."""
        room = np.log(REACH) - np.abs(centre)
        with np.errstate(divide="ignore"):
            axes = axes * np.minimum(1.0, np.min(room[:, None] / np.abs(axes), axis=0))
        for attempt in range(HALVINGS + 1):
            try:
                inside = self.inside if self.limits else None
                return surfaces.surface(lambda points: [self.weighed(computed, np.nan) for computed in self.computed(points)], centre, axes, inside)
            except Mistake:
                if self.model.stopped or attempt == HALVINGS:
                    raise
                axes = axes / 2.0

    def solve(self, point):
        from scipy import optimize

        reach = np.log(REACH)
        found = optimize.least_squares(
            self.residuals, point, self.jacobian, bounds=(-reach, reach), xtol=2e-3, ftol=1e-5, gtol=1e-10, max_nfev=25
        )
        found.x = self.inside(found.x)
        return found

    def is_within(self, found):
        """Whether a solution lies within the range of the parameters, and not at an end of it."""
        return not ends_of(found.x, found)

    def find(self):
        """A solution. Where zeros of angles are looked for, the best of those that a look at all of them leads to."""
        found = self.settle(self.solve(self.aligned(np.zeros(self.size))))
        for _ in range(ROUNDS if self.model.zeros else 0):
            other = self.solve(self.aligned(found.x))
            if other.cost > (1.0 - 1e-3) * found.cost:
                break
            found = self.settle(other)
        return found

    def aligned(self, point):
        """The point with zeros of angles at which the parameters, as far as their slopes tell, leave least of each file.

        Curves ring, so that the sum of squares has a dip for each ringing that is taken for another.
        """
        if not self.model.zeros:
            return point
        steps = DIFFERENCE * np.eye(self.starts.size)
        logs = point[: self.starts.size]
        values = [self.values(logs + by) for by in (0.0 * logs, *(sign * step for step in steps for sign in (1, -1)))]
        turned = list(self.pool.map(lambda one: self.model.turned(one, ANGLES), values))
        left = np.zeros((len(self.model.zeros), ANGLES.size))
        for k, source in enumerate(self.model.zeros):
            for place in range(ANGLES.size):
                middle, *sides = [self.of_file(source, run[place]) for run in turned]
                slopes = np.column_stack([(high - low) / (2 * DIFFERENCE) for high, low in zip(sides[::2], sides[1::2])])
                left[k, place] = np.sum((middle - slopes @ np.linalg.lstsq(slopes, middle, rcond=None)[0]) ** 2)
        return np.concatenate([logs, ANGLES[np.argmin(left, axis=1)] / ZERO])

    def of_file(self, source, computed):
        """Residuals of the curves of a file by their noise."""
        curves = zip(self.model.curves, computed)
        return np.concatenate([np.nan_to_num((values - curve.values) / curve.sigma) for curve, values in curves if curve.source == source])

    def settle(self, found):
        """Looks past the dips that ringing and adaptive steps leave in the sum of squares: along the axes of the valley."""
        for _ in range(ROUNDS):
            _, axes = np.linalg.eigh(found.jac.T @ found.jac)
            points = [found.x + reach * sign * axis for axis in axes.T for reach in LOOKS for sign in (1, -1)]
            points = [self.clipped(point) for point in points]
            costs = [0.5 * np.sum(self.weighed(computed) ** 2) for computed in self.computed(points)]
            best = int(np.argmin(costs))
            if costs[best] > (1.0 - 1e-3) * found.cost:
                break
            found = self.solve(points[best])
        return found


def limits_of(model, starts):
    """What a scene asks of its parameters, as slope and room: the slope times the logarithms has to stay below the room."""
    limits = []
    for high, low in ORDERED:
        if high not in model.names and low not in model.names:
            continue
        of = dict(zip(model.names, starts))
        above, below = (of[name] if name in of else model.value(name) for name in (high, low))
        if above < below:
            fitted = high if high in of else low
            raise Mistake(
                f"{high} starts from {above:g}, below {low}, which is {below:g}: no scene takes that; "
                f"start {'above' if fitted == high else 'below'} the other with --fit {fitted}=VALUE"
            )
        if below > 0.0:
            slope = np.array([(name == low) - (name == high) for name in model.names], float)
            limits.append((slope, np.log(above / below) - ROUNDING))
    return limits


@dataclass
class Solution:
    """Where a response surface is lowest: the logarithms, which of them are at an end, and whether the search before it converged."""

    x: np.ndarray
    active_mask: np.ndarray
    success: bool


@dataclass
class Answer:
    """What a fit says: the solution, and standard deviations and correlations of the logarithms."""

    found: object
    deviation: np.ndarray
    correlation: np.ndarray
    freedom: int
    computed: list
    # sum of squares of the weighed residuals
    square: float
    # that at the start over that at the solution
    gain: float = 1.0
    # what a parameter changes of the weighed residuals, a column each
    slopes: np.ndarray | None = None
    # how far intervals go at least, below and above the solution
    least: np.ndarray | float = 0.0


def calibrate(fit):
    model, parameters = fit.model, fit.size
    start = fit.computed([np.zeros(parameters)])[0]
    check_levels(model.curves, start)
    if (points := sum(curve.angle.size for curve in model.curves)) < LEAST * parameters:
        raise too_few(points, parameters)
    for curve in model.curves:
        curve.sigma = np.std(curve.values) or 1.0
    found = deepest(fit, fit.find())
    if len(model.curves) > 1:
        # Each curve counts by its own noise, which is known once it has been fitted.
        for curve, values in zip(model.curves, fit.computed([found.x])[0]):
            curve.sigma = max(rms(values - curve.values), 1e-9 * curve.sigma)
        found = fit.settle(fit.solve(found.x))
    # At an end of the range there is no minimum to look at.
    answer = smooth(fit, found) if fit.is_within(found) else at_point(fit, found)
    answer.gain = np.sum(fit.weighed(start) ** 2) / answer.square if answer.square > 0.0 else np.inf
    return answer


def sizes_of(fit):
    return [curve.angle.size for curve in fit.model.curves]


def at_point(fit, found):
    """What the runs round the solution say."""
    residual = fit.residuals(found.x)
    freedom = np.count_nonzero(residual) - found.x.size
    slopes = fit.jacobian(found.x)
    deviation, correlation = surfaces.spread(slopes, residual, sizes_of(fit), freedom)
    return Answer(found, deviation, correlation, freedom, fit.computed([found.x])[0], np.sum(residual**2), slopes=slopes)


def smooth(fit, found):
    """The minimum of response surfaces that begin at the solution and go as far as the interval does."""
    centre, residual, jacobian = found.x, found.fun, fit.jacobian(found.x)
    deviation = np.inf
    for _ in range(surfaces.SURFACES):
        freedom = np.count_nonzero(residual) - centre.size
        axes, along = surfaces.valley(jacobian, np.sum(residual**2) / freedom)
        reach = np.clip(surfaces.WIDE * along, surfaces.LEAST, surfaces.MOST)
        surface = fit.surface(centre, axes * reach)
        place = surface.lowest()
        residual, jacobian = surface.residual(place), surface.jacobian(place) @ np.linalg.inv(surface.axes)
        move, before = surface.axes @ place, deviation
        freedom = np.count_nonzero(residual) - centre.size
        deviation, correlation = surfaces.spread(jacobian, residual, sizes_of(fit), freedom)
        deviation = np.hypot(deviation, surface.shaken(jacobian))
        centre = fit.inside(fit.clipped(centre + move))
        end = Solution(centre, np.zeros(centre.size, int), found.success)
        if ends_of(centre, end):
            # The surface falls on to the end of the range: there is no way left for the next one.
            return at_point(fit, end)
        with np.errstate(invalid="ignore", divide="ignore"):
            if np.all(np.abs(move) < surfaces.CLOSE * deviation) and np.all(np.abs(np.log(deviation / before)) < surfaces.CLOSE):
                break
    lowest = np.sum(fit.residuals(found.x) ** 2)
    if np.sum(fit.residuals(centre) ** 2) > lowest * (1.0 + WORSE / freedom):
        # Where curves jump, the surface bridges the jump, and its minimum lies beside that of the runs. Intervals reach from one to the other.
        other, centre = centre, fit.inside(found.x)
        deviation = np.hypot(deviation, 0.5 * (other - centre))
    solution, square = Solution(centre, np.zeros(centre.size, int), found.success), np.sum(residual**2)
    least = as_good(fit, centre, deviation, correlation, square / freedom)
    return Answer(solution, deviation, correlation, freedom, fit.computed([centre])[0], square, slopes=jacobian, least=least)


def as_good(fit, centre, deviation, correlation, square):
    """How far below and above runs lie that are as good as those at the end of an interval, for this variance of a residual.

    On a parabola none of them lies beyond the interval. Where a curve follows a parameter in steps, or one way only, some do. They
    are looked for beyond both ends, farther and farther, while the other parameters follow as the correlations tell. Where those at an
    end of the range are as good, there is no end on that side.
    """
    ends, enough = np.zeros((2, fit.size)), np.sum(fit.residuals(centre) ** 2) + AS_GOOD * square
    for k in np.flatnonzero(np.isfinite(deviation)):
        along = np.where(np.isfinite(deviation), correlation[:, k] * deviation / deviation[k], 0.0)
        for place, side in enumerate((-1.0, 1.0)):
            by = BEYOND * np.sqrt(AS_GOOD) * deviation[k]
            while 2.0 * fit.costs([point := fit.clipped(centre + side * by * along)])[0] < enough:
                if side * point[k] >= np.log(REACH):
                    ends[place, k] = np.inf
                    break
                by *= FARTHER
    good = np.array([point for point, computed in fit.seen.items() if np.sum(fit.weighed(computed) ** 2) < enough])
    return np.maximum(ends, [np.max(centre - good, axis=0), np.max(good - centre, axis=0)])


def intervals(starts, answer, confidence):
    """Values of the parameters, and by which share of them the lower and the upper ends of their intervals lie off, as logarithms."""
    count = len(starts)
    below, above = wide(answer, confidence)
    return np.array(starts) * np.exp(answer.found.x[:count]), below[:count], above[:count]


def zero_intervals(starts, answer, confidence):
    """Zeros of angles, and how far the lower and the upper ends of their intervals lie off, in rad."""
    count = len(starts)
    below, above = wide(answer, confidence)
    return ZERO * answer.found.x[count:], ZERO * below[count:], ZERO * above[count:]


def wide(answer, confidence):
    """How far intervals go below and above the solution, in the logarithms."""
    from scipy import stats

    both = stats.t.ppf(0.5 + 0.5 * confidence, answer.freedom) * answer.deviation
    return np.maximum(np.array([both, both]), answer.least)


def ends_of(names, found):
    """The parameters that ended at an end of their range, and which end: there is no minimum within the range."""
    reach = np.log(REACH)
    at = {name: x for name, x, active in zip(names, found.x, found.active_mask) if active or abs(x) > NEAR * reach}
    return {name: "lower" if x < 0.0 else "upper" for name, x in at.items()}


def explains_nothing(answer, curves):
    """Why the solution is no fit: it leaves as much as was measured, which is no noise, and is no better than its start or leaves far more."""
    left = [curve.values - values for curve, values in zip(curves, answer.computed)]
    if not all(autocorrelation(rest) > AUTOCORRELATED for rest in left):
        return None
    varies = [np.std(curve.values) for curve in curves]
    if all(rms(rest) > FAR_MORE * max(by, LEVEL * rms(curve.values)) for curve, rest, by in zip(curves, left, varies)):
        return "what the solution leaves is far more than what was measured varies by"
    if all(rms(rest) >= by for rest, by in zip(left, varies)) and answer.gain < 1.0 + GAIN:
        return "the solution is no better than its start, and what it leaves is as large as what was measured"
    return None


def warnings_of(names, answer):
    found, deviation, correlation = answer.found, answer.deviation, answer.correlation
    for k, name in enumerate(names):
        if not deviation[k] < 0.5:
            yield f"{name} hardly shows in what was measured: measure something else, or leave it out"
        for other in range(k):
            if abs(correlation[k, other]) > CORRELATED:
                yield f"{names[other]} and {name} cannot be told apart (correlation {correlation[k, other]:.2f}): fit one of them"
    if not found.success:
        yield "the search ended before it converged; start again from these values"
