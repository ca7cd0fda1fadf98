"""First detection: single alarms are chance, two in a row count, and a gearbox never sets its own limit."""

from __future__ import annotations

import numpy as np

from diagnostics.statistics.first_detection import rise, watched

UNITS, LOOKS = 40, 12


def fleet(jump: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return indicators that rise from the ninth of twelve inspections on, gearboxes, and which have no pit."""
    rng = np.random.default_rng(20261127)
    values = np.exp(0.05 * rng.standard_normal((UNITS, LOOKS, 3)))
    values[:, 8:, 1] *= jump
    whole = np.tile(np.arange(LOOKS) < 8, UNITS)
    return values.reshape(-1, 3), np.repeat(np.arange(UNITS), LOOKS), whole


def test_a_rise_of_one_indicator_is_detected_at_its_second_inspection() -> None:
    values, unit, whole = fleet(2.0)
    found = watched(rise(values, unit, whole), unit, whole)
    places = [row % LOOKS for row in found.detected.values()]
    assert len(places) == UNITS
    assert np.mean(np.array(places) == 9) > 0.9  # the others: an alarm of chance just before


def test_without_a_rise_few_gearboxes_have_two_alarms_in_a_row() -> None:
    values, unit, whole = fleet(1.0)
    found = watched(rise(values, unit, whole), unit, whole)
    assert np.nanmean(found.index[whole] >= 1.0) < 0.025  # 1 % is wanted; 320 inspections
    assert len(found.detected) < 4


def test_a_gearbox_that_begins_pitted_is_judged_by_the_others() -> None:
    index = np.array([1.0, 1.04, 5.0, 6.0, 1.0, 1.05, 1.02, 1.0])
    found = watched(index, np.repeat([0, 1], 4), np.array([True, True, False, False, True, True, True, True]))
    assert found.detected == {0: 3}


def test_a_level_does_not_matter_and_an_undefined_indicator_is_left_out() -> None:
    values, unit, whole = fleet(2.0)
    gained = values * np.array([1e-6, 1.0, 1e3])
    undefined = np.concatenate([gained, np.full((unit.size, 1), np.nan)], axis=1)
    np.testing.assert_allclose(rise(undefined, unit, whole), rise(values, unit, whole), rtol=1e-9, atol=1e-9)
