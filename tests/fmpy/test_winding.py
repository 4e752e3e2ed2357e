"""Winding runs through fmpy: the speeds of Fig. 8, and the same numbers as the native command."""

import csv
import json
import math
import subprocess

import fmpy
import numpy as np
import pytest
from drive import run, start, step
from signals import duration, winding_signals, write_csv

SCENE = "fig8"
PITCH = 0.7e-3
TURNS = 0.4
"""Enough for a landing on the first corner; the time of a test grows with the turns."""
STEPS = 40
SPEEDS = (30, 100, 300, 500)


def signals_of(speed, slave, turns=TURNS, n=STEPS):
    """Signals that start where the scene's nozzle starts."""
    slave.fmu.setupExperiment()
    slave.set(scene__file=SCENE)
    slave.fmu.enterInitializationMode()
    y0 = slave.get("nozzle_position")
    slave.fmu.reset()
    return winding_signals(speed, turns, PITCH, y0, n), duration(speed, turns) / n


@pytest.fixture(scope="session")
def recorded(fmu_path):
    """Results of fmpy's own master at one speed, each speed run once."""
    done = {}

    def record(speed):
        if speed not in done:
            signals = winding_signals(speed, TURNS, PITCH, 0.0, STEPS)
            done[speed] = fmpy.simulate_fmu(
                fmu_path,
                stop_time=duration(speed, TURNS),
                output_interval=duration(speed, TURNS) / STEPS,
                start_values={"scene.file": SCENE},
                input=signals,
                output=["spindle_angle", "wire_tension", "turns_wound", "fed_length", "live_nodes"],
            )
        return done[speed]

    return record


@pytest.mark.parametrize("speed", SPEEDS)
def test_fmpy_winds_at_every_speed_of_fig_8(recorded, speed):
    result = recorded(speed)
    for name in result.dtype.names:
        assert np.all(np.isfinite(result[name])), name
    # The samples are mean speeds of the steps, so held inputs end at the exact angle.
    assert result["spindle_angle"][-1] == pytest.approx(2 * math.pi * TURNS, rel=1e-9)
    assert np.all(np.diff(result["fed_length"]) > -1e-6)
    assert result["fed_length"][-1] > 5e-3
    assert np.all(result["wire_tension"] > 0)


@pytest.mark.parametrize("speed", (100, 500))
def test_native_run_gives_the_same_numbers_to_the_bit(
    command, description, fmu_path, tmp_path, speed
):
    signals = winding_signals(speed, TURNS, PITCH, 0.0, STEPS, tension=15.0)
    size, end = duration(speed, TURNS) / STEPS, float(signals["time"][-1])
    outputs = [v.name for v in description.modelVariables if v.causality in ("output", "local")]
    driven, native = tmp_path / "driven", tmp_path / "native"
    result = fmpy.simulate_fmu(
        fmu_path,
        stop_time=end,
        output_interval=size,
        start_values={"scene.file": SCENE, "output.directory": str(driven)},
        input=signals,
        output=outputs,
    )

    inputs = tmp_path / "inputs.csv"
    write_csv(signals, inputs)
    subprocess.run(
        [command, "run", SCENE, "--inputs", inputs, "--step", repr(size), "--out", native, "--quiet"],
        check=True,
    )
    with open(native / "history.csv", newline="", encoding="utf-8") as file:
        history = list(csv.DictReader(file))

    assert len(history) == len(result) == STEPS + 1
    assert set(outputs) <= set(history[0])
    for k, (cells, row) in enumerate(zip(history, result)):
        for name in ("time", *outputs):
            assert number(cells[name]) == float(row[name]), f"{name} after step {k}"

    # The files are the same too, byte by byte; only the time it took differs.
    for name in ("history.csv", "turns.csv", "stations.csv", "coil.vtp", "core.vtp", "coil.png"):
        assert (driven / name).read_bytes() == (native / name).read_bytes(), name
    assert timeless_summary(driven) == timeless_summary(native)
    assert timeless_summary(driven)["status"] == "done"


@pytest.mark.parametrize("scene, mode", ((SCENE, "by-angle"), ("bobbin", "orthocyclic"), ("bobbin", "helical")))
def test_a_master_that_sends_speed_only_winds_what_a_native_run_winds(
    command, make_slave, tmp_path, scene, mode
):
    size, steps, driven, native = 2.0**-10, 150, tmp_path / "driven", tmp_path / "native"
    speed = [min(4.0 * (k + 0.5), 100.0) for k in range(steps)]
    slave = make_slave()
    start = {"scene__file": scene, "traverse__mode": mode, "output__directory": str(driven)}
    slave.start(inputs={"spindle_speed": speed[0]}, **start)
    for k in range(steps):
        slave.set(spindle_speed=speed[k])
        slave.fmu.doStep(k * size, size)
    at, off = slave.get("nozzle_y"), slave.get("nozzle_position") - slave.get("nozzle_y")
    slave.fmu.terminate()
    assert abs(off) > 1e-4, "the nozzle was moved by no input"

    inputs = tmp_path / "inputs.csv"
    samples = [f"{k * size!r},{x!r}" for k, x in enumerate(speed)]
    # a sample more at each step keeps the speed from being interpolated
    jumps = [f"{(k + 1) * size!r},{x!r}" for k, x in enumerate(speed)]
    rows = [row for pair in zip(samples, jumps) for row in pair]
    inputs.write_text("time,spindle_speed\n" + "\n".join(rows) + "\n", encoding="utf-8")
    arguments = ["run", scene, "--set", f"traverse.mode={mode}", "--inputs", inputs, "--step", repr(size)]
    subprocess.run([command, *arguments, "--out", native, "--quiet", "--no-geometry"], check=True)
    assert (driven / "history.csv").read_bytes() == (native / "history.csv").read_bytes()
    with open(native / "history.csv", newline="", encoding="utf-8") as file:
        assert float(list(csv.DictReader(file))[-1]["nozzle_y"]) == at


def timeless_summary(directory):
    """summary.json without how long it took."""
    summary = json.loads((directory / "summary.json").read_text())
    assert summary.pop("wall_s") > 0
    assert summary.pop("real_time_factor") > 0
    return summary


def number(cell):
    """A cell of the table as a float; every integer here fits exactly."""
    return float({"true": 1, "false": 0}.get(cell, cell))


def test_two_interleaved_instances_do_not_touch_each_other(make_slave):
    first, second = make_slave("first"), make_slave("second")
    slow, slow_step = signals_of(200, first, turns=0.3, n=15)
    fast, fast_step = signals_of(400, first, turns=0.3, n=15)
    alone = run(first, slow, slow_step, scene__file=SCENE)
    first.fmu.reset()
    start(first, slow, scene__file=SCENE)
    start(second, fast, scene__file=SCENE)
    together = [first.outputs()]
    for k in range(len(slow) - 1):
        step(second, fast, k, fast_step)
        step(first, slow, k, slow_step)
        together.append(first.outputs())
    assert together == alone


def test_reset_equals_a_fresh_instance(make_slave):
    used, fresh = make_slave(), make_slave()
    signals, size = signals_of(300, fresh, turns=0.3, n=10)
    run(used, signals, size, scene__file=SCENE, friction__static=0.4)
    used.fmu.reset()
    assert run(used, signals, size, scene__file=SCENE) == run(
        fresh, signals, size, scene__file=SCENE
    )


def test_parameters_lie_over_the_scene_in_whatever_order(make_slave):
    before, after = make_slave(), make_slave()
    before.set(friction__static=0.4)
    before.set(scene__file=SCENE)
    after.set(scene__file=SCENE)
    after.set(friction__static=0.4)
    for slave in (before, after):
        slave.fmu.setupExperiment()
        slave.fmu.enterInitializationMode()
    names = [v.name for v in before.description.modelVariables if v.causality == "parameter"]
    assert [before.get(name) for name in names] == [after.get(name) for name in names]
    assert before.get("friction.static") == 0.4


def test_inputs_of_initialization_mode_shape_the_start(slave):
    slave.fmu.setupExperiment()
    slave.fmu.enterInitializationMode()
    for tension in (5.0, 12.0):
        slave.set(tension_setpoint=tension)
        assert slave.get("tension_setpoint") == tension
        assert slave.get("wire_tension") == pytest.approx(tension, rel=1e-3)
    slave.fmu.exitInitializationMode()
    assert slave.get("wire_tension") == pytest.approx(12.0, rel=1e-3)


def test_a_parameter_tuned_between_steps_counts_from_the_next_step_on(make_slave):
    """Friction moves the wire and limits raise flags, each from where it was set, not before."""
    tuned, plain, rough = make_slave("tuned"), make_slave("plain"), make_slave("rough")
    signals, size = signals_of(300, plain, turns=0.3, n=12)
    plain_rows = run(plain, signals, size, scene__file=SCENE)
    rough_rows = run(rough, signals, size, scene__file=SCENE, friction__static=0.6, friction__kinetic=0.5)
    change = 6
    start(tuned, signals, scene__file=SCENE)
    rows = [tuned.outputs()]
    for k in range(len(signals) - 1):
        if k == change:
            tuned.set(friction__static=0.6, friction__kinetic=0.5)
            assert tuned.get("friction.static") == 0.6
        step(tuned, signals, k, size)
        rows.append(tuned.outputs())
    assert rows[: change + 1] == plain_rows[: change + 1]
    assert rows[-1] != plain_rows[-1]
    assert rows[-1] != rough_rows[-1]
    for row in rows:
        assert all(math.isfinite(value) for value in row.values())


def apart(a, b):
    """The angle between two directions, rad."""
    return abs((a - b + math.pi) % (2.0 * math.pi) - math.pi)


@pytest.mark.parametrize(
    ("half_width", "diameter", "distance", "sense", "offset", "parameters"),
    [
        (6e-3, 0.7e-3, 60e-3, 1, (0.0, 0.0), {"scene__file": "fig8"}),
        (6e-3, 0.7e-3, 60e-3, -1, (0.0, 0.0), {"scene__file": "fig8"}),
        (6e-3, 0.7e-3, 60e-3, 1, (5e-3, 8e-3), {"scene__file": "fig8"}),
        (6e-3, 0.8e-3, 30e-3, 1, (0.0, 0.0), {"scene__file": "tooth"}),
        (8e-3, 0.8e-3, 60e-3, 1, (0.0, 0.0),
         {"core__shape": "cylinder", "core__radius": 8e-3, "wire__enamelled_diameter": 0.8e-3}),
    ],
)
def test_the_core_stands_where_the_page_says(slave, half_width, diameter, distance, sense, offset, parameters):
    """No page told by what angle the core is turned at the start, 1.1 to 1.5 rad: nobody could draw it."""
    inputs = {"spindle_speed": sense * 1.0, "nozzle_offset_x": offset[0], "nozzle_offset_z": offset[1]}
    slave.start(inputs=inputs, **parameters)
    x, z = distance + offset[0], offset[1]
    at_start = math.atan2(-z, x) + sense * math.acos((half_width + diameter / 2) / math.hypot(x, z))
    for k in range(40):
        stands = at_start + slave.get("spindle_angle")
        told = sense * slave.get("layon_angle") - math.atan2(slave.get("layon_z"), slave.get("layon_x"))
        assert apart(stands, told) < 0.01, (k, stands, told)
        slave.set(spindle_speed=sense * min(3.0 * (k + 1), 60.0))
        slave.fmu.doStep(k * 1e-3, 1e-3)
    assert abs(slave.get("spindle_angle")) > 1.0


def test_the_turn_of_a_layer_is_that_which_is_laid(slave, tmp_path):
    """It counted on for 1.1 to 1.8 turns after a climb, and began anew in the first turn where the nozzle swings."""
    slave.start(scene__file="bobbin", traverse__mode="orthocyclic", output__directory=str(tmp_path))
    told, k = [], 0
    while slave.get("turns_wound") < 43.2:
        slave.set(spindle_speed=100.0 * min((k + 0.5) / 30, 1.0))
        slave.fmu.doStep(k * 1e-3, 1e-3)
        k += 1
        told.append([slave.get(name) for name in ("turns_wound", "turn_in_layer", "layer")])
    slave.fmu.terminate()
    with open(tmp_path / "turns.csv", encoding="utf-8", newline="") as file:
        table = {int(row["turn"]): row for row in csv.DictReader(file)}
    for wound, in_layer, layer in told:
        # it rose only once wire of the new layer had settled
        assert layer == round((wound - in_layer) / 20) + 1, (wound, in_layer, layer)
        row = table.get(math.ceil(wound))
        assert abs(wound % 20 - in_layer) < 0.4 or abs(wound % 20 - in_layer) > 19.6, (wound, in_layer)
        middle = 0.4 < wound % 1 < 0.6
        if middle and row and float(row["settled"]) == 1.0:
            assert math.ceil(in_layer) == int(row["turn_in_layer"]), (wound, in_layer, row)
    assert max(layer for _, _, layer in told) == 3
