"""scripts/random_answers.py finds the packed exact answers by formulas of its own, and what it draws is right."""


def test_packed_answers_are_found_by_other_formulas(script):
    code, said = script("scripts/random_answers.py", "--check")
    assert code == 0, said
    assert "shoulder_drop: 6 packed cases" in said


def test_drawn_cases_are_right(script, command):
    kinds = ["shoulder_static", "elastica_cantilever", "spinning_ring", "helix"]
    code, said = script("scripts/random_answers.py", "--command", command, "--seed", 101, "--count", 2, *kinds)
    assert code == 0, said
    assert "numbers of 4 kinds are right" in said


def test_an_unknown_kind_is_refused(script):
    code, said = script("scripts/random_answers.py", "shoulder")
    assert code == 2 and "shoulder: allowed: " in said
