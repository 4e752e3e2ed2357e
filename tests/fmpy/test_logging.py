"""What reaches the importer's logger, and how."""

import math
import re

from conftest import WARNING

STEP = 1e-4


def test_format_characters_come_out_as_they_are(slave, tmp_path):
    blocked = tmp_path / "100 %s %n %d"
    blocked.write_text("in the way")
    slave.start(output__directory=str(blocked / "results"))
    _, status, category, text = slave.log[-1]
    assert (status, category) == (WARNING, "logStatusWarning")
    assert "100 %s %n %d" in text


def test_categories_are_the_declared_ones(slave, description):
    declared = {category.name for category in description.logCategories}
    slave.start(scene__file="fig8", wire__strength=40.0)
    slave.set(tension_setpoint=38.0, spindle_speed=300.0)
    for k in range(120):
        slave.fmu.doStep(k * STEP, STEP)
    slave.fmu.terminate()
    used = {category for _, _, category, _ in slave.log}
    assert used and used <= declared
    broken = [text for _, status, _, text in slave.log if status == WARNING and "broke" in text]
    assert len(broken) == 1
    assert re.match(r"t = 0\.\d+ s, turn \d+\.\d+, core at -?\d+\.\d deg: ", broken[0])


def test_a_wind_that_goes_well_warns_of_nothing(slave):
    """Each step that the solver shortened was a line, and once a warning, with the words that nothing needs to be done."""
    slave.start(inputs={"spindle_speed": 1.0})
    for k in range(160):
        speed = 100.0 * min((k + 0.5) / 30, 1.0)
        travel = 0.7e-3 / (2 * math.pi) * speed * 1e-3
        slave.set(spindle_speed=speed, nozzle_position=slave.get("nozzle_position") + travel)
        slave.fmu.doStep(k * 1e-3, 1e-3)
    assert slave.get("turns_wound") > 2.0
    assert not [entry for entry in slave.log if entry[1] == WARNING]
    assert slave.get("solver_rejects") > 0
    assert not [entry for entry in slave.log if entry[2] == "logSolver"]
    slave.fmu.terminate()
    summaries = [entry for entry in slave.log if entry[2] == "logSolver"]
    assert [entry[1] for entry in summaries] == [0]
    counted = re.match(
        r"t = 0\.160000 s: the solver took (\d+) steps, and gave up (\d+) for their error and (\d+) after a search in vain$",
        summaries[0][3],
    )
    taken, wrong, in_vain = (int(count) for count in counted.groups())
    assert taken == slave.get("solver_steps") and wrong + in_vain == slave.get("solver_rejects")


def test_defects_come_with_time_turn_and_angle(slave):
    slave.start(scene__file="fig8", defects__gap=0.0, defects__gap_fraction=0.01)
    slave.fmu.setDebugLogging(True, ["logEvents"])
    speed, pitch = 400.0, 1.2e-3
    for k in range(500):
        slave.set(spindle_speed=min(4e4 * k * STEP, speed))
        travel = pitch * slave.get("spindle_speed") * STEP / 6.283185307179586
        slave.set(nozzle_position=slave.get("nozzle_position") + travel)
        slave.fmu.doStep(k * STEP, STEP)
    events = [text for _, _, category, text in slave.log if category == "logEvents"]
    defects = [text for text in events if "defect found in turn" in text]
    assert defects, slave.log
    for text in events:
        assert re.match(r"t = \d+\.\d+ s, turn \d+\.\d+, core at -?\d+\.\d deg: ", text), text
    assert re.search(r"defect found in turn \d+ at \d+ deg \(gap", defects[0])
    # what was told and counts no more is said to be gone
    told = len(slave.log)
    slave.set(defects__gap=100.0)
    slave.fmu.doStep(500 * STEP, STEP)
    gone = [text for _, _, category, text in slave.log[told:] if category == "logEvents" and "(gap)" in text]
    assert gone and all("no longer a defect in turn" in text for text in gone), slave.log[told:]
    assert gone[0].endswith(": the limits of defects have changed")


def test_a_derivative_that_depends_on_the_size_of_the_change_is_told(slave):
    """Over a millisecond at 100 rad/s wire lands in half of the steps; while the core stands nothing does."""
    slave.start(scene__file="fig8")
    unknown, known = slave.references(["wire_tension", "turns_wound"]), slave.references(["tension_setpoint"])

    def ask(k, speed):
        slave.set(spindle_speed=speed)
        slave.fmu.doStep(k * 1e-3, 1e-3)
        before = len(slave.log)
        slave.fmu.getDirectionalDerivative(unknown, known, [1.0])
        return [entry[1:] for entry in slave.log[before:]]

    assert not any(ask(k, 0.0) for k in range(3))
    told = [entry for k in range(3, 40) for entry in ask(k, min(100.0, 10.0 * k))]
    assert told, slave.log
    for status, category, text in told:
        assert (status, category) == (0, "logDerivatives")
        pattern = r"t = 0\.\d{6} s: wire lands, slips or yields .*: (wire_tension|turns_wound) \S+ \(\S+ to \S+\)"
        assert re.match(pattern, text), text
    assert len(told) < 37
    slave.fmu.setDebugLogging(True, ["logEvents"])
    assert not any(ask(k, 100.0) for k in range(40, 60))
