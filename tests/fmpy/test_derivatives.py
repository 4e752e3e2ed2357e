"""Inputs that change within a step, and slopes of outputs."""

import math

import fmpy
import numpy as np
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


def test_fmpy_interpolates_inputs(fmu_path):
    time = np.array([0.0, 4e-3])
    signals = np.core.records.fromarrays([time, RATE * time], names="time,spindle_speed")
    result = fmpy.simulate_fmu(
        fmu_path,
        stop_time=4e-3,
        output_interval=1e-3,
        start_values={"scene.file": "fig8"},
        input=signals,
        output=["spindle_angle"],
        set_input_derivatives=True,
    )
    assert result["spindle_angle"] == pytest.approx(RATE * result["time"] ** 2 / 2, rel=1e-9)


def test_slopes_are_those_of_the_outputs(slave):
    ramp(slave, 40, 1e-4, derivatives=True)
    names = ["spindle_angle", "fed_length", "wire_tension", "spindle_torque", "feed_speed"]
    references = slave.references(names)
    slopes = slave.fmu.getRealOutputDerivatives(references, [1] * len(names))
    before = [slave.get(name) for name in names]
    state = slave.fmu.getFMUstate()
    assert slopes[0] == slave.get("spindle_speed")
    assert slopes[1] == slave.get("feed_speed")
    tiny = 1e-7
    slave.fmu.setRealInputDerivatives(slave.references(["spindle_speed"]), [1], [RATE])
    slave.fmu.doStep(40 * 1e-4, tiny)
    for name, slope, value in zip(names, slopes, before):
        ahead = (slave.get(name) - value) / tiny
        scale = max(abs(ahead), {"wire_tension": 5e3, "spindle_torque": 50, "feed_speed": 500}.get(name, 0))
        assert abs(slope - ahead) < 0.5 * scale, name
    slave.fmu.setFMUstate(state)
    assert slave.fmu.getRealOutputDerivatives(references, [1] * len(names)) == slopes
    slave.fmu.freeFMUstate(state)


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
