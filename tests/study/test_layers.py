"""examples/layers.py: layers by the FMU's own traverse, with nothing but the speed sent."""

import re


def test_the_second_layer_begins_where_the_scene_plans_it(script, fmu):
    code, said = script("examples/layers.py", "--fmu", fmu, "--turns", "21.5")
    assert code == 0, said
    begins = {int(layer): float(turn) for layer, turn in re.findall(r"layer (\d): from turn ([\d.]+) on", said)}
    assert set(begins) == {1, 2}, said
    assert 19.0 < begins[2] < 21.0, said
    assert said.rstrip().endswith(" 0 defects"), said


def test_a_missing_fmu_is_told_in_a_line(script, tmp_path):
    code, said = script("examples/layers.py", "--fmu", tmp_path / "none.fmu")
    assert code == 2 and said == f"layers.py: {tmp_path / 'none.fmu'} is missing; build it with scripts/build_fmu.sh\n", said
