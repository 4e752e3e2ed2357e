#!/usr/bin/env python3
"""Writes the reference files of `wave_damping`, `rolling_path`, `helix_gap`, `frozen_helix`,
`live_pair`, `grooved_capstan` and `feed_tension`.

    tests/reference/compute_laws.py [folder]

Needs Python with mpmath (1.3 was used) and numpy (1.26). The other files of this folder are the project's given references.
Nothing here knows the program: each number is a closed form, an eigenvalue or an integration of its own.
"""

import json
import math
import sys
from pathlib import Path

import mpmath
import numpy

HERE = Path(__file__).resolve().parent
# friction with which no wire slides on its way to rest: the steady state asks for 0.4
STICKS = 0.5
WIRE = json.loads((HERE / "spinning_ring.json").read_text(encoding="utf-8"))["wire"]


def write(folder, kind, words, check, cases, implicit=True):
    """One file; `implicit`: about the production method, so that it does not count for the paper's."""
    if implicit:
        check = {name: {**how, "preset": "default"} for name, how in check.items()}
    title, formula, source, precision, tolerance, notes = words
    doc = {
        "kind": kind, "title": title, "formula": formula, "source": source, "precision": precision,
        "suggested_tolerance": tolerance, "notes": notes, "check": check, "wire": WIRE,
        "cases": [{"id": name, "inputs": inputs, "expected": expected} for name, inputs, expected in cases],
    }
    text = json.dumps(doc, indent=1) + "\n"
    (folder / f"{kind}.json").write_text(text, encoding="utf-8")


def wave_damping(phase, ratio):
    """Decrement and period of y' = i y under BDF2 with steps `phase` and `ratio * phase` in turn.

    A step of h after one of h1, with s = h / h1: (1 + 2s)/(1 + s) y2 - (1 + s) y1 + s^2/(1 + s) y0 = h i y2.
    The product of the two companion matrices has the wave and a parasite as eigenvalues.
    """
    mpmath.mp.dps = 40
    steps = [mpmath.mpf(phase), mpmath.mpf(phase) * mpmath.mpf(ratio)]

    def companion(h, h1):
        s = h / h1
        lead = (1 + 2 * s) / (1 + s) - 1j * h
        return mpmath.matrix([[(1 + s) / lead, -(s**2 / (1 + s)) / lead], [1, 0]])

    pair = companion(steps[1], steps[0]) * companion(steps[0], steps[1])
    trace = pair[0, 0] + pair[1, 1]
    determinant = pair[0, 0] * pair[1, 1] - pair[0, 1] * pair[1, 0]
    root = mpmath.sqrt(trace**2 / 4 - determinant)
    wave = max((trace / 2 + root, trace / 2 - root), key=abs)
    turned = sum(steps)
    return {
        "decrement_per_period": float(-mpmath.log(abs(wave)) * 2 * mpmath.pi / turned),
        "period_over_exact": float(turned / mpmath.arg(wave)),
    }


class Bend:
    """Radial return of a curvature vector with isotropic hardening; a scalar is a vector with one component."""

    def __init__(self, stiff, soft, limit):
        self.stiff, self.limit = stiff, limit
        self.hardening = stiff * soft / (stiff - soft)

    def moment(self, state, strain):
        """Moment at a strain and the state it leads to."""
        plastic, rise = state
        trial = [self.stiff * (k - p) for k, p in zip(strain, plastic)]
        size = math.sqrt(sum(m * m for m in trial))
        over = size - self.limit - rise
        if over <= 0.0:
            return trial, state
        flow = over / (self.stiff + self.hardening)
        plastic = [p + flow * m / size for p, m in zip(plastic, trial)]
        return [self.stiff * (k - p) for k, p in zip(strain, plastic)], (plastic, rise + self.hardening * flow)


def rolled(curvature, roll, twist, edge, increments):
    """Moments and torque of the first joint at the ends of the legs.

    An edge of length l between two clamps, each joint standing for l/2. When the edge rolls by a, the twist angles of
    the joints become t + a and t - a, and both bends turn by -a/2 in their half-way frames. The roll is where
    T1 - T2 = (l/2) (M1 x k1 + M2 x k2) / 2 about the wire: the torques balance.
    """
    half = 0.5 * edge
    bend = Bend(WIRE["EI"], WIRE["EIp"], WIRE["M_y"])
    turn = Bend(WIRE["GJ"], WIRE["GJp"], WIRE["T_y"])
    bends = [([0.0, 0.0], 0.0), ([0.0, 0.0], 0.0)]
    turns = [([0.0], 0.0), ([0.0], 0.0)]
    a = 0.0
    got = {"bend_moment_Nm": [], "torque_Nm": []}
    legs = [((0.0, 0.0, 0.0), (curvature, 0.0, 0.0)), ((curvature, 0.0, 0.0), (curvature, roll, twist)),
            ((curvature, roll, twist), (0.0, roll, twist))]
    for start, end in legs:
        for i in range(1, increments + 1):
            k, direction, t = (s + (e - s) * i / increments for s, e in zip(start, end))

            def at(a):
                d = direction - 0.5 * a
                strain = [k * math.cos(d), k * math.sin(d)]
                m = [bend.moment(state, strain) for state in bends]
                q = [turn.moment(state, [t + side * a / half]) for state, side in zip(turns, (1.0, -1.0))]
                # derivative of the energy by the roll
                across = sum(0.5 * (mm[0] * strain[1] - mm[1] * strain[0]) for mm, _ in m)
                return (q[0][0][0] - q[1][0][0]) + half * across, m, q

            a = balanced(lambda a: at(a)[0], a)
            _, m, q = at(a)
            bends, turns = [state for _, state in m], [state for _, state in q]
        got["bend_moment_Nm"] += m[0][0]
        got["torque_Nm"] += q[0][0]
    return got


def balanced(f, near):
    """Root of an increasing function by bracketing and bisecting secants (Illinois)."""
    width = 1e-9
    low, high = near - width, near + width
    fl, fh = f(low), f(high)
    while fl > 0.0 or fh < 0.0:
        width *= 4.0
        low, high = near - width, near + width
        fl, fh = f(low), f(high)
    for _ in range(100):
        if high - low < 1e-17 or fh == fl:
            break
        mid = high - fh * (high - low) / (fh - fl)
        fm = f(mid)
        if abs(fm) < 1e-17:
            return mid
        if fm < 0.0:
            low, fl, fh = mid, fm, (0.5 * fh if fl == 0.0 else fh * 0.5)
        else:
            high, fh, fl = mid, fm, fl * 0.5
    return 0.5 * (low + high)


def rolling_path(curvature, roll, twist, edge=0.3e-3):
    """Two numbers of increments and the limit of their first-order error."""
    coarse = rolled(curvature, roll, twist, edge, 4000)
    fine = rolled(curvature, roll, twist, edge, 8000)
    limit = {name: [2 * f - c for f, c in zip(fine[name], coarse[name])] for name in fine}
    worst = max(abs(x - y) for name in fine for x, y in zip(limit[name], fine[name]))
    print(f"rolling_path: largest change by the last halving {worst:.1e} N m")
    return limit


def helix_gap(radius, pitch):
    """Least distance of a point of a helix from the turn before it, less the diameter."""
    mpmath.mp.dps = 30
    axis = mpmath.mpf(radius) + WIRE["d"] / 2
    rise = mpmath.mpf(pitch) / (2 * mpmath.pi)

    def square(turn):
        return (2 * axis * mpmath.sin(turn / 2)) ** 2 + (pitch - rise * turn) ** 2

    turn = mpmath.findroot(lambda t: mpmath.diff(square, t), pitch * rise / axis**2)
    gap = float(mpmath.sqrt(square(turn)) - WIRE["d"])
    return {"gap_min_m": gap, "gap_max_m": gap}


def laid_with_friction(axis, tension, stiffness=1e10, onset=1e-6, points=2400, length=25e-3):
    """Tension of wire that friction holds from its first touch on, laid on a soft core of centreline radius `axis`.

    A steady state, by the way s after the first touch: curvature k, depth w, tension N, stretch b of the friction springs.
    q = stiffness * w^2/2o up to the onset o, stiffness (w - o/2) beyond; K = stiffness * 2 (1 - nu)/(2 - nu), nu = 0.34, per length:

        EI k'' = k N - q    w'' = k - 1/axis    (N + EI k^2/2)' = K b    b' = (N - laid)/EA + (w - rest)/axis

    Before the touch the wire is an elastica of the pull `tension`: N + EI k^2/2 = tension there, and its k'. Far behind, k = 1/axis
    and w' = b = 0. Trapezoid rule on a grid that is finer near the touch, Newton's method with banded elimination.
    """
    ea, ei = WIRE["EA"], WIRE["EI"]
    spring = stiffness * 2 * (1 - 0.34) / (2 - 0.34)
    pull = math.sqrt(tension / ei)
    micro = 1e-6  # unit of w and b
    grid = [length * (i / (points - 1)) ** 2 for i in range(points)]

    def load(w):
        """Line load and its slope at a depth."""
        if w <= 0.0:
            return 0.0, 0.0
        if w < onset:
            return stiffness * w * w / (2 * onset), stiffness * w / onset
        return stiffness * (w - onset / 2), stiffness

    def rest(laid):
        """Depth at rest and its slope by the tension."""
        soft = laid / axis / stiffness
        depth = math.sqrt(2 * onset * soft) if soft < onset / 2 else soft + onset / 2
        return depth, 1 / axis / load(depth)[1]

    def slopes(y):
        k, k1, w, w1, total, b, laid = y
        n = total - 0.5 * ei * k * k
        return [
            k1, (k * n - load(w * micro)[0]) / ei, w1, (k - 1 / axis) / micro, spring * b * micro,
            ((n - laid) / ea + (w * micro - rest(laid)[0]) / axis) / micro, 0.0,
        ]

    def jacobian(y):
        k, _, w, _, total, _, laid = y
        n = total - 0.5 * ei * k * k
        rows = [[0.0] * 7 for _ in range(7)]
        rows[0][1] = rows[2][3] = 1.0
        rows[1][0], rows[1][2], rows[1][4] = (n - ei * k * k) / ei, -load(w * micro)[1] * micro / ei, k / ei
        rows[3][0], rows[4][5] = 1 / micro, spring * micro
        rows[5][0], rows[5][2], rows[5][4] = -ei * k / ea / micro, 1 / axis, 1 / ea / micro
        rows[5][6] = (-1 / ea - rest(laid)[1] / axis) / micro
        return rows

    def start(y):
        k = y[0]
        root = math.sqrt(1 - k * k * ei / (4 * tension))
        return [y[2], y[5], y[4] - tension, y[1] - pull * k * root]

    beta = (stiffness / (4 * ei)) ** 0.25
    laid = tension - 0.4 * ei / axis**2
    wire = []
    for s in grid:
        fade = math.exp(-beta * s)
        k = (1 - 0.06 * fade * math.cos(beta * s)) / axis
        wire.append([k, 0.0, rest(laid)[0] / micro * (1 - fade), 0.0, tension, 0.0, laid])
    for _ in range(30):
        # unknowns point by point; four conditions, then seven equations an interval, then three conditions
        rows, right = [], []
        k = wire[0][0]
        root = math.sqrt(1 - k * k * ei / (4 * tension))
        turn = -pull * (root - k * k * ei / (4 * tension) / root)
        for at in ({2: 1.0}, {5: 1.0}, {4: 1.0}, {1: 1.0, 0: turn}):
            rows.append(at)
        right += [-r for r in start(wire[0])]
        for i in range(points - 1):
            h = grid[i + 1] - grid[i]
            (f, g), (j, m) = map(slopes, wire[i : i + 2]), map(jacobian, wire[i : i + 2])
            for r in range(7):
                row = {}
                for c in range(7):
                    row[7 * i + c] = -(r == c) - 0.5 * h * j[r][c]
                    row[7 * i + 7 + c] = (r == c) - 0.5 * h * m[r][c]
                rows.append({c: v for c, v in row.items() if v != 0.0})
                right.append(-(wire[i + 1][r] - wire[i][r] - 0.5 * h * (f[r] + g[r])))
        last, end = 7 * (points - 1), wire[-1]
        rows += [{last + 3: 1.0}, {last: 1.0}, {last + 5: 1.0}]
        right += [-end[3], 1 / axis - end[0], -end[5]]
        update = banded(rows, right)
        for i, y in enumerate(wire):
            for c in range(7):
                y[c] += update[7 * i + c]
        if abs(update[6]) < 1e-9:
            return wire[0][6]
    raise ArithmeticError("no steady state was found")


def banded(rows, right):
    """Solution of a banded system, rows as {column: value}, by elimination with the largest pivot of each column."""
    size, right = len(rows), list(right)
    for c in range(size):
        near = range(c, min(size, c + 16))
        pivot = max(near, key=lambda r: abs(rows[r].get(c, 0.0)) / max(map(abs, rows[r].values())))
        rows[c], rows[pivot] = rows[pivot], rows[c]
        right[c], right[pivot] = right[pivot], right[c]
        for r in near:
            if r > c and c in rows[r]:
                factor = rows[r].pop(c) / rows[c][c]
                for column, value in rows[c].items():
                    if column > c:
                        rows[r][column] = rows[r].get(column, 0.0) - factor * value
                right[r] -= factor * right[c]
    found = [0.0] * size
    for c in reversed(range(size)):
        known = sum(v * found[k] for k, v in rows[c].items() if k > c)
        found[c] = (right[c] - known) / rows[c][c]
    return found


def frozen_helix(radius, pitch, tension, mu):
    """Wire laid on a cylinder under tension.

    Along a wire that nothing holds back tension plus EI k^2 / 2 stays the same: T in the straight span, T - EI k^2 / 2 where it
    touches with the curvature of the helix. Friction holds wire from its first touch on, where a soft core has not bent it
    fully: `tension_with_friction_N`, where friction is enough that nothing slides. A test counts it, at tight tolerances.
    """
    axis = radius + WIRE["d"] / 2
    rate = math.hypot(axis, pitch / (2 * math.pi))
    curvature = axis / rate**2
    laid = tension - 0.5 * WIRE["EI"] * curvature**2
    expected = {
        "fed_per_turn_m": 2 * math.pi * rate / (1 + laid / WIRE["EA"]), "laid_radius_m": axis,
        "moved_by_freezing_m": 0.0, "tension_jump_by_freezing_N": 0.0,
    }
    # without friction wire slides along the core to where the clamp's direction wants it
    if mu == 0.0:
        return {**expected, "laid_tension_N": laid}
    with_friction = {"tension_with_friction_N": laid_with_friction(1 / curvature, tension)} if mu >= STICKS else {}
    return {**expected, **with_friction, "laid_pitch_m": pitch, "tension_without_friction_N": laid}


def live_pair(press, mu, stiffness=1e10, onset=1e-6):
    """Depth of wire on wire under a line load (force k d^2/2o up to the onset, then k (d - o/2)), and Coulomb's friction."""
    depth = math.sqrt(2 * onset * press / stiffness)
    if depth > onset:
        depth = press / stiffness + onset / 2
    return {"approach_m": depth, "slip_exponent": mu}


def grooved_capstan(radius, hold, mu, wrap, groove):
    """Ratio of end forces of stiff wire that slips in a V groove, as in `capstan` with mu over the sine of half its angle."""
    bend = mpmath.mpf(radius) + mpmath.mpf(WIRE["r"])
    rate = mpmath.mpf(mu) / mpmath.sin(mpmath.mpf(groove) / 2)
    stiff = mpmath.mpf(WIRE["EI"]) / (2 * bend * bend)
    lift_off = lambda force: mpmath.acos(1 - stiff / force)  # noqa: E731
    first = lift_off(hold)
    begin = hold * (mpmath.cos(first) + rate * mpmath.sin(first))

    def balance(force):
        last = lift_off(force)
        laid = begin * mpmath.exp(rate * (wrap - first - last))
        return force * (mpmath.cos(last) - rate * mpmath.sin(last)) - laid

    force = mpmath.findroot(balance, hold * mpmath.exp(rate * wrap))
    return {"string_ratio": float(mpmath.exp(rate * wrap)), "stiff_ratio": float(force / hold)}


def moment_arm(box, distance, count):
    """Moment arm of a taut line from a nozzle to a rounded box that turns, m, at `count` angles of a turn.

    The line with its normal at phi touches the box at the angle theta where h(phi - theta) = D cos phi, h its support function.
    """
    width, height, corner = box
    theta = numpy.linspace(0.0, 2 * math.pi, count, endpoint=False)

    def support(angle):
        flat = (width / 2 - corner) * abs(numpy.cos(angle)) + (height / 2 - corner) * abs(numpy.sin(angle))
        return flat + corner + WIRE["r"]

    low, high = numpy.zeros(count), numpy.full(count, math.pi / 2)
    for _ in range(60):
        middle = 0.5 * (low + high)
        beyond = distance * numpy.cos(middle) < support(middle - theta)
        low, high = numpy.where(beyond, low, middle), numpy.where(beyond, middle, high)
    return distance * numpy.cos(0.5 * (low + high))


def feed_tension(box, distance, speed, line, masses, pulley):
    """Least, largest and mean tension at the nozzle, N, in steady winding, and the root mean square of what it is off its mean.

    Tensioner, spans and pulley are a chain of impedances; half the mass of each span's wire is at either of its ends. The
    velocity omega p of the wire is a Fourier series; what its kinks leave at the nozzle, the mass there, is added in time.
    """
    count = 1 << 16
    arm = moment_arm(box, distance, count)
    pull, stiffness, ratio = line
    tensioner, wire = masses
    damping = 2 * ratio * math.sqrt(stiffness * tensioner)
    frequency = 1j * speed * numpy.arange(1, count // 2 + 1)

    def through(impedance, share):
        return 1 / (1 / impedance + 1 / ((damping + stiffness / frequency) / share))

    if pulley is None:
        share, friction = 1.0, 0.0
        chain = through(frequency * (tensioner + wire / 2), 1.0)
    else:
        mass, friction, share = pulley
        chain = through(frequency * (tensioner + wire * (1 - share) / 2), 1 - share)
        chain = through(chain + frequency * (mass + wire / 2), share)
    velocity = numpy.fft.rfft(speed * arm)
    force = numpy.zeros_like(velocity)
    force[1:] = chain * velocity[1:]
    tension = pull + friction + numpy.fft.irfft(force, count)
    # p is smooth but for kinks: from here to the next angle on either side of one
    growing = (numpy.roll(arm, -1) - arm) * count / (2 * math.pi)
    tension = tension + wire * share / 2 * speed**2 * growing
    expected = {"tension_max_N": float(tension.max()), "tension_mean_N": float(tension.mean()), "tension_rms_N": float(tension.std())}
    # mass at the nozzle also feels how a flat slaps on the core, which the string of the reference does not
    return expected if wire > 0.0 else {"tension_min_N": float(tension.min()), **expected}


def feed_case(core, speed, tensioner, wire, pulley):
    """A case of `feed_tension`: 15 N, a line of 97.8 kN/m with a damping ratio of 0.1."""
    width, height, corner, distance = core
    inputs = {
        "core_w_m": width, "core_h_m": height, "corner_radius_m": corner, "nozzle_distance_m": distance, "T0_N": 15.0,
        "line_stiffness_N_per_m": 97800.0, "line_damping_ratio": 0.1, "omega_rad_per_s": speed, "tensioner_mass_kg": tensioner, "line_mass_kg": wire,
    }
    mass, friction, share = pulley or (0.0, 0.0, 0.5)
    inputs.update({"pulley_mass_kg": mass, "pulley_friction_N": friction, "pulley_place": share})
    name = f"core{width * 1e3:g}x{height * 1e3:g}_om{speed}_m{tensioner * 1e3:g}g_line{wire * 1e3:g}g"
    if pulley:
        name += f"_pulley{mass * 1e3:g}g_{friction:g}N"
    return name, inputs, feed_tension((width, height, corner), distance, speed, (15.0, 97800.0, 0.1), (tensioner, wire), pulley)


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE
    d = WIRE["d"]
    write(folder, "wave_damping", (
        "What variable-step BDF2 takes off a standing axial wave",
        "eigenvalue of two steps h, r h of (1+2s)/(1+s) y2 - (1+s) y1 + s^2/(1+s) y0 = h i omega y2, s the ratio of successive steps",
        "Hairer, Norsett & Wanner 1993, III.5; eigenvalue of the 2 x 2 companion product with 40 digits", "1e-14 relative",
        "1% of the decrement, 1e-4 of the period",
        "fixed-free wire, omega = (mode - 1/2) pi c / L; steps omega_h/omega and step_ratio times that in turn",
    ), {"decrement_per_period": {"rel": 0.01}, "period_over_exact": {"rel": 1e-4}}, [
        (f"mode{mode}_wh{phase:g}_r{ratio:g}", {"L_m": 0.1, "mode": mode, "omega_h": phase, "step_ratio": ratio}, wave_damping(phase, ratio))
        for mode, phase, ratio in ((1, 0.1, 1.0), (1, 0.2, 1.0), (2, 0.2, 1.5), (1, 0.2, 0.6))
    ])
    write(folder, "rolling_path", (
        "Bend and twist that yield together while the wire rolls",
        "legs: curvature 0 -> k; at k roll and twist 0 -> their values together; curvature k -> 0. Return maps of bend (vector) and twist; roll of the edge between two clamps from the balance of torques",
        "Simo & Hughes 1998 (return map); integrated in 8000 increments a leg, limit by Richardson", "1e-5 relative",
        "0.5% of a moment, 30 uN m", "one edge of a wind's spacing, 3/7 of the diameter and so 0.3 mm for this wire; each joint stands for half of it; no moment cap; lists: two components, and the torque, of the first joint at the end of each leg",
    ), {"bend_moment_Nm": {"rel": 0.005, "abs": 3e-5}, "torque_Nm": {"rel": 0.001, "abs": 1e-6}}, [
        (f"k{k:g}_roll{roll:g}_twist{twist:g}", {"curvature_1_per_m": k, "roll_rad": roll, "twist_1_per_m": twist}, rolling_path(k, roll, twist))
        for k, roll, twist in ((100.0, 1.0, 0.0), (100.0, 2.0, 20.0), (50.0, -1.5, 60.0), (1.5, 3.0, 1.0))
    ])
    write(folder, "helix_gap", (
        "Gap between the turns of a settled helix",
        "least distance of a point of a helix from the turn before it, less d: min over t of (2 a sin(t/2))^2 + (p - p t / 2 pi)^2, a = R + r",
        "elementary; root with 30 digits", "1e-14 m", "20 nm", "the chords between nodes are part of the measure",
    ), {"gap_min_m": {"abs": 2e-8}, "gap_max_m": {"abs": 2e-8}}, [
        (f"R{radius * 1e3:g}mm_p{pitch / d:g}d", {"R_m": radius, "pitch_m": pitch}, helix_gap(radius, pitch))
        for radius, pitch in ((0.01, d), (0.01, 1.3 * d), (0.005, 2.5 * d), (0.05, 1.05 * d))
    ], implicit=False)


    write(folder, "frozen_helix", (
        "Wire wound on a cylinder until it freezes",
        "laid tension T - EI k^2/2, k = a/(a^2 + (p/2 pi)^2), a = R + r; fed per turn 2 pi sqrt(a^2 + (p/2 pi)^2)/(1 + laid/EA); freezing moves nothing",
        "first integral of the elastica; boundary value problem of wire on a soft core, by collocation; elementary", "1e-6 N", "0.1 mm/m of the length, 2% of the tension",
        "elastic wire, tensioner without mass, nozzle without friction; slow, so that the wire has no weight",
    ), {
        "fed_per_turn_m": {"rel": 1e-4}, "laid_radius_m": {"abs": 1e-6}, "laid_pitch_m": {"rel": 1e-3},
        "laid_tension_N": {"rel": 0.02}, "moved_by_freezing_m": {"abs": 2e-7}, "tension_jump_by_freezing_N": {"abs": 0.02},
    }, [
        (f"R{radius * 1e3:g}mm_T{tension:g}_mu{mu:g}", {"R_m": radius, "pitch_m": 1.5 * d, "T0_N": tension, "mu": mu, "omega_rad_per_s": omega}, frozen_helix(radius, 1.5 * d, tension, mu))
        for radius, tension, mu, omega in ((0.05, 15.0, 0.0, 10.0), (0.02, 15.0, 0.0, 30.0), (0.02, 8.0, 0.23, 30.0), (0.02, 15.0, 0.17, 30.0), (0.02, 15.0, 0.5, 30.0))
    ])
    write(folder, "live_pair", (
        "Live wire pressed on live wire and drawn along it and the core",
        "two live turns of a helix on a frozen one, on a cylinder; line load q along the axis: depth from k d^2/2o = q; drawn until all of the last turn slides: dT/ds = mu (q + T/a), so (T + q a) grows by exp(mu phi), a = R + r",
        "statics and Coulomb; contact law of the documentation", "exact", "2% of the exponent, 10% of the depth",
        "stiffness 1e10 N/m^2 and onset 1 um are those of the default scene; static = kinetic = mu; the turn between is pressed by 3 q on frozen wire and does not slide",
    ), {"approach_m": {"rel": 0.1}, "slip_exponent": {"rel": 0.02}}, [
        (f"R{radius * 1e3:g}mm_T{pull:g}_q{press:g}_mu{mu:g}", {"R_m": radius, "T0_N": pull, "press_N_per_m": press, "mu": mu, "drawn_m": drawn}, live_pair(press, mu))
        for radius, pull, press, mu, drawn in ((0.01, 60.0, 3000.0, 0.17, 6e-4), (0.01, 60.0, 6000.0, 0.1, 6e-4))
    ])
    write(folder, "grooved_capstan", (
        "Wire on the point of slipping in a V groove of a pulley, with bending stiffness",
        "as capstan; each wall presses with n / (2 sin(groove/2)) for a line load n, so friction is that of mu / sin(groove/2)",
        "V-belt formula; stiff rod as in capstan", "1e-12 relative", "1% of the ratio",
        "elastic law only; static = kinetic = mu; the pulley is a triangle mesh, its groove as deep as two wire diameters and such that the centreline is bent to R + r",
    ), {"stiff_ratio": {"rel": 0.01}}, [
        (f"mu{mu:g}_wrap{degrees}_R{radius * 1e3:g}mm_F{hold:g}_V{groove}", {"mu": mu, "wrap_rad": math.radians(degrees), "R_m": radius, "F0_N": hold, "groove_rad": math.radians(groove)}, grooved_capstan(radius, hold, mu, math.radians(degrees), math.radians(groove)))
        for mu, degrees, radius, hold, groove in ((0.17, 180, 0.05, 5.0, 90), (0.17, 90, 0.05, 20.0, 60), (0.1, 180, 0.05, 10.0, 120))
    ], implicit=False)
    oblong, square = (0.012, 0.03, 0.002, 0.06), (0.02, 0.02, 0.003, 0.06)
    write(folder, "feed_tension", (
        "Tension at the nozzle while a rounded rectangle takes up wire through a line and a guide pulley",
        "wire speed omega p as in winding_feed; chain of impedances: tensioner i w m, span (c + k/(i w)) over its share, pulley i w m; half of a span's wire at either end; bearing friction adds its force",
        "Fourier series of 32768 terms", "1e-3 N", "1% of the extremes, 3% of the rms",
        "wire that is nearly inextensible, without stiffness in bending and with a hundredth of its mass, so that waves of the free span do not count; the wire never goes back; line mass and pulley are free numbers",
    ), {"tension_min_N": {"rel": 0.01}, "tension_max_N": {"rel": 0.01}, "tension_mean_N": {"rel": 0.002}, "tension_rms_N": {"rel": 0.03}}, [
        feed_case(core, speed, tensioner, wire, pulley)
        for core, speed, tensioner, wire, pulley in (
            (oblong, 100, 2e-3, 0.0, None), (oblong, 300, 2e-3, 0.0, None), (square, 300, 5e-4, 0.0, None), (square, 300, 1e-3, 1.7e-3, None),
            (square, 300, 1e-3, 0.0, (2e-3, 3.0, 0.4)), (oblong, 100, 1e-3, 1.7e-3, (5e-3, 1.0, 0.7)),
        )
    ])


if __name__ == "__main__":
    main()
