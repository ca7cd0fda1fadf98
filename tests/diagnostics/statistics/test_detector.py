"""A detector's AUC, alarms and sizes are those that were planted; few healthy records give no size."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.statistics.detector import FEWEST_HEALTHY, judged_detector

AREAS = (1.0, 2.0, 4.0, 8.0)


def planted(gearboxes: int, found_from_mm2: float) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return scores that lie below all healthy ones up to a size and above them beyond, and labels of a ladder."""
    rows = [(box, place, area) for box in range(gearboxes) for place, area in enumerate((0.0, *AREAS))]
    specimen, place, area = (np.array(column) for column in zip(*rows, strict=True))
    labels = {
        "specimen_id": specimen,
        "state": np.array([f"s{k}" for k in place]),
        "state_id": place,
        "fault": np.where(area > 0, "pitting", "healthy"),
        "damaged_area_mm2": area,
    }
    score = np.where(area == 0, specimen / gearboxes, np.where(area >= found_from_mm2, 2.0, -1.0))
    return score, labels


def test_sizes_alarms_and_areas_are_the_planted_ones() -> None:
    found = judged_detector("planted", *planted(24, 4.0), seed=0)
    assert found is not None
    assert [round(state.auc.value, 12) for state in found.states.values()] == [0.0, 0.0, 1.0, 1.0]
    assert [state.share.value for state in found.states.values() if state.share] == [0.0, 0.0, 1.0, 1.0]
    # all or none of 24 gearboxes: limits of Clopper and Pearson, 0.025^(1/24) to 1 and their mirror image
    lowest = 0.025 ** (1 / 24)
    shares = [state.share for state in found.states.values() if state.share]
    assert [(round(s.low, 9), round(s.high, 9)) for s in shares[::3]] == [
        (0.0, round(1 - lowest, 9)),
        (round(lowest, 9), 1.0),
    ]
    assert found.every.value == 0.5  # half of the damaged records stand above all healthy ones, half below
    size = found.sizes["pitting"]
    # between the groups of 2 and 4 mm2 the share rises from 0 to 1: 0.9 of the way on a logarithmic axis
    assert math.isclose(size.area_mm2.value, 2.0 * 2.0**0.9)
    assert not size.is_bound
    assert (size.smallest_mm2, size.largest_mm2) == (1.0, 8.0)


def test_damage_that_is_never_found_has_an_infinite_size_and_the_smallest_found_is_a_bound() -> None:
    never = judged_detector("planted", *planted(24, math.inf), seed=0)
    always = judged_detector("planted", *planted(24, 0.5), seed=0)
    assert never is not None
    assert always is not None
    assert not never.sizes["pitting"].reached
    assert always.sizes["pitting"].is_bound


def test_few_healthy_records_set_no_threshold_and_give_no_size() -> None:
    found = judged_detector("planted", *planted(FEWEST_HEALTHY - 1, 4.0), seed=0)
    assert found is not None
    assert not found.sizes
    assert all(state.share is None for state in found.states.values())
    assert judged_detector("planted", *planted(FEWEST_HEALTHY, 4.0), seed=0).sizes  # type: ignore[union-attr]


def test_kinds_of_damage_have_sizes_of_their_own() -> None:
    score, labels = planted(24, 4.0)
    labels["fault"] = np.where(labels["damaged_area_mm2"] > 2.0, "spalling", labels["fault"])
    found = judged_detector("planted", score, labels, seed=0)
    assert found is not None
    assert not found.sizes["pitting"].reached
    assert found.sizes["spalling"].area_mm2.value == 4.0
