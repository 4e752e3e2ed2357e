"""Exact answers of the cases that `coilwind verify` runs: closed forms, roots, quadratures and integrations.

A function per kind takes the wire record and the inputs of a case and returns what is expected. None knows the program, and none is
taken from the scripts that wrote the reference cases: `random_answers.py --check` shows that they agree.
"""

import cmath
import math

import numpy as np
from scipy.integrate import quad, solve_bvp
from scipy.optimize import brentq

GRAVITY = 9.80665
COPPER = {"E": 127e9, "Et": 2.86e9, "G": 47.9e9, "Gt": 2.86e9 / 3, "rho": 8960.0, "sigma_y": 1e8}
"""Moduli and yield stress, Pa, and density, kg/m3, of `wire.material = copper`."""


class NotModelled(ValueError):
    """The formulas leave out what the wire does with these inputs."""


def need(holds, what):
    if not holds:
        raise NotModelled(what)


def copper(d):
    """The record of a round copper wire of diameter `d`, m."""
    area, second = math.pi * d**2 / 4, math.pi * d**4 / 64
    wire = {
        "d": d, "r": d / 2, "rho": COPPER["rho"], "EA": COPPER["E"] * area, "EAp": COPPER["Et"] * area,
        "EI": COPPER["E"] * second, "EIp": COPPER["Et"] * second, "GJ": COPPER["G"] * 2 * second, "GJp": COPPER["Gt"] * 2 * second,
        "mu_s": 0.23, "mu_k": 0.17, "sigma_y": COPPER["sigma_y"], "A": area, "rhoA": COPPER["rho"] * area,
        "rhoIp": COPPER["rho"] * 2 * second, "N_y": COPPER["sigma_y"] * area, "M_y": COPPER["sigma_y"] * d**3 / 6,
        "T_y": COPPER["sigma_y"] / math.sqrt(3) * math.pi * d**3 / 12,
    }
    return {**wire, "eps_y": wire["N_y"] / wire["EA"], "kappa_y": wire["M_y"] / wire["EI"], "twist_y": wire["T_y"] / wire["GJ"]}


def first_roots(f, start, step, count):
    """The first `count` sign changes of `f` beyond `start`, looked for in steps."""
    found, a, fa = [], start, f(start)
    while len(found) < count:
        b = a + step
        fb = f(b)
        if fa * fb < 0:
            found.append(brentq(f, a, b, xtol=1e-15 * b, rtol=1e-14))
        a, fa = b, fb
    return found


# wire on the shoulder of its neighbour, in a groove, on a turning core


def shoulder_drop(wire, inputs):
    """In units of r and sqrt(q r / m'). On the shoulder u = v^2/2 solves the linear equation
    u' - 2 mu u = 2 (1 + mu lam) sin - 2 (mu - lam) cos, so it has a closed form; the wire leaves at u = cos - lam sin."""
    start, mu, lam = math.radians(inputs["start_angle_deg"]), inputs["mu"], inputs["lam"]
    if math.tan(start + math.atan(lam)) <= mu:
        return {"sticks": True}
    need(lam < mu, "the wire slides on for ever")
    need(-lam < mu, "the wire slides back to its neighbour")
    # particular solution a sin + b cos
    of_sin, of_cos = 2 * (1 + mu * lam), 2 * (lam - mu)
    b = -(of_sin + 2 * mu * of_cos) / (1 + 4 * mu * mu)
    a = of_cos + 2 * mu * b

    def energy(phi):
        grown = math.exp(2 * mu * (phi - start))
        return a * math.sin(phi) + b * math.cos(phi) - (a * math.sin(start) + b * math.cos(start)) * grown

    leaves = brentq(lambda phi: math.cos(phi) - lam * math.sin(phi) - energy(phi), start, math.pi / 2, xtol=1e-15)
    speed = math.sqrt(2 * energy(leaves))
    across, down = speed * math.cos(leaves), speed * math.sin(leaves)
    beside, above = 2 * math.sin(leaves), 2 * math.cos(leaves)

    def flight(time):
        return beside + across * time + lam * time**2 / 2, above - down * time - time**2 / 2

    lands = math.sqrt(down**2 + 2 * above) - down
    clear = min(math.hypot(*flight(lands * share)) for share in np.linspace(0, 1, 101))
    need(clear > 2 - 1e-9, "the wire strikes its neighbour again in flight")
    landed = flight(lands)[0]
    left = max(0.0, across + lam * lands - mu * (down + lands))
    rests = landed + left**2 / (2 * (mu - lam))
    r = wire["r"]
    return {
        "sticks": False, "separation_angle_rad": leaves, "landing_offset_m": landed * r, "final_offset_m": rests * r,
        "gap_m": (rests - 2) * r, "gap_over_d": (rests - 2) / 2,
    }


def shoulder_static(wire, inputs):
    angle = math.atan(inputs["mu"]) - math.atan(inputs["lam"])
    return {"slides_down_beyond_offset_m": wire["d"] * math.sin(angle), "slides_down_beyond_angle_rad": angle}


def groove_seat(wire, inputs):
    """Balance of the two normal forces with the load, across and down."""
    half = math.asin(inputs["pitch_m"] / (2 * wire["d"]))
    sums = [[math.sin(half), -math.sin(half)], [math.cos(half), math.cos(half)]]
    left, right = np.linalg.solve(sums, [inputs["lam"], 1.0])
    need(right > 0 and left > 0, "the wire leaves the groove")
    height = math.sqrt(wire["d"] ** 2 - (inputs["pitch_m"] / 2) ** 2)
    return {"half_angle_rad": half, "normal_left_per_q": left, "normal_right_per_q": right, "seat_height_above_wire_centres_m": height}


def spinning_ring(wire, inputs):
    omega, radius, pull = inputs["omega_rad_per_s"], inputs["R_m"], inputs["T0_N"]
    free = wire["rhoA"] * (omega * radius) ** 2
    need(pull > free, "the wire does not touch the core")
    return {
        "hoop_tension_free_ring_N": free, "contact_load_N_per_m": (pull - free) / radius,
        "liftoff_speed_rad_per_s": math.sqrt(pull / wire["rhoA"]) / radius,
    }


# wire that slips round a cylinder


def slipping(wire, inputs, mu):
    """Force on the pulled side over that on the held side; the pulled side's force is followed along the wire."""
    stiff = 0.5 * wire["EI"] / (inputs["R_m"] + wire["r"]) ** 2
    wrap, hold = inputs["wrap_rad"], inputs["F0_N"]
    need(stiff < 2 * hold, "the wire does not come to lie on the cylinder")

    def leaves(force):
        return math.acos(1 - stiff / force)

    first = leaves(hold)
    begin = hold * (math.cos(first) + mu * math.sin(first))

    def excess(logarithm):
        force = hold * math.exp(logarithm)
        last = leaves(force)
        return math.log(force * (math.cos(last) - mu * math.sin(last)) / begin) - mu * (wrap - first - last)

    ratio = math.exp(brentq(excess, 1e-9, 2 * mu * wrap, xtol=1e-15))
    contact = wrap - first - leaves(hold * ratio)
    need(contact > 0.2, "the wire hardly touches the cylinder")
    return {"string_ratio": math.exp(mu * wrap), "stiff_ratio": ratio, "contact_angle_rad": contact}


def capstan(wire, inputs):
    return slipping(wire, inputs, inputs["mu"])


def grooved_capstan(wire, inputs):
    found = slipping(wire, inputs, inputs["mu"] / math.sin(0.5 * inputs["groove_rad"]))
    return {name: found[name] for name in ("string_ratio", "stiff_ratio")}


# elastic wire


def elastica_cantilever(wire, inputs):
    """First integral EI th'^2/2 = P (sin t - sin th) + P^2/2EA (sin^2 t - sin^2 th), t at the tip; th = t (1 - v^2) takes the root out."""
    alpha, length = inputs["alpha"], inputs["L_m"]
    force = alpha * wire["EI"] / length**2

    def tip(stretch):
        def integrals(end):
            def shares(v, what):
                angle = end * (1 - v * v)
                s, t = math.sin(angle), math.sin(end)
                # sin t - sin th over t - th = t v^2, without a difference of equals
                half = 0.5 * end * v * v
                slope = math.cos(0.5 * (end + angle)) * (math.sin(half) / half if half > 0 else 1.0)
                rate = math.sqrt(2 * alpha * slope * end * (1 + 0.5 * stretch * (s + t)))
                return what(angle) * 2 * end / rate

            def along(what):
                return quad(shares, 0, 1, args=(what,), epsabs=0, epsrel=1e-11)[0]

            longer = lambda th: 1 + stretch * math.sin(th)
            return along(lambda th: 1.0), along(lambda th: longer(th) * math.cos(th)), along(lambda th: longer(th) * math.sin(th))

        end = brentq(lambda end: integrals(end)[0] - 1, 1e-3, math.pi / 2 - 1e-4, xtol=1e-15)
        _, x, y = integrals(end)
        moment = math.sqrt(2 * alpha * math.sin(end) * (1 + 0.5 * stretch * math.sin(end)))
        return end, x * length, y * length, moment * wire["EI"] / length

    plain, stretched = tip(0.0), tip(force / wire["EA"])
    return {
        "P_N": force, "tip_angle_rad": plain[0], "tip_x_m": plain[1], "tip_y_m": plain[2], "extensible_tip_angle_rad": stretched[0],
        "extensible_tip_x_m": stretched[1], "extensible_tip_y_m": stretched[2], "clamp_moment_Nm": stretched[3],
    }


def end_couple(wire, inputs):
    length = inputs["L_m"]
    turn = 2 * math.pi * inputs["fraction"]
    tip = length * (1 - cmath.exp(-1j * turn)) / (1j * turn) * cmath.exp(1j * turn)
    return {
        "M_Nm": wire["EI"] * turn / length, "curvature_1_per_m": turn / length,
        "tip_x_m": tip.real, "tip_y_m": tip.imag, "tip_angle_rad": turn,
    }


def bending_modes(wire, inputs):
    """Shapes of the span from two that fit the near end; the far end's conditions leave a determinant of two by two."""
    length, pull = inputs["L_m"], inputs["T_N"] * inputs["L_m"] ** 2 / wire["EI"]
    rate = math.sqrt(wire["EI"] / wire["rhoA"]) / length**2
    if inputs["bc"] == "pinned-pinned":
        shapes = [(n * math.pi) ** 2 for n in (1, 2, 3)]
        found = [math.sqrt(s * (s + pull)) for s in shapes]
    else:

        def determinant(omega):
            root = math.hypot(0.5 * pull, omega)
            a, b = math.sqrt(root + 0.5 * pull), math.sqrt(root - 0.5 * pull)
            # hyperbolic functions over cosh a; rows are derivatives of cosh - cos and of sinh/a - sin/b
            h, t, c, s = 1 / math.cosh(a), math.tanh(a), math.cos(b), math.sin(b)
            even = [1 - c * h, a * t + b * s * h, a**2 + b**2 * c * h, a**3 * t - b**3 * s * h]
            odd = [t / a - s * h / b, 1 - c * h, a * t + b * s * h, a**2 + b**2 * c * h]
            if inputs["bc"] == "clamped-clamped":
                rows = [(even[0], odd[0]), (even[1], odd[1])]
            else:
                rows = [(even[2], odd[2]), (even[3] - pull * even[1], odd[3] - pull * odd[1])]
            (p, q), (r, w) = rows
            return (p * w - q * r) / h / (a * b) ** 2

        found = first_roots(determinant, 1e-3, 0.2, 3)
    return {f"f{n}_Hz": omega * rate / (2 * math.pi) for n, omega in enumerate(found, 1)}


def axial_wave(wire, inputs):
    speed, length = math.sqrt(wire["EA"] / wire["rhoA"]), inputs["L_m"]
    return {**lowest(speed, length), "static_extension_m": inputs["P_N"] * length / wire["EA"]}


def torsion(wire, inputs):
    inertia = wire["rho"] * math.pi * wire["d"] ** 4 / 32
    speed, length = math.sqrt(wire["GJ"] / inertia), inputs["L_m"]
    return {**lowest(speed, length), "static_twist_rad": inputs["torque_Nm"] * length / wire["GJ"]}


def lowest(speed, length):
    quarter = speed / (4 * length)
    return {"wave_speed_m_per_s": speed, "fixed_free_f1_Hz": quarter, "fixed_free_f2_Hz": 3 * quarter, "fixed_fixed_f1_Hz": 2 * quarter}


def hanging_wire(wire, inputs):
    """Half of the wire as a boundary value problem, by collocation, from the catenary on; lengths over half the wire's."""
    span, length = inputs["span_m"], inputs["length_m"]
    half, weight = length / 2, wire["rhoA"] * GRAVITY
    need(length > span, "the wire is not longer than the span")
    param = brentq(lambda a: 2 * a * math.sinh(span / (2 * a)) - length, span / 50, span * 100, xtol=1e-15)
    load = weight * half**3 / wire["EI"]
    soft = weight * half / wire["EA"]

    def slopes(s, y, pull):
        angle, bend = y[0], y[1]
        longer = 1 + soft * (pull[0] * np.cos(angle) + s * np.sin(angle))
        return [bend, -longer * load * (s * np.cos(angle) - pull[0] * np.sin(angle)), longer * np.cos(angle), longer * np.sin(angle)]

    def ends(a, b, pull):
        return [a[0], a[2], a[3], b[0], b[2] - span / length]

    s = np.linspace(0, 1, 401)
    sag = np.sqrt((param / half) ** 2 + s**2) - param / half
    guess = [np.arctan2(s * half, param) * (1 - s**8), np.gradient(np.arctan2(s * half, param), s), param / half * np.arcsinh(s * half / param), sag]
    found = solve_bvp(slopes, ends, s, guess, p=[param / half], tol=1e-9, max_nodes=100_000)
    need(found.success and found.p[0] > 0, f"no shape of the wire was found: {found.message}")
    bend = wire["EI"] / half
    return {
        "catenary_H_N": weight * param, "catenary_sag_m": param * (math.cosh(span / 2 / param) - 1), "H_N": found.p[0] * weight * half,
        "mid_moment_Nm": found.y[1, 0] * bend, "end_moment_Nm": found.y[1, -1] * bend, "sag_m": found.y[3, -1] * half,
    }


def helix(wire, inputs):
    """Force and couple from the balance of moments about the axis, by components along tangent and binormal."""
    radius, rise = inputs["R_m"], inputs["pitch_m"] / (2 * math.pi)
    rate = math.hypot(radius, rise)
    bend, turn = wire["EI"] * radius / rate**2, wire["GJ"] * inputs["twist_density_1_per_m"]
    return {"axial_force_N": (turn * radius / rate - bend * rise / rate) / radius, "axial_moment_Nm": bend * radius / rate + turn * rise / rate}


def bulge_linear(wire, inputs):
    pull, span, couple = inputs["T_N"], inputs["span_m"], inputs["M_Nm"]
    steep = math.sqrt(pull / wire["EI"])
    half = steep * span / 2
    return {
        "bulge_m": couple / pull * 2 * math.sinh(half / 2) ** 2 / math.cosh(half),
        "end_slope_rad": couple * steep / pull * math.tanh(half),
    }


def twist_buckling(wire, inputs):
    """w'''' - i m w''' - t w'' = 0 over a unit length: 1, s, exp(i a s), exp(i b s), and the determinant of the clamped ends."""
    length, tension = inputs["L_m"], inputs["T_N"] * inputs["L_m"] ** 2 / wire["EI"]

    def determinant(over):
        # torque 2 sqrt(t) + over; a, b = mean +- apart
        torque = 2 * math.sqrt(tension) + over
        mean, apart = torque / 2, math.sqrt(over * (over + 4 * math.sqrt(tension))) / 2
        a, b = mean + apart, mean - apart
        value = -a * b * math.sin(apart) + 4 * apart * math.sin(a / 2) * math.sin(b / 2)
        return value / (a * apart**3) / (b * b if tension == 0 else 1)

    if tension == 0:
        torque = 2 * brentq(lambda x: math.sin(x) - x * math.cos(x), math.pi, 1.5 * math.pi, xtol=1e-15)
    else:
        torque = 2 * math.sqrt(tension) + first_roots(determinant, 1e-4, 1e-3, 1)[0]
    return {"critical_torque_Nm": torque * wire["EI"] / length, "critical_ML_over_EI": torque}


# wire that yields


class Law:
    """Bilinear moment of a curvature that only grows, its work and its complementary work."""

    def __init__(self, wire):
        self.stiff, self.soft, self.limit = wire["EI"], wire["EIp"], wire["M_y"]
        self.knee = self.limit / self.stiff

    def moment(self, curvature):
        return min(self.stiff * curvature, self.limit + self.soft * (curvature - self.knee))

    def complement(self, curvature):
        """M k - W."""
        elastic = min(curvature, self.knee)
        beyond = curvature - elastic
        return 0.5 * self.stiff * elastic**2 + self.soft * beyond * (self.knee + 0.5 * beyond)

    def curvature(self, complement):
        over = complement - 0.5 * self.stiff * self.knee**2
        if over <= 0:
            return math.sqrt(2 * complement / self.stiff)
        return math.sqrt(self.knee**2 + 2 * over / self.soft)


def corner_edge(wire, inputs):
    law, pull, half = Law(wire), inputs["T_N"], inputs["turn_rad"] / 2
    peak = law.curvature(2 * pull * math.sin(half / 2) ** 2)
    moment = law.moment(peak)
    return {
        "peak_curvature_1_per_m": peak, "peak_moment_Nm": moment, "standoff_from_leg_line_m": moment / pull,
        "edge_force_N": 2 * pull * math.sin(half),
    }


def square_loop(wire, inputs):
    """Half a side turns by 45 degrees; the curvature at its middle is such that it spans half a side."""
    law, pull, side = Law(wire), inputs["T_N"], inputs["side_m"]
    quarter = math.pi / 4

    def at(middle, angle):
        return law.curvature(law.complement(middle) + 2 * pull * math.sin(angle / 2) ** 2)

    def along(middle, what):
        # steep beside the middle: angle = sinh(u) of its own scale; kink where the wire begins to yield
        scale = max(math.sqrt(2 * law.complement(middle) / pull), 1e-12)
        knee = 0.5 * law.stiff * law.knee**2 - law.complement(middle)
        yields = 2 * math.asin(math.sqrt(knee / pull / 2)) if 0 < knee < 2 * pull * math.sin(quarter / 2) ** 2 else None
        points = [0.0, *([yields] if yields else []), quarter]
        sizes = [math.asinh(point / scale) for point in points]

        def piece(u):
            angle = scale * math.sinh(u)
            return what(angle) / at(middle, angle) * scale * math.cosh(u)

        return sum(quad(piece, a, b, epsabs=0, epsrel=1e-11, limit=200)[0] for a, b in zip(sizes, sizes[1:]))

    middle = math.exp(brentq(lambda x: along(math.exp(x), math.cos) - side / 2, math.log(1e-6), math.log(1e5), xtol=1e-13))
    edge = at(middle, quarter)
    return {
        "mid_curvature_1_per_m": middle, "edge_curvature_1_per_m": edge, "edge_moment_Nm": law.moment(edge),
        "bulge_m": along(middle, math.sin), "edge_force_N": 2 * pull * math.cos(quarter),
    }


def mandrel_springback(wire, inputs):
    law, bent = Law(wire), 1 / (inputs["R_m"] + wire["r"])
    moment = law.moment(bent)
    return {"curvature_loaded_1_per_m": bent, "moment_loaded_Nm": moment, "residual_curvature_isotropic_1_per_m": bent - moment / wire["EI"]}


def cyclic_bending(wire, inputs):
    """Isotropic hardening: the moment goes elastically up to the largest it had, then with the plastic rigidity."""
    moment, largest, before = 0.0, wire["M_y"], 0.0
    moments = []
    for curvature in inputs["curvature_path_1_per_m"]:
        trial = moment + wire["EI"] * (curvature - before)
        over = abs(trial) - largest
        if over > 0:
            largest += over * wire["EIp"] / wire["EI"]
            trial = math.copysign(largest, trial)
        moment, before = trial, curvature
        moments.append(moment)
    return {"moment_isotropic_Nm": moments}


# feed of a core that turns


def taut_line(inputs, radius, count):
    """Moment arm, its derivative by the core's angle and free length at `count` angles of a turn, m.

    Of the tangents from the nozzle to the circles at the four corners the one farthest out is the wire.
    """
    distance, corner = inputs["nozzle_distance_m"], inputs["corner_radius_m"] + radius
    wide, high = inputs["core_w_m"] / 2 - inputs["corner_radius_m"], inputs["core_h_m"] / 2 - inputs["corner_radius_m"]
    need(min(wide, high) > 0, "no flat is left between the corners")
    need(math.hypot(wide, high) + corner < distance, "the nozzle is within the core's reach")
    turned = np.exp(1j * 2 * math.pi * np.arange(count) / count)
    best = None
    for place in (wide + 1j * high, -wide + 1j * high, -wide - 1j * high, wide - 1j * high):
        centre = place * turned
        way = centre - distance
        size = np.abs(way)
        heading = np.mod(np.angle(way), 2 * math.pi) - np.arcsin(corner / size)
        # d(centre) = i centre per rad; the angle of the way, and of the tangent beside it
        grows = (np.conj(way) * 1j * centre).real / size
        free = np.sqrt(size**2 - corner**2)
        turns = (np.conj(way) * 1j * centre).imag / size**2 + corner / size * grows / free
        line = (heading, turns, free)
        best = line if best is None else tuple(np.where(heading < best[0], new, old) for new, old in zip(line, best))
    heading, turns, free = best
    return distance * np.sin(heading), distance * np.cos(heading) * turns, free


def winding_feed(wire, inputs):
    arm, grows, free = taut_line(inputs, wire["r"], 7200)
    width, height, corner = (inputs[name] for name in ("core_w_m", "core_h_m", "corner_radius_m"))
    return {
        "centreline_perimeter_m": 2 * (width + height - 4 * corner) + 2 * math.pi * (corner + wire["r"]),
        "p_min_m": arm.min(), "p_max_m": arm.max(), "dp_min_m_per_rad": grows.min(), "dp_max_m_per_rad": grows.max(),
        "free_length_min_m": free.min(), "free_length_max_m": free.max(), "mean_p_times_2pi_m": arm.mean() * 2 * math.pi,
    }


def feed_tension(wire, inputs):
    """Steady motion of tensioner and pulley under the wire that the core takes, a harmonic at a time."""
    count = 1 << 16
    arm, grows, _ = taut_line(inputs, wire["r"], count)
    speed, pull, stiffness = inputs["omega_rad_per_s"], inputs["T0_N"], inputs["line_stiffness_N_per_m"]
    mass, line = inputs["tensioner_mass_kg"], inputs["line_mass_kg"]
    damping = 2 * inputs["line_damping_ratio"] * math.sqrt(stiffness * mass)
    omega = speed * np.arange(1, count // 2 + 1)
    taken = np.fft.rfft(arm)[1:] / (1j * np.arange(1, count // 2 + 1))  # way of the wire at the nozzle beside its mean
    spring = stiffness + 1j * omega * damping
    pulley = inputs["pulley_mass_kg"] > 0 or inputs["pulley_friction_N"] > 0
    share = inputs["pulley_place"] if pulley else 1.0
    far, near = (spring / (1 - share) if pulley else None), spring / share
    if pulley:
        # balance of tensioner and pulley: (far - m w^2) x = far y, (far + near - M w^2) y = far x + near z
        first = far - omega**2 * (mass + line * (1 - share) / 2)
        second = far + near - omega**2 * (inputs["pulley_mass_kg"] + line / 2)
        y = near * taken * first / (first * second - far**2)
        x = far * y / first
    else:
        x = y = near * taken / (near - omega**2 * (mass + line / 2))

    def series(values):
        return np.fft.irfft(np.concatenate([[0], values]), count)

    slowest = [arm.mean() + series(1j * np.arange(1, count // 2 + 1) * way).min() for way in (x, y)]
    need(min(arm.min(), *slowest) > 0, "wire goes back")
    tension = pull + inputs["pulley_friction_N"] + series(near * (taken - y)) + line * share / 2 * speed**2 * grows
    need(tension.min() > 0, "the wire is slack")
    expected = {"tension_max_N": tension.max(), "tension_mean_N": tension.mean(), "tension_rms_N": tension.std()}
    return expected if line > 0 else {"tension_min_N": tension.min(), **expected}


# laws of this project


def wave_damping(wire, inputs):
    """y' = i y by BDF2 with steps of two lengths in turn, until its parasite is gone."""
    steps = [inputs["omega_h"], inputs["omega_h"] * inputs["step_ratio"]]
    older, old = 1.0, cmath.exp(1j * steps[1])
    ratio = None
    for _ in range(200):
        start = old
        for before, step in zip(steps[::-1], steps):
            s = step / before
            new = ((1 + s) * old - s * s / (1 + s) * older) / ((1 + 2 * s) / (1 + s) - 1j * step)
            older, old = old, new
        ratio = old / start
        older, old = older / old, 1.0
    turned = sum(steps)
    return {"decrement_per_period": -math.log(abs(ratio)) * 2 * math.pi / turned, "period_over_exact": turned / cmath.phase(ratio)}


def rolling_path(wire, inputs):
    """Bend and twist along the three legs in ever more increments, and where that leads.

    One edge of 0.3 mm for the packed wire of 0.7 mm, which goes with the diameter, as in a wind: the torque depends on it.
    """
    edge = 0.3 / 0.7 * wire["d"]
    coarse, fine = (roll_along(wire, inputs, edge, count) for count in (1500, 3000))
    return {name: [2 * b - a for a, b in zip(coarse[name], fine[name])] for name in fine}


def roll_along(wire, inputs, edge, count):
    """The edge between two clamps rolls to where the torques on it balance; moments of its first joint, N m."""
    curvature, roll, twist = inputs["curvature_1_per_m"], inputs["roll_rad"], inputs["twist_1_per_m"]
    harden, harder = (wire[a] * wire[b] / (wire[a] - wire[b]) for a, b in (("EI", "EIp"), ("GJ", "GJp")))
    half = edge / 2

    def bend(plastic, limit, strain):
        trial = wire["EI"] * (strain - plastic)
        flow = max(0.0, abs(trial) - limit) / (wire["EI"] + harden)
        plastic = plastic + (flow / abs(trial) * trial if flow > 0 else 0)
        return wire["EI"] * (strain - plastic), plastic, limit + harden * flow

    def turn(plastic, limit, strain):
        trial = wire["GJ"] * (strain - plastic)
        flow = max(0.0, abs(trial) - limit) / (wire["GJ"] + harder)
        plastic += math.copysign(flow, trial)
        return wire["GJ"] * (strain - plastic), plastic, limit + harder * flow

    # two joints; complex curvatures as vectors. Equal bends of both joints, whose histories are the same
    bent, turned, rolled = (0j, wire["M_y"]), [(0.0, wire["T_y"]), (0.0, wire["T_y"])], 0.0
    found = {"bend_moment_Nm": [], "torque_Nm": []}
    corners = [(0.0, 0.0, 0.0), (curvature, 0.0, 0.0), (curvature, roll, twist), (0.0, roll, twist)]
    for start, end in zip(corners, corners[1:]):
        for i in range(1, count + 1):
            k, direction, t = (a + (b - a) * i / count for a, b in zip(start, end))

            def states(angle):
                strain = k * cmath.exp(1j * (direction - angle / 2))
                moment = bend(*bent, strain)
                torques = [turn(*turned[0], t + angle / half), turn(*turned[1], t - angle / half)]
                across = (moment[0].conjugate() * strain).imag  # both joints, half of each
                return torques[0][0] - torques[1][0] + half * across, moment, torques

            reach = 1e-9
            while states(rolled - reach)[0] > 0 or states(rolled + reach)[0] < 0:
                reach *= 8
            rolled = brentq(lambda angle: states(angle)[0], rolled - reach, rolled + reach, xtol=1e-16, rtol=1e-15)
            _, moment, torques = states(rolled)
            bent, turned = moment[1:], [torque[1:] for torque in torques]
        found["bend_moment_Nm"] += [moment[0].real, moment[0].imag]
        found["torque_Nm"].append(torques[0][0])
    return found


def helix_gap(wire, inputs):
    """Stationary distance to the turn before: a^2 sin t = rise (pitch - rise t)."""
    axis, rise = inputs["R_m"] + wire["r"], inputs["pitch_m"] / (2 * math.pi)
    turn = brentq(lambda t: axis**2 * math.sin(t) - rise * (inputs["pitch_m"] - rise * t), 0, math.pi / 2, xtol=1e-15)
    gap = math.hypot(2 * axis * math.sin(turn / 2), inputs["pitch_m"] - rise * turn) - wire["d"]
    return {"gap_min_m": gap, "gap_max_m": gap}


def frozen_helix(wire, inputs):
    axis, rise, pull = inputs["R_m"] + wire["r"], inputs["pitch_m"] / (2 * math.pi), inputs["T0_N"]
    square = axis**2 + rise**2
    laid = pull - 0.5 * wire["EI"] * (axis / square) ** 2
    need(laid > 0, "the wire springs off the core")
    expected = {
        "fed_per_turn_m": 2 * math.pi * math.sqrt(square) / (1 + laid / wire["EA"]), "laid_radius_m": axis,
        "moved_by_freezing_m": 0.0, "tension_jump_by_freezing_N": 0.0,
    }
    if inputs["mu"] == 0:
        return {**expected, "laid_tension_N": laid}
    return {**expected, "laid_pitch_m": inputs["pitch_m"], "tension_without_friction_N": laid}


def live_pair(wire, inputs):
    """Depth of a contact of 1e10 N/m2 that is soft over 1 um for the packed wire, which goes with the diameter, as in a wind."""
    stiffness, onset = 1e10, 1e-6 / 0.7e-3 * wire["d"]
    soft = math.sqrt(2 * inputs["press_N_per_m"] * onset / stiffness)
    return {"approach_m": soft if soft <= onset else inputs["press_N_per_m"] / stiffness + onset / 2, "slip_exponent": inputs["mu"]}


def penalty_impact(wire, inputs):
    own, ratio = math.sqrt(inputs["k_N_per_m"] / inputs["mass_kg"]), inputs["damping_ratio"]
    damped = own * math.sqrt(1 - ratio**2)
    deepest = math.acos(ratio) / damped
    return {
        "contact_time_s": math.pi / damped, "restitution": math.exp(-ratio * own * math.pi / damped),
        "peak_penetration_m": inputs["v_m_per_s"] / damped * math.exp(-ratio * own * deepest) * math.sin(damped * deepest),
    }


KINDS = {
    f.__name__: f
    for f in (
        shoulder_drop, shoulder_static, groove_seat, spinning_ring, capstan, elastica_cantilever, end_couple, bulge_linear, hanging_wire,
        feed_tension, winding_feed, frozen_helix, live_pair, rolling_path, helix_gap, wave_damping, twist_buckling, torsion, square_loop,
        corner_edge, mandrel_springback, cyclic_bending, bending_modes, axial_wave, helix, grooved_capstan, penalty_impact,
    )
}
