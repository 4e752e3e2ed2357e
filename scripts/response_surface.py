"""Least squares with a model that scatters: on a quadratic response surface instead of the runs themselves.

Steps of a solver with error control jump as parameters change. A difference over a short way is then mostly scatter, and makes
the Jacobian too large and intervals too narrow (More and Wild, Estimating derivatives of noisy simulations, ACM TOMS 38(3),
2012). The lowest of many dips is no better an estimate. So curves are taken as quadratics along the axes of the valley, fitted
to runs as far apart as the interval is wide (Box and Wilson, J. R. Stat. Soc. B 13, 1951).
"""

from dataclasses import dataclass

import numpy as np

from calibration_noise import distances

# How far the runs of a surface go from its middle, in standard deviations, and how many there are on an axis.
WIDE, RUNS = 2.5, 9
# Least and most of that way, in the logarithms of the parameters: twice what a run scatters over, and a factor of 1.8.
LEAST, MOST = 0.06, 0.6
# Surfaces until the middle of one is its minimum, to this part of a standard deviation.
SURFACES, CLOSE = 6, 0.1


@dataclass
class Surface:
    """Weighed residuals, quadratic in the place along each axis, which goes from -1 to 1."""

    # a column an axis: what a step of 1 adds to the parameters
    axes: np.ndarray
    middle: np.ndarray
    slopes: np.ndarray
    bends: np.ndarray
    # a row a run: what the surface leaves of it, as large as a run scatters
    scatter: np.ndarray

    def residual(self, place):
        return self.middle + self.slopes @ place + self.bends @ place**2

    def jacobian(self, place):
        return self.slopes + 2.0 * self.bends * place

    def shaken(self, jacobian):
        """Standard deviations that the scatter of runs alone would give the parameters."""
        return np.sqrt(np.mean((self.scatter @ np.linalg.pinv(jacobian).T) ** 2, axis=0))

    def lowest(self):
        """The place of the least sum of squares within the surface."""
        from scipy import optimize

        return optimize.least_squares(self.residual, np.zeros(self.axes.shape[1]), self.jacobian, bounds=(-1.0, 1.0)).x


def surface(residuals, centre, axes, inside=None):
    """The surface round a point. `residuals` gives those of many points, not a number where nothing is compared.

    `inside` moves a point to where the scene takes it, if there are places where it does not.
    """
    shares = [share for share in np.linspace(-1.0, 1.0, RUNS) if share]
    count = axes.shape[1]
    places = np.array([np.zeros(count), *(share * one for one in np.eye(count) for share in shares)])
    points = [centre + axes @ place for place in places]
    if inside is not None:
        points = [inside(point) for point in points]
        places = (np.array(points) - centre) @ np.linalg.inv(axes).T
    found = np.array(residuals(points))
    # What is not compared everywhere would make a step.
    found[:, ~np.isfinite(found).all(axis=0)] = 0.0
    terms = np.column_stack([np.ones(len(places)), places, places**2])
    fitted = np.linalg.lstsq(terms, found, rcond=None)[0]
    scatter = (found - terms @ fitted) * np.sqrt(len(places) / (len(places) - len(fitted)))
    middle, *rest = fitted
    return Surface(axes, middle, np.array(rest[:count]).T, np.array(rest[count:]).T, scatter)


def valley(jacobian, square):
    """Axes of the valley, a column each, and the standard deviation along each, for this variance of a residual."""
    curvature, axes = np.linalg.eigh(jacobian.T @ jacobian)
    with np.errstate(divide="ignore"):
        return axes, np.sqrt(square / np.maximum(curvature, 0.0))


def spread(jacobian, residual, sizes, freedom):
    """Standard deviations and correlations of the parameters. `sizes` are those of the curves in the residual.

    Neighbours of a curve that deviate together count for less than as many that do not. Their correlation enters by Bartlett's
    weights, as of Newey and West, Econometrica 55 (1987), where that makes an interval wider.
    """
    inverse, square = np.linalg.pinv(jacobian.T @ jacobian), np.sum(residual**2) / freedom
    between, ends = jacobian.T @ jacobian, np.cumsum(sizes)[:-1]
    for slopes, rest in zip(np.split(jacobian, ends), np.split(residual, ends)):
        power = np.sum(rest**2)
        most = min(distances(rest.size), rest.size - 1) if power > 0.0 else 0
        for lag in range(1, most + 1):
            weight = (1.0 - lag / (most + 1)) * np.sum(rest[lag:] * rest[:-lag]) / power
            shifted = slopes[lag:].T @ slopes[:-lag]
            between = between + weight * (shifted + shifted.T)
    plain = inverse * square
    along = square * inverse @ between @ inverse
    deviation = np.sqrt(np.maximum(np.diag(plain), np.diag(along)))
    blind = np.linalg.norm(jacobian, axis=0) < 1e-9
    deviation[blind] = np.inf
    of_plain = np.where(blind, np.inf, np.sqrt(np.diag(plain)))
    with np.errstate(invalid="ignore", divide="ignore"):
        return deviation, plain / np.outer(of_plain, of_plain)
