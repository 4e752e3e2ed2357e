"""Inputs that change within a step, and slopes of outputs."""

import math

import pytest
from conftest import ERROR
from fmpy.fmi1 import FMICallException

RATE = 6e4


def ramp(slave, steps, size, derivatives):
    """Speeds up evenly from rest, the nozzle along with the core."""
    slave.start(scene__file="fig8")
    references = slave.references(["spindle_speed", "nozzle_position"])
    for k in range(steps):
        t = k * size
        slave.set(spindle_speed=RATE * t)
        pitch = 0.7e-3 / (2 * math.pi)
        if derivatives:
            slave.set(nozzle_position=pitch * RATE * t * t / 2)
            mean = pitch * RATE * (t + size / 2)
            slave.fmu.setRealInputDerivatives(references, [1, 1], [RATE, mean])
        else:
            slave.set(nozzle_position=pitch * RATE * (t + size) ** 2 / 2)
        slave.fmu.doStep(t, size)
    return slave


def test_a_ramp_within_long_steps(make_slave):
    long = ramp(make_slave("long"), 4, 1e-3, derivatives=True)
    assert long.get("spindle_angle") == pytest.approx(RATE * 4e-3**2 / 2, rel=1e-12)
    assert long.get("spindle_speed") == pytest.approx(RATE * 4e-3, rel=1e-12)
    fine = ramp(make_slave("fine"), 400, 1e-5, derivatives=True)
    held = ramp(make_slave("held"), 4, 1e-3, derivatives=False)
    fed = [s.get("fed_length") for s in (fine, long, held)]
    # held speeds lag by half a step: an eighth of the angle here
    assert abs(fed[1] - fed[0]) < 0.01 * fed[0] < abs(fed[2] - fed[0])


def test_slopes_are_those_of_the_outputs(slave):
    ramp(slave, 40, 1e-4, derivatives=True)
    names = [
        "wire_tension", "spindle_torque", "feed_speed", "free_length", "turns_wound",
        "layon_position", "layon_angle", "spindle_angle", "fed_length", "gap_width",
    ]
    references = slave.references(names)
    before = [slave.get(name) for name in names]
    tiny = 1e-6
    slave.fmu.setRealInputDerivatives(slave.references(["spindle_speed"]), [1], [RATE])
    slave.fmu.doStep(40 * 1e-4, tiny)
    slopes = slave.fmu.getRealOutputDerivatives(references, [1] * len(names))
    after = [slave.get(name) for name in names]
    # the solver makes one step of a step that short, so changes over either are the same
    for name, slope, old, new in list(zip(names, slopes, before, after))[:7]:
        assert slope == pytest.approx((new - old) / tiny, rel=1e-6, abs=1e-6), name
    assert slopes[7:] == [slave.get("spindle_speed"), slave.get("feed_speed"), 0.0]
    state = slave.fmu.getFMUstate()
    slave.fmu.doStep(40 * 1e-4 + tiny, tiny)
    slave.fmu.setFMUstate(state)
    assert slave.fmu.getRealOutputDerivatives(references, [1] * len(names)) == slopes
    slave.fmu.freeFMUstate(state)


def test_nothing_has_a_slope_at_the_start(slave):
    slave.start(scene__file="fig8")
    references = slave.references(["wire_tension", "spindle_angle", "free_length"])
    assert slave.fmu.getRealOutputDerivatives(references, [1, 1, 1]) == [0.0, 0.0, 0.0]


@pytest.mark.parametrize("order", (0, 2))
def test_other_orders_are_refused(slave, order):
    slave.start(scene__file="fig8")
    for call in (
        lambda: slave.fmu.setRealInputDerivatives(slave.references(["spindle_speed"]), [order], [1.0]),
        lambda: slave.fmu.getRealOutputDerivatives(slave.references(["wire_tension"]), [order]),
    ):
        with pytest.raises(FMICallException) as caught:
            call()
        assert caught.value.status == ERROR
        assert f"order {order}" in slave.reason()


OUTPUTS = [
    "wire_tension", "spindle_torque", "feed_speed", "fed_length", "free_length",
    "layon_position", "layon_angle", "turns_wound", "spindle_angle", "gap_width",
]


@pytest.mark.parametrize("steps", (20, 150))
def test_directional_derivatives_against_saved_states(slave, steps):
    """Every output by every input, and along a direction, against steps from the same state."""
    size = 1e-5
    # a step of the solver per communication step, solved so well that differences mean something
    slave.start(scene__file="fig8", solver__step=size, solver__tolerance=1e-9)
    for k in range(steps):
        slave.set(spindle_speed=RATE * k * size)
        slave.fmu.doStep(k * size, size)
    now = steps * size
    base = {name: slave.get(name) for name in ("spindle_speed", "nozzle_position", "tension_setpoint")}
    state = slave.fmu.getFMUstate()

    def after(changes):
        slave.fmu.setFMUstate(state)
        slave.set(**{name: base[name] + by for name, by in changes.items()})
        slave.fmu.doStep(now, size)
        return [slave.get(name) for name in OUTPUTS]

    directions = [
        {"spindle_speed": 0.05},
        {"nozzle_position": 2e-7},
        {"tension_setpoint": 0.05},
        {"spindle_speed": 0.02, "nozzle_position": -1e-7, "tension_setpoint": 0.03},
    ]
    for changes in directions:
        slave.fmu.setFMUstate(state)
        known = slave.references(list(changes))
        got = slave.fmu.getDirectionalDerivative(slave.references(OUTPUTS), known, list(changes.values()))
        plus, minus = after(changes), after({name: -by for name, by in changes.items()})
        for name, slope, up, down in zip(OUTPUTS, got, plus, minus):
            want = (up - down) / 2
            assert slope == pytest.approx(want, rel=5e-3, abs=2e-9 * (1 + abs(up))), (name, changes)
        assert got[-1] == 0.0
        if changes.get("tension_setpoint", 0.0) > 0.0:
            assert got[0] > 0.0
    slave.fmu.freeFMUstate(state)
