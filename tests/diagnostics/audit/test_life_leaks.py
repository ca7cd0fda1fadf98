"""Leaks of lives: honest inspections tell no more than age, planted clues do."""

from __future__ import annotations

import numpy as np

from diagnostics.audit.life_leaks import life_leaks
from diagnostics.training.lives import Inspections

UNITS = 60


def fleet(*, of_life: bool = False, in_order: bool = False) -> Inspections:
    """Return gearboxes looked at every 5 h, or at fractions of life; numbered anyhow, or the short-lived ones first."""
    rng = np.random.default_rng(20261127)
    lives_h = 55.0 * rng.weibull(4.0, UNITS)
    lives_h = np.sort(lives_h) if in_order else lives_h
    rows = []
    for unit, life_h in enumerate(lives_h.tolist()):
        step_h = life_h / 12.0 if of_life else 5.0
        planned = step_h * (np.arange(40) + rng.uniform(-0.07, 0.07, 40) * (np.arange(40) > 0))
        rows += [(unit, age_h, life_h - age_h) for age_h in planned[planned < life_h].tolist()]
    unit, age_h, rul_h = np.array(rows).T
    count = unit.size
    return Inspections(
        record_id=40 * unit.astype(int) + np.arange(count) % 40,
        specimen=unit.astype(int),
        split=np.full(count, "train"),
        age_h=age_h,
        rul_h=rul_h,
        observed_h=age_h + rul_h,
        indicators={},
        history=np.empty((count, 0)),
        sample_bytes=rng.integers(0, 5, (count, 2)).astype(float),
        debris_mg=np.zeros(count),
        worst_shares=np.zeros((count, 3)),
        outlook_h=np.zeros((count, 3)),
    )


def found(inspections: Inspections) -> set[str]:
    """Return the clues that leak."""
    return {leak.clue for leak in life_leaks(inspections, 1) if leak.found}


def test_a_schedule_in_hours_tells_no_more_than_age() -> None:
    assert found(fleet()) == set()


def test_inspections_at_fractions_of_life_and_numbers_in_the_order_of_lives_are_found() -> None:
    told = {"hours since the inspections before", "number of the inspection", "identity of gearbox and record"}
    assert found(fleet(of_life=True, in_order=True)) == told
