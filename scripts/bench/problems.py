"""P1, P2 and P3 as coilwind has them (src/bench/p1.rs, p2.rs, p3.rs): elastic wire of the paper's Table 1; 0.1 m,
clamped, in P1 and P2.

P1: a dead force `P = a EI / L^2` across the tip. Error: distance of the tip from that of the extensible elastica over
L.

P2: released from the first mode with a tip of L/1000, ten periods. Error: largest deviation of the tip from
`A cos(omega_1 t)` over A.

P3: half a turn on a cylinder with a thousandth of the bending stiffness; 10 N hold one end, the other is drawn along
its leg, slowly. Error: ratio of the end forces against `exp(mu pi)`, relative; the stiffness left takes 8e-4 off it.
Units are SI.
"""

import functools
import math

LENGTH = 0.1
EA = 48.9e3
EI = 3.06e-3
GJ = 4.32e-3
DIAMETER = 0.7e-3
DENSITY = 8960.0
MASS = DENSITY * math.pi * DIAMETER**2 / 4.0  # per length

AMPLITUDE = 1e-3 * LENGTH
PERIODS = 10
ROOT = 1.875104068711961  # cos b cosh b = -1
OMEGA = (ROOT / LENGTH) ** 2 * math.sqrt(EI / MASS)
PERIOD = 2.0 * math.pi / OMEGA

# P3: radius of the cylinder and of the wire's centreline, force on the slack side, friction, legs, drawing speed
RADIUS = 10e-3
BEND = RADIUS + 0.5 * DIAMETER
HOLD = 10.0
FRICTION = 0.23
STRING = 1e-3
LEG = 0.6 * BEND
SPEED = 0.01


def tip_force(a):
    """Force across the tip, N, of the load P L^2/EI."""
    return a * EI / LENGTH**2


def tip_error(a, tip):
    """Distance of a tip (x, y) from the elastica's, over the length."""
    x, y = elastica_tip(a)
    return math.hypot(tip[0] - x, tip[1] - y) / LENGTH


@functools.cache
def elastica_tip(a):
    """Tip of an extensible, unshearable cantilever under a dead force across it, m.

    `EI th'' = -P (1 + e) cos th`, `e = P sin th / EA`. Its first integral makes length and tip quadratures over the
    angle; `th = alpha - s^2` takes the root out of their end. Bisection finds the angle alpha of the tip.
    """
    force = tip_force(a)
    soft = force / EA

    def integrals(alpha):
        pairs = 1000
        end = math.sqrt(alpha)
        h = end / (2 * pairs)
        sums = [0.0, 0.0, 0.0]
        for i in range(2 * pairs + 1):
            s = i * h
            half = 0.5 * s * s
            theta = alpha - s * s
            # (sin alpha - sin theta) / s^2 without cancellation
            drop = math.cos(alpha - half) * (math.sin(half) / half if half > 0.0 else 1.0)
            stretched = 1.0 + 0.5 * soft * (math.sin(alpha) + math.sin(theta))
            ds = 2.0 / math.sqrt(2.0 * force / EI * drop * stretched)
            weight = (1.0 if i in (0, 2 * pairs) else 4.0 if i % 2 else 2.0) * h / 3.0
            longer = 1.0 + soft * math.sin(theta)
            sums[0] += weight * ds
            sums[1] += weight * ds * longer * math.cos(theta)
            sums[2] += weight * ds * longer * math.sin(theta)
        return sums

    low, high = 1e-9, 0.5 * math.pi - 1e-9
    for _ in range(60):
        middle = 0.5 * (low + high)
        if integrals(middle)[0] < LENGTH:
            low = middle
        else:
            high = middle
    _, x, y = integrals(0.5 * (low + high))
    return x, y


def mode(share):
    """Height of the first mode, m, at a share of the length."""
    return AMPLITUDE * _shape(share)[0] / _shape(1.0)[0]


def mode_slope(share):
    """Slope of the first mode at a share of the length."""
    return AMPLITUDE * _shape(share)[1] / _shape(1.0)[0]


def _shape(share):
    b = ROOT * share
    sigma = (math.cosh(ROOT) + math.cos(ROOT)) / (math.sinh(ROOT) + math.sin(ROOT))
    height = math.cosh(b) - math.cos(b) - sigma * (math.sinh(b) - math.sin(b))
    slope = math.sinh(b) + math.sin(b) - sigma * (math.cosh(b) - math.cos(b))
    return height, slope * ROOT / LENGTH


def released(n):
    """Points (x, y) on the mode's shape whose distances are L/n: bent, not stretched."""
    h = LENGTH / n
    points = [(0.0, 0.0)]
    for i in range(1, n + 1):
        y = mode(i / n)
        x = points[-1][0] + math.sqrt(h * h - (y - points[-1][1]) ** 2)
        points.append((x, y))
    return points


def steps_of(per_period):
    """Number of steps to the end and their length, s."""
    count = round(PERIODS * per_period)
    return count, PERIODS * PERIOD / count


def vibration_error(times, heights):
    """Largest deviation of the tip from the exact vibration, over its amplitude."""
    return max(abs(y - AMPLITUDE * math.cos(OMEGA * t)) for t, y in zip(times, heights)) / AMPLITUDE


def string(s):
    """Place (x, y) and direction of P3's wire at an arc length: from the held end, below, to the drawn one, above."""
    arc = math.pi * BEND
    if s < LEG:
        return LEG - s, -BEND, -1.0, 0.0
    if s < LEG + arc:
        angle = -0.5 * math.pi - (s - LEG) / BEND
        return BEND * math.cos(angle), BEND * math.sin(angle), math.sin(angle), -math.cos(angle)
    return s - LEG - arc, BEND, 1.0, 0.0


def slip_error(force):
    """Error of the force at the drawn end, relative."""
    return abs(force / HOLD / math.exp(FRICTION * math.pi) - 1.0)
