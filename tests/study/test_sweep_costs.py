"""scripts/sweep_costs.py: what it makes of the rows of a sweep."""

import sys

import pytest


@pytest.fixture
def costs(root, monkeypatch):
    monkeypatch.syspath_prepend(root / "scripts")
    yield __import__("sweep_costs")
    sys.modules.pop("sweep_costs")


def test_the_highest_speed_is_the_last_before_the_first_with_a_defect(costs):
    def row(speed, defect="false", outcome="done"):
        return {"spindle.speed": speed, "defect": defect, "outcome": outcome}

    # 110 is free in one member only, and 130 is free again
    rows = [row("100"), row("100"), row("110"), row("110", "true"), row("120", outcome="failed"), row("130")]
    assert costs.highest(rows) == 100.0
    assert costs.highest([row("100"), row("105")]) == 105.0


def test_the_mean_of_a_map_is_that_of_the_lines_between_the_sample(costs):
    assert costs.mean_between([1.0, 2.0, 3.0], 8) == pytest.approx(2.0)
    # 0, 2, 4, 2, 0
    assert costs.mean_between([0.0, 4.0, 0.0], 5) == pytest.approx(1.6)
