"""What goes wrong in the field: an error, a reason in the log, and an instance as it was."""

import math

import pytest
from conftest import DISCARD, ERROR, WARNING
from fmpy.fmi1 import FMICallException

STEP = 2e-5


def refused(slave, call, *arguments, **named):
    """The reason that a call was refused for."""
    told = len(slave.log)
    with pytest.raises(FMICallException) as caught:
        call(*arguments, **named)
    assert caught.value.status == ERROR
    assert len(slave.log) == told + 1
    _, status, category, reason = slave.log[-1]
    assert (status, category) == (ERROR, "logStatusError")
    return reason


def still_steps(slave, time=0.0):
    slave.fmu.doStep(time, STEP)
    assert math.isfinite(slave.get("wire_tension"))


def test_parameters_out_of_range(slave):
    for name, value in (("wire.diameter", -1.0), ("tensioner.mass", math.nan)):
        reason = refused(slave, slave.fmu.setReal, slave.references([name]), [value])
        assert name in reason
    reason = refused(slave, slave.fmu.setString, slave.references(["core.shape"]), ["sphere"])
    assert "core.shape" in reason and "cylinder" in reason
    reason = refused(slave, slave.fmu.setString, slave.references(["scene.file"]), ["no_such"])
    assert "no_such" in reason
    slave.start()
    still_steps(slave)


def test_one_bad_value_sets_none(slave):
    names = ["friction.static", "friction.kinetic"]
    start = [float(slave.variables[name].start) for name in names]
    refused(slave, slave.fmu.setReal, slave.references(names), [0.5, math.inf])
    slave.start()
    assert slave.fmu.getReal(slave.references(names)) == start


def test_unknown_references_and_wrong_types(slave):
    assert "4000000000" in refused(slave, slave.fmu.setReal, [4_000_000_000], [1.0])
    shape = slave.references(["core.shape"])
    assert "String" in refused(slave, slave.fmu.setReal, shape, [1.0])
    slave.start()
    assert "4000000000" in refused(slave, slave.fmu.getReal, [4_000_000_000])
    assert "String" in refused(slave, slave.fmu.getReal, shape)
    tension = slave.references(["wire_tension"])
    assert "calculated" in refused(slave, slave.fmu.setReal, tension, [1.0])
    still_steps(slave)


@pytest.mark.parametrize("value", (math.nan, math.inf, -math.inf))
def test_inputs_that_are_no_numbers(slave, value):
    slave.start()
    before = slave.get("spindle_speed")
    reason = refused(slave, slave.fmu.setReal, slave.references(["spindle_speed"]), [value])
    assert "spindle_speed" in reason
    assert slave.get("spindle_speed") == before
    still_steps(slave)


def test_inputs_out_of_range_are_held_and_the_run_goes_on(slave):
    slave.start()
    told = len(slave.log)
    slave.set(tension_setpoint=-5.0, spindle_speed=1e6)
    assert (slave.get("tension_setpoint"), slave.get("spindle_speed")) == (0.0, 2000.0)
    # (besides, the demonstration ends)
    held = [entry for entry in slave.log[told:] if entry[2] != "logEvents"]
    assert [entry[1:3] for entry in held] == [(WARNING, "logStatusWarning")] * 2
    assert "held at 0" in held[0][3]
    slave.set(tension_setpoint=15.0, spindle_speed=0.0)
    tension = slave.references(["tension_setpoint"])
    slave.fmu.setRealInputDerivatives(tension, [1], [-1e9])
    slave.fmu.doStep(0.0, STEP)
    assert slave.log[-1][1] == WARNING
    assert slave.get("tension_setpoint") == pytest.approx(0.0, abs=1e-9)
    still_steps(slave, STEP)


def test_the_tolerance_of_the_experiment(make_slave, description):
    assert float(description.defaultExperiment.tolerance) == 1e-4
    solved = []
    for tolerance in (None, 1e-4, 5e-4, 1e-9):
        slave = make_slave()
        slave.fmu.setupExperiment(tolerance=tolerance)
        slave.fmu.enterInitializationMode()
        slave.fmu.exitInitializationMode()
        told = [entry for entry in slave.log if "tolerance" in entry[3]]
        solved.append((slave.get("solver.tolerance"), len(told)))
    assert solved == [(0.0, 0), (0.0, 0), (pytest.approx(1e-5), 1), (1e-9, 1)]
    slave = make_slave()
    assert "above 0" in refused(slave, slave.fmu.setupExperiment, tolerance=-1.0)


def test_calls_out_of_order(slave):
    fmu = slave.fmu
    for call in (fmu.exitInitializationMode, fmu.terminate):
        assert "instantiated" in refused(slave, call)
    assert "instantiated" in refused(slave, fmu.doStep, 0.0, STEP)
    slave.start()
    assert "communication point" in refused(slave, fmu.enterInitializationMode)
    assert "communication point" in refused(slave, fmu.setupExperiment)
    still_steps(slave)
    fmu.terminate()
    assert "terminated" in refused(slave, fmu.doStep, STEP, STEP)
    assert math.isfinite(slave.get("wire_tension"))
    fmu.reset()
    slave.start()
    still_steps(slave)


def test_fixed_parameters_after_the_start_and_tunable_ones(slave):
    slave.start()
    reason = refused(slave, slave.fmu.setReal, slave.references(["wire.diameter"]), [1e-3])
    assert "fixed" in reason
    slave.set(friction__static=0.3)
    assert slave.get("friction.static") == 0.3
    still_steps(slave)


def test_steps_that_make_no_sense(slave):
    slave.start(start_time=1.0, stop_time=1.0 + 2 * STEP)
    step = slave.fmu.doStep
    for point, size, word in (
        (1.0, 0.0, "above 0"),
        (1.0, -STEP, "above 0"),
        (1.0, math.nan, "finite"),
        (0.0, STEP, "last step ended at 1"),
        (1.0, 3 * STEP, "stopTime"),
    ):
        assert word in refused(slave, step, point, size)
    step(1.0, STEP)
    step(1.0 + STEP, STEP)
    assert "stopTime" in refused(slave, step, 1.0 + 2 * STEP, STEP)
    assert slave.fmu.getRealStatus(2) == 1.0 + STEP + STEP


def test_no_asynchronous_step_is_ever_pending(slave):
    slave.start()
    with pytest.raises(FMICallException) as caught:
        slave.fmu.getStatus(0)
    assert caught.value.status == DISCARD
    still_steps(slave)


def test_directional_derivatives_are_of_outputs_by_inputs(slave):
    slave.start()
    tension, speed = (slave.references([name]) for name in ("wire_tension", "spindle_speed"))
    flag, diameter, local = (slave.references([name]) for name in ("defect_gap", "wire.diameter", "energy_residual"))
    derivative = slave.fmu.getDirectionalDerivative
    assert "knowns are inputs" in refused(slave, derivative, tension, diameter, [1.0])
    assert "knowns are inputs" in refused(slave, derivative, tension, tension, [1.0])
    assert "unknowns are outputs" in refused(slave, derivative, speed, speed, [1.0])
    # a result that is no output had the derivative 0
    assert "unknowns are outputs" in refused(slave, derivative, local, speed, [1.0])
    assert "it is not an output" in refused(slave, slave.fmu.getRealOutputDerivatives, local, [1])
    assert "finite" in refused(slave, derivative, tension, speed, [math.nan])
    assert refused(slave, derivative, flag, speed, [1.0])
    still_steps(slave)


def test_a_foreign_guid_gives_no_instance(make_slave, description, monkeypatch):
    monkeypatch.setattr(description, "guid", "{00000000-0000-0000-0000-000000000000}")
    with pytest.raises(Exception, match="instantiate"):
        make_slave()


def test_nothing_but_errors_without_logging(make_slave):
    quiet = make_slave(logging_on=False)
    quiet.start()
    assert quiet.log == []
    quiet.fmu.setDebugLogging(True, ["logEvents"])
    assert "logNonsense" in refused(quiet, quiet.fmu.setDebugLogging, True, ["logNonsense"])
