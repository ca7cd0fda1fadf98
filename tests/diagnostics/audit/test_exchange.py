"""Exchanging states is exact on sets without any effect, also for detectors that see a healthy reference."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from diagnostics.audit.bank import DESIGN, bank_maxima, permuted
from diagnostics.audit.measured_set import MeasuredSet, exchange_blocks, reference_records
from diagnostics.judging.learners import best_column

GEARBOXES, ORDERS, SETS, PERMUTATIONS = 24, 10, 400, 39
SPREAD = (0.1 * 0.9 * SETS) ** 0.5
"""Of the number of p-values at 0.1 or below."""
SPECIMEN, DAMAGED = np.repeat(np.arange(GEARBOXES), 3), np.tile([False, False, True], GEARBOXES)
ALIKE = cast(
    MeasuredSet,
    SimpleNamespace(
        labels={"specimen_id": SPECIMEN, "speed_hz": np.full(SPECIMEN.size, 30.0), "torque_nm": np.ones(SPECIMEN.size)},
        values={"pulses_per_s": np.full((SPECIMEN.size, 1), 30.0)},
        healthy=~DAMAGED,
    ),
)


def p_value(seed: int, reference: np.ndarray, block: np.ndarray) -> float:
    """The p-value of a detector on the size of the change, of noise about the pattern of a gearbox."""
    rng = np.random.default_rng(seed)
    lines = rng.standard_normal((GEARBOXES, ORDERS))[SPECIMEN] + rng.standard_normal((SPECIMEN.size, ORDERS))
    size = np.log10(np.square(lines - lines[reference]).sum(axis=1))
    detector = best_column("change", np.where(reference >= 0, size, np.nan)[:, None], ("",))
    ways = np.concatenate([DAMAGED[None], permuted(DAMAGED, block, SPECIMEN, seed, PERMUTATIONS)])
    maxima = bank_maxima([detector], np.arange(SPECIMEN.size), ways, SPECIMEN, DESIGN.dealt(SPECIMEN, seed)[:1])
    return float(np.mean(maxima >= maxima[0]))


def test_without_any_effect_p_values_are_as_often_small_as_they_say() -> None:
    reference, block = reference_records(ALIKE), exchange_blocks(ALIKE)
    found = [p_value(seed, reference, block) for seed in range(SETS)]
    assert np.sum(np.array(found) <= 0.1) == pytest.approx(0.1 * SETS, abs=3.0 * SPREAD)


def test_two_healthy_records_beside_each_other_would_find_damage_where_none_is() -> None:
    # their differences are one, counted twice
    mirrored = np.array([1, 0, 0] * GEARBOXES) + 3 * SPECIMEN
    found = [p_value(seed, mirrored, SPECIMEN) for seed in range(SETS)]
    assert np.sum(np.array(found) <= 0.1) > 0.1 * SETS + 5.0 * SPREAD
