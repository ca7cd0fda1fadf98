"""Task `remaining life`: hours to the functional end, of the inspections of gearboxes that were seen to fail."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from diagnostics.scoring.task import (
    Columns,
    Measure,
    Problem,
    Taken,
    Task,
    by_record,
    error_of_one_number,
    weighted_mean,
)
from diagnostics.scoring.truth import Truth, is_lives
from siggen.dataset.reading import Dataset

RUL, LOW, HIGH = "rul_h", "rul_q10_h", "rul_q90_h"
COLUMNS = (LOW, RUL, HIGH)
EVERY = "all"
LAST = 1.0 / 3.0
"""Part of the median remaining life at first sight below which the end is near."""


def _facts(dataset: Dataset, truth: Truth) -> dict[str, np.ndarray]:
    if not is_lives(dataset):
        return {}
    return {RUL: by_record(dataset.life("inspections", truth.split), RUL, truth)}


def _answers(columns: Columns, _truth: Truth) -> np.ndarray | None:
    """Return the predicted life and its limits, (n, 3); limits that are not there are NaN."""
    if RUL not in columns:
        return None
    unknown = np.full(columns[RUL].size, np.nan)
    return np.stack([columns.get(name, unknown) for name in COLUMNS], axis=1)


def _parts(truth: Truth) -> dict[str, np.ndarray]:
    """Return all inspections, and those near the end."""
    if RUL not in truth.facts or not truth.facts[RUL].size:
        return {}
    life = truth.facts[RUL]
    _, owner = np.unique(truth.specimen, return_inverse=True)
    first = np.zeros(int(owner.max()) + 1)
    np.maximum.at(first, owner, life)
    near = life < LAST * float(np.median(first))
    return {EVERY: np.ones(life.size, dtype=bool), **({"the last third": near} if near.any() else {})}


def _problems(columns: Columns, truth: Truth) -> Iterator[Problem]:
    if (LOW in columns) != (HIGH in columns):
        missing = HIGH if LOW in columns else LOW
        yield f"no column {missing}", np.zeros(truth.record_id.size, dtype=bool), f"{LOW} and {HIGH} together"
    if LOW in columns and HIGH in columns:
        bad = columns[LOW] > columns[HIGH]
        if bad.any():
            yield f"{LOW} is above {HIGH}", bad, "the lower limit below the upper one"


def _inside(answers: np.ndarray, truth: Truth, weights: np.ndarray) -> np.ndarray:
    """Return the share of lives between the limits; NaN where no limits were given."""
    inside = (answers[:, 0] <= truth.facts[RUL]) & (truth.facts[RUL] <= answers[:, 2])
    return weighted_mean(np.where(np.isnan(answers[:, 0]), np.nan, inside), weights)


REMAINING_LIFE = Task(
    "remaining life",
    f"{RUL}, with {LOW} and {HIGH} if limits are known",
    lambda truth: tuple(Taken(name, "0 or more", low=0.0) for name in COLUMNS) if RUL in truth.facts else (),
    _answers,
    _parts,
    (
        Measure(
            "mean absolute error [h]",
            lambda answers, truth, weights: weighted_mean(np.abs(answers[:, 1] - truth.facts[RUL]), weights),
            lambda truth: error_of_one_number(truth.facts[RUL]),
            is_share=False,
            falls=True,
        ),
        Measure("share between the limits (0.8 is right)", _inside, lambda _: 0.8),
    ),
    facts=_facts,
    problems=_problems,
)
