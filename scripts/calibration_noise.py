"""Whether what a fit leaves of a curve is noise, for scripts/calibrate.py.

Noise may correlate from row to row, as a sensor with a filter makes it: each value is a share of the one before, plus something
fresh. The fresh part of such noise has no correlation at any distance, and its mean is zero as far as its size tells. What is left
of a scene that differs from the machine rings or drifts along the angle, or lies off as a whole.
"""

import numpy as np

# Noise is called something else once in so many curves, by each of the two tests.
LEVEL = 0.01
# Values that a test takes for each distance between rows.
ROWS = 4
# Standard errors by which the correlation of the noise may be larger than it is found, where a mean is judged.
DOUBT = 2.0


def distances(count):
    """Up to how many rows apart neighbours of a curve may deviate together."""
    return 2 * int(4.0 * (count / 100.0) ** (2.0 / 9.0))


def there(residual):
    residual = residual[np.isfinite(residual)]
    return residual - np.mean(residual) if residual.size else residual


def autocorrelation(residual, distance=1):
    residual = there(residual)
    power = np.sum(residual**2)
    return float(np.sum(residual[distance:] * residual[:-distance]) / power) if power > 0.0 else 0.0


def from_row_to_row(residual):
    """Standard deviation of the noise as second differences of rows tell it: without what changes slowly, and by the median without steps."""
    fresh = np.diff(residual[np.isfinite(residual)], 2)
    # The median of normal noise is 0.6745 of its standard deviation, and the squares of the weights 1, -2, 1 add to 6.
    return float(np.median(np.abs(fresh)) / 0.6745 / np.sqrt(6.0)) if fresh.size else 0.0


def chance(residual):
    """How likely noise correlates along a curve as much as this, by the test of Ljung and Box (Biometrika 65, 1978) on its fresh part."""
    from scipy import stats

    residual = there(residual)
    most = min(distances(residual.size), residual.size // ROWS)
    if most < 2 or not np.sum(residual[:-1] ** 2) > 0.0:
        return 1.0
    share = np.sum(residual[1:] * residual[:-1]) / np.sum(residual[:-1] ** 2)
    fresh, apart = residual[1:] - share * residual[:-1], np.arange(1, most + 1)
    along = np.array([autocorrelation(fresh, distance) for distance in apart])
    # The share takes one degree of freedom.
    return float(stats.chi2.sf(fresh.size * (fresh.size + 2) * np.sum(along**2 / (fresh.size - apart)), most - 1))


def chance_of_turn(residual, slopes, turns):
    """How likely one of these turns of the computed curve explains as much of noise as it explains of what is left, and which does so best.

    `turns` are differences of the curve, a row each. What a parameter explains too, by its column of `slopes`, counts for none. The
    correlation of the noise enters by the filter of Cochrane and Orcutt (J. Am. Stat. Assoc. 44, 1949).
    """
    from scipy import stats

    best, rare = 0, 1.0
    for place, turn in enumerate(turns):
        rows = np.isfinite(residual) & np.isfinite(turn)
        rest, terms = residual[rows], np.column_stack([turn, slopes])[rows]
        freedom = rest.size - 1 - terms.shape[1]
        if freedom < 1 or not np.ptp(rest) > 0.0:
            continue
        share = autocorrelation(rest)
        rest, terms = rest[1:] - share * rest[:-1], terms[1:] - share * terms[:-1]
        terms, others = terms[:, 0], terms[:, 1:]
        clean = terms - others @ np.linalg.lstsq(others, terms, rcond=None)[0]
        rest = rest - others @ np.linalg.lstsq(others, rest, rcond=None)[0]
        power = np.sum(clean**2)
        if not power > 1e-12 * np.sum(terms**2):
            continue
        by = np.sum(clean * rest) / power
        error = np.sqrt(np.sum((rest - by * clean) ** 2) / freedom / power)
        # Only towards what is left: the other way has a turn of its own. As many chances as there are turns.
        if error > 0.0 and (found := len(turns) * stats.t.sf(by / error, freedom)) < rare:
            best, rare = place, float(found)
    return rare, best


def chance_of_mean(residual):
    """How likely the mean of noise is as far from zero as this, by Student's t with as many values as tell something of their own.

    A correlation of few values is found too small on average (Kendall, Biometrika 41, 1954), and is uncertain.
    """
    from scipy import stats

    noise = there(residual)
    if noise.size < 2 or not np.sum(noise**2) > 0.0:
        return 1.0
    found = autocorrelation(noise)
    share = found + (1.0 + 3.0 * found) / noise.size + DOUBT * np.sqrt((1.0 - found**2) / noise.size)
    own = noise.size * (1.0 - share) / (1.0 + share) if share > 0.0 else float(noise.size)
    if own < 2.0:
        return 1.0
    error = np.sqrt(np.mean(noise**2) / (own - 1.0))
    return float(2.0 * stats.t.sf(abs(np.nanmean(residual)) / error, own - 1.0))
