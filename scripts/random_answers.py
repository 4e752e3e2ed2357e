#!/usr/bin/env python3
"""Exact answers for parameters drawn at random: what `coilwind verify` has wrong beyond the packed cases.

    scripts/random_answers.py [--command PATH] [--seed 1] [--count 4] [--preset default] [--out FOLDER] [KIND...]
    scripts/random_answers.py --check

Draws COUNT cases of each kind for each wire: the packed one of 0.7 mm, and copper of 0.2 and 1.2 mm. Expected values are those of
exact.py, tolerances those of the packed cases. Kinds that take long have fewer cases. Prints a table of what is not right, and
writes the case files and all numbers to FOLDER. Exits with 1 if something is wrong.

--check computes the packed cases instead, runs nothing, and exits with 1 unless every expected value is found again.

Needs numpy and scipy: `$(scripts/venv.sh study) scripts/random_answers.py`.
"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import exact
import tables

CASES = tables.ROOT / "tests" / "reference"
WIRES = {"0.7 mm packed": None, "0.2 mm copper": 0.2e-3, "1.2 mm copper": 1.2e-3}
PACKED = 0.7e-3
"""Diameter of the packed wire, m. Lengths go with the diameter, forces with its square, moments with its cube."""

SLOW = {"live_pair": 0.25, "frozen_helix": 0.5, "capstan": 0.5, "grooved_capstan": 0.5, "hanging_wire": 0.5}
"""Share of COUNT that kinds get whose cases take seconds."""

ROUGHLY = {"feed_tension": 1e-4, "rolling_path": 3e-5}
"""Relative precision to which packed values are found again; 1e-6 otherwise."""

TRIES = 1000


class Draw:
    """Random inputs for a wire, of three digits, as people write them."""

    def __init__(self, rng, wire):
        self.rng, self.wire = rng, wire
        self.scale = wire["d"] / PACKED

    def even(self, low, high):
        return digits(self.rng.uniform(low, high))

    def wide(self, low, high):
        """Evenly in the logarithm."""
        return digits(math.exp(self.rng.uniform(math.log(low), math.log(high))))

    def length(self, low, high):
        return self.wide(low * self.scale, high * self.scale)

    def force(self, low, high):
        return self.wide(low * self.scale**2, high * self.scale**2)

    def one(self, *choices):
        return choices[self.rng.integers(len(choices))]

    def chance(self, share):
        return self.rng.random() < share


def digits(value):
    return float(f"{value:.3g}")


def shoulder_drop(draw):
    mu = draw.wide(0.05, 0.35)
    lam = draw.one(0.0, draw.even(-0.8 * mu, 0.8 * mu))
    angle = draw.even(4, 60)
    offset = draw.wire["d"] * math.sin(math.radians(angle))
    return {"start_angle_deg": angle, "start_offset_m": offset, "mu": mu, "lam": max(-0.12, min(0.12, lam))}


def shoulder_static(draw):
    mu, lam = draw.wide(0.05, 0.5), draw.one(0.0, draw.even(-0.2, 0.2))
    exact.need(abs(math.atan(mu) - math.atan(lam)) > 0.05, "the offset is next to nothing")
    return {"mu": mu, "lam": lam}


def groove_seat(draw):
    pitch = digits(draw.even(1.0, 1.5) * draw.wire["d"])
    exact.need(pitch >= draw.wire["d"], "the wires of the groove overlap")
    lean = math.tan(math.asin(pitch / 2 / draw.wire["d"]))
    return {"pitch_m": pitch, "lam": draw.one(0.0, draw.even(-0.7 * lean, 0.7 * lean))}


def spinning_ring(draw):
    inputs = {"omega_rad_per_s": draw.wide(30, 1000), "R_m": draw.length(0.005, 0.04), "T0_N": draw.force(0.3, 40)}
    pulls_out = draw.wire["rhoA"] * (inputs["omega_rad_per_s"] * inputs["R_m"]) ** 2
    exact.need(pulls_out < 0.8 * inputs["T0_N"], "close to lift-off")
    return inputs


def slips(draw):
    inputs = {"mu": draw.wide(0.06, 0.4), "wrap_rad": math.radians(draw.even(60, 270)), "R_m": draw.length(0.025, 0.15)}
    inputs["F0_N"] = draw.force(3, 40)
    bent = draw.wire["EI"] / 2 / (inputs["R_m"] + draw.wire["r"]) ** 2
    exact.need(bent < 0.25 * inputs["F0_N"], "stiffer than any packed case")
    return inputs


def capstan(draw):
    return slips(draw)


def grooved_capstan(draw):
    inputs = {**slips(draw), "groove_rad": math.radians(draw.even(50, 130))}
    rate = inputs["mu"] / math.sin(inputs["groove_rad"] / 2)
    exact.need(rate * inputs["wrap_rad"] < 1.5, "a ratio far beyond that of any packed case")
    return inputs


def elastica_cantilever(draw):
    return {"alpha": draw.wide(0.3, 15), "L_m": draw.length(0.02, 0.15)}


def end_couple(draw):
    return {"fraction": draw.even(0.05, 1.0), "L_m": draw.length(0.02, 0.15)}


def bulge_linear(draw):
    inputs = {"T_N": draw.force(2, 40), "span_m": draw.length(0.005, 0.05), "M_Nm": digits(draw.wide(0.3, 3) * draw.wire["M_y"])}
    exact.need(exact.bulge_linear(draw.wire, inputs)["end_slope_rad"] < 0.055, "beyond the linear formula")
    return inputs


def hanging_wire(draw):
    span = draw.length(1.0, 5.0)
    return {"span_m": span, "length_m": digits(span * draw.even(1.01, 1.08))}


def core(draw):
    width, height = draw.length(0.008, 0.04), draw.length(0.008, 0.04)
    corner = digits(min(width, height) * draw.even(0.08, 0.35))
    distance = digits(draw.even(1.5, 4) * math.hypot(width, height))
    return {"core_w_m": width, "core_h_m": height, "corner_radius_m": corner, "nozzle_distance_m": distance}


def winding_feed(draw):
    return {**core(draw), "T0_N": draw.force(5, 30), "line_length_m": 0.5, "line_damping_ratio": 0.1}


def feed_tension(draw):
    inputs = {
        **core(draw),
        "T0_N": draw.force(8, 30),
        "line_stiffness_N_per_m": draw.force(5e4, 2e5),
        "line_damping_ratio": draw.even(0.05, 0.3),
        "omega_rad_per_s": draw.wide(50, 400),
        "tensioner_mass_kg": draw.force(3e-4, 4e-3),
        "line_mass_kg": 0.0 if draw.chance(0.6) else draw.force(5e-4, 3e-3),
        "pulley_mass_kg": 0.0,
        "pulley_friction_N": 0.0,
        "pulley_place": 0.5,
    }
    if draw.chance(0.4):
        inputs.update({"pulley_mass_kg": draw.force(1e-3, 6e-3), "pulley_friction_N": draw.force(0.3, 4), "pulley_place": draw.even(0.3, 0.8)})
    # swings about twice those of the packed cases; beyond, wire goes slack
    found, pull = exact.feed_tension(draw.wire, inputs), inputs["T0_N"]
    exact.need(found["tension_rms_N"] < 0.25 * pull and found.get("tension_min_N", pull) > 0.4 * pull, "swings beyond any packed case")
    # waves of the free span are 100 times as fast as the core, and may not be slower than what swings behind it
    spring, share, line = inputs["line_stiffness_N_per_m"], inputs["pulley_place"], inputs["line_mass_kg"]
    quickest = [spring / (inputs["tensioner_mass_kg"] + line / 2)]
    if inputs["pulley_mass_kg"] > 0:
        quickest[0] = spring / (1 - share) / (inputs["tensioner_mass_kg"] + line * (1 - share) / 2)
        quickest.append(spring / share / (1 - share) / (inputs["pulley_mass_kg"] + line / 2))
    exact.need(0.01 * math.sqrt(max(quickest)) < 2.5 * inputs["omega_rad_per_s"], "quicker than the free span of any packed case")
    return inputs


def frozen_helix(draw):
    inputs = {"R_m": draw.length(0.01, 0.08), "pitch_m": digits(draw.even(1.1, 3) * draw.wire["d"]), "T0_N": draw.force(5, 30)}
    inputs.update({"mu": draw.one(0.0, draw.wide(0.08, 0.5)), "omega_rad_per_s": draw.wide(4, 40)})
    bent = 0.5 * draw.wire["EI"] / (inputs["R_m"] + draw.wire["r"]) ** 2
    exact.need(bent < 0.5 * inputs["T0_N"], "stiffer than any packed case")
    # without friction the pitch is not what the nozzle lays, and the wire swings to and fro along the core for long
    slope = inputs["pitch_m"] / (2 * math.pi * inputs["R_m"])
    exact.need(inputs["mu"] > 0 or 0.5 * slope**2 < 5e-5, "the pitch counts in the length of a turn")
    exact.need(inputs["omega_rad_per_s"] * inputs["R_m"] < 0.6, "faster than any packed case")
    return inputs


def live_pair(draw):
    radius = draw.length(0.006, 0.02)
    inputs = {"R_m": radius, "T0_N": draw.force(40, 80), "press_N_per_m": digits(draw.wide(2000, 8000) * draw.scale), "mu": draw.wide(0.08, 0.25)}
    return {**inputs, "drawn_m": digits(0.06 * radius)}


def rolling_path(draw):
    bend, turn = draw.wide(1, 150) / draw.scale, draw.one(0.0, draw.even(0.5, 60)) / draw.scale
    return {"curvature_1_per_m": digits(bend), "roll_rad": draw.even(-3, 3), "twist_1_per_m": digits(turn)}


def helix_gap(draw):
    return {"R_m": draw.length(0.003, 0.1), "pitch_m": digits(draw.even(1.0, 3) * draw.wire["d"])}


def wave_damping(draw):
    mode = draw.one(1, 2, 3)
    return {"L_m": draw.length(0.05, 0.3), "mode": mode, "omega_h": draw.wide(0.07, 0.25), "step_ratio": draw.even(0.5, 1.6)}


def twist_buckling(draw):
    length = draw.length(0.06, 0.4)
    inputs = {"L_m": length, "T_N": 0.0 if draw.chance(0.25) else draw.force(1, 20)}
    exact.need(length * math.sqrt(inputs["T_N"] / draw.wire["EI"]) < 17, "twice as many bending lengths as any packed case")
    return inputs


def torsion(draw):
    return {"L_m": draw.length(0.05, 0.6), "torque_Nm": digits(draw.wide(0.1, 1) * draw.wire["T_y"])}


def axial_wave(draw):
    return {"L_m": draw.length(0.05, 1.0), "P_N": draw.force(2, 40)}


def square_loop(draw):
    inputs = {"T_N": draw.force(2, 30), "side_m": draw.length(0.008, 0.04)}
    found = exact.square_loop(draw.wire, inputs)
    exact.need(found["mid_curvature_1_per_m"] > 0.015 * found["edge_curvature_1_per_m"], "straight in the middle")
    return inputs


def corner_edge(draw):
    return {"T_N": draw.force(2, 30), "turn_rad": math.radians(draw.even(30, 120))}


def mandrel_springback(draw):
    return {"R_m": draw.length(0.001, 0.04)}


def cyclic_bending(draw):
    most = draw.wide(2, 200) / draw.scale
    return {"curvature_path_1_per_m": [draw.even(-most, most) for _ in range(draw.one(3, 4, 5, 6, 7))]}


def bending_modes(draw):
    ends = draw.one("clamped-free", "clamped-clamped", "pinned-pinned")
    return {"bc": ends, "T_N": 0 if draw.chance(0.3) else draw.force(1, 25), "L_m": draw.length(0.025, 0.12)}


def helix(draw):
    turn = draw.one(0.0, draw.even(-20, 20)) / draw.scale
    return {"R_m": draw.length(0.01, 0.1), "pitch_m": draw.length(0.005, 0.08), "twist_density_1_per_m": digits(turn)}


def penalty_impact(draw):
    inputs = {"mass_kg": draw.wide(1e-6, 1e-5), "k_N_per_m": draw.wide(5e5, 5e6), "v_m_per_s": draw.wide(0.3, 10)}
    return {**inputs, "damping_ratio": draw.one(0.0, draw.even(0.02, 0.5))}


DRAWS = [
    shoulder_drop, shoulder_static, groove_seat, spinning_ring, capstan, elastica_cantilever, end_couple, bulge_linear, hanging_wire,
    feed_tension, winding_feed, frozen_helix, live_pair, rolling_path, helix_gap, wave_damping, twist_buckling, torsion, square_loop,
    corner_edge, mandrel_springback, cyclic_bending, bending_modes, axial_wave, helix, grooved_capstan, penalty_impact,
]
"""What draws the inputs of a kind, those that matter most to a winder first."""


def packed(kind):
    return json.loads((CASES / f"{kind}.json").read_text(encoding="utf-8"))


def plain(value):
    """A value as JSON has it."""
    if isinstance(value, list):
        return [plain(v) for v in value]
    return value if isinstance(value, (bool, str)) else float(value)


def drawn(kind, draw, count):
    """Cases whose answers the formulas know."""
    cases = []
    tries = 0
    while len(cases) < count:
        tries += 1
        if tries > TRIES * count:
            raise SystemExit(f"{kind.__name__}: no inputs were found that the formulas hold for")
        try:
            inputs = kind(draw)
            expected = exact.KINDS[kind.__name__](draw.wire, inputs)
        except exact.NotModelled:
            continue
        cases.append({"id": f"case{len(cases) + 1}", "inputs": inputs, "expected": {name: plain(v) for name, v in expected.items()}})
    return cases


def counts(check, preset):
    return any(how.get("preset", preset) == preset for how in check.values())


def case_files(folder, args):
    """A file for each kind and wire: kind, wire, path, cases."""
    folder.mkdir(parents=True, exist_ok=True)
    for place, kind in enumerate(DRAWS):
        name = kind.__name__
        doc = packed(name)
        if args.kinds and name not in args.kinds or not counts(doc["check"], args.preset):
            continue
        count = max(1, round(args.count * SLOW.get(name, 1)))
        for number, (wire, diameter) in enumerate(WIRES.items()):
            record = doc["wire"] if diameter is None else exact.copper(diameter)
            rng = np.random.default_rng([args.seed, place, number])
            cases = drawn(kind, Draw(rng, record), count)
            path = folder / f"{name}-{wire.split()[0]}mm.json"
            text = json.dumps({**doc, "wire": record, "cases": cases}, indent=1) + "\n"
            path.write_text(text, encoding="utf-8")
            yield name, wire, path, cases


def verified(args, path):
    """What `coilwind verify` says of each quantity of a case file."""
    words = [args.command, "verify", "--json", "--preset", args.preset, "--file", str(path)]
    for setting in args.set:
        words += ["--set", setting]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if not done.stdout.strip():
        raise SystemExit(f"{' '.join(words)}: {done.stderr.strip()}")
    return [json.loads(line) for line in done.stdout.splitlines()]


def share(record, inputs):
    """Error over the widest bound that the check allows; None where there is no number."""
    check, expected, got = record["tolerance"], record["expected"], record["got"]
    if got is None or isinstance(got, bool) or "equal" in check:
        return None
    bounds = [check.get("rel", 0) * abs(expected), check.get("abs", 0)]
    bounds.append(check.get("tol", 0) * abs(inputs[check["abs_of"]]) if "abs_of" in check else 0)
    return abs(got - expected) / max(bounds) if max(bounds) > 0 else None


def row(wire, record, inputs):
    part = share(record, inputs)
    told = ", ".join(f"{name} {value:.4g}" if isinstance(value, float) else f"{name} {value}" for name, value in inputs.items())
    got = record.get("error") or number(record["got"])
    setup = "" if record["setup"] == "wind" else f" ({record['setup']})"
    kind, beyond = f"`{record['kind']}`{setup}", "-" if part is None else f"{100 * part:.0f} %"
    return [kind, wire, told, record["quantity"], number(record["expected"]), got, beyond]


def number(value):
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def run(args, folder):
    rows, every, wrong = [], [], 0
    for kind, wire, path, cases in case_files(folder, args):
        records = verified(args, path)
        inputs = {case["id"]: case["inputs"] for case in cases}
        bad = [record for record in records if record["ok"] is not True]
        every += [{**record, "wire": wire, "inputs": inputs[record["id"]]} for record in records]
        rows += [row(wire, record, inputs[record["id"]]) for record in bad]
        wrong += len(bad)
        parts = [part for part in (share(record, inputs[record["id"]]) for record in records) if part is not None]
        took = sum({record["id"]: record["cpu_s"] for record in records}.values())
        nearest = f"{100 * max(parts):.0f} % of the tolerance" if parts else "no number"
        print(f"{kind}, {wire}: {len(records) - len(bad)} of {len(records)} right, {nearest}, {took:.1f} s", file=sys.stderr, flush=True)
    text = "".join(json.dumps(record) + "\n" for record in every)
    (folder / "numbers.jsonl").write_text(text, encoding="utf-8")
    kinds = len({record["kind"] for record in every})
    print(f"seed {args.seed}, preset {args.preset}: {len(every) - wrong} of {len(every)} numbers of {kinds} kinds are right")
    if rows:
        print("\n" + tables.table(["kind", "wire", "inputs", "quantity", "expected", "got", "share of tolerance"], rows))
    return 1 if wrong else 0


def found_again(kind):
    """Whether the packed answers of a kind are found from its packed inputs; every number that is checked has to be there."""
    doc = packed(kind)
    nearest, right = 0.0, True
    for case in doc["cases"]:
        found = exact.KINDS[kind](doc["wire"], case["inputs"])
        lacking = [name for name in doc["check"] if name in case["expected"] and name not in found]
        more = [name for name in doc["check"] if name in found and name not in case["expected"]]
        for name in lacking + more:
            print(f"{kind}, {case['id']}: {name} is not in {'exact.py' if name in lacking else 'the packed case'}")
            right = False
        for name, value in found.items():
            if name not in case["expected"]:
                continue
            pairs = zip(*(np.atleast_1d(v).tolist() for v in (value, case["expected"][name])))
            for ours, theirs in pairs:
                off = off_by(ours, theirs, case["inputs"])
                nearest = max(nearest, off)
                if off > ROUGHLY.get(kind, 1e-6):
                    print(f"{kind}, {case['id']}: {name} is {ours!r}, the packed case has {theirs!r}")
                    right = False
    print(f"{kind}: {len(doc['cases'])} packed cases, off by {nearest:.1e} at most")
    return right


def off_by(ours, theirs, inputs):
    """Relative difference; beside a length of the inputs, or 1e-4, where the answer is 0."""
    if isinstance(theirs, bool):
        return float(ours != theirs)
    least = inputs.get("L_m", 1e-4)
    return abs(ours - theirs) / max(abs(theirs), 1e-6 * least)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kinds", nargs="*", metavar="KIND")
    parser.add_argument("--command", default="target/release/coilwind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=4, help="cases of a kind for each wire")
    parser.add_argument("--preset", default="default", choices=("default", "paper"))
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="passed on to coilwind verify")
    parser.add_argument("--out", type=Path, help="folder for case files and numbers")
    parser.add_argument("--check", action="store_true", help="find the packed answers again, and run nothing")
    args = parser.parse_args()
    unknown = sorted(set(args.kinds) - set(exact.KINDS))
    if unknown:
        parser.error(f"{unknown[0]}: allowed: {', '.join(exact.KINDS)}")
    if args.check:
        found = [found_again(kind) for kind in args.kinds or exact.KINDS]
        return 0 if all(found) else 1
    if args.out:
        return run(args, args.out)
    with tempfile.TemporaryDirectory() as folder:
        return run(args, Path(folder))


if __name__ == "__main__":
    sys.exit(main())
