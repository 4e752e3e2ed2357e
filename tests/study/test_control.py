"""examples/control.py: what its page claims of the three controllers."""

import json


def test_each_controller_holds_what_the_machine_alone_does_not(script, fmu, tmp_path):
    code, said = script("examples/control.py", "--fmu", fmu, "--out", tmp_path)
    assert code == 0, said
    found = json.loads((tmp_path / "control.json").read_text(encoding="utf-8"))
    assert found["tension"]["open loop"] > 0.5
    assert found["tension"]["closed loop"] < 0.05
    assert found["speed"]["profile over the angle"] < 0.5 * found["speed"]["constant speed"]
    assert found["traverse"]["nozzle led by layon_position"] < 0.5 * found["traverse"]["nozzle at the place"]
    for name in found:
        assert (tmp_path / f"control-{name}.png").stat().st_size > 10_000


def test_what_is_missing_is_told_in_a_line(script, tmp_path):
    for words, complaint in [
        (["brake"], "there is no study brake; there are tension, speed, traverse"),
        (["--fmu", tmp_path / "none.fmu"], "none.fmu is missing; build it with scripts/build_fmu.sh"),
    ]:
        code, said = script("examples/control.py", *words)
        assert code == 2 and complaint in said and len(said.splitlines()) == 1, said
