"""Task `size`: the damaged area of a record in mm²."""

from __future__ import annotations

import numpy as np

from diagnostics.scoring.task import Measure, Taken, Task, by_record, error_of_one_number, weighted_mean
from diagnostics.scoring.truth import Truth
from siggen.dataset.reading import Dataset

AREA, TRUE_AREA = "area_mm2", "damaged_area_mm2"


def _facts(dataset: Dataset, truth: Truth) -> dict[str, np.ndarray]:
    return {TRUE_AREA: by_record(dataset.labels(truth.split, ["record_id", TRUE_AREA]), TRUE_AREA, truth)}


def _parts(truth: Truth) -> dict[str, np.ndarray]:
    """Return all records, and those with a damaged area; none where no record has one."""
    area = truth.facts.get(TRUE_AREA, np.zeros(0))
    if truth.told is None or not (area > 0.0).any():
        return {}
    return {"all": np.ones(area.size, dtype=bool), "damaged": area > 0.0}


def _errors(answers: np.ndarray, truth: Truth, weights: np.ndarray) -> np.ndarray:
    return weighted_mean(np.abs(answers - truth.facts[TRUE_AREA]), weights)


SIZE = Task(
    "size",
    f"{AREA} (damaged area of all teeth)",
    lambda _: (Taken(AREA, "0 or more", low=0.0),),
    lambda columns, _truth: columns.get(AREA),
    _parts,
    (
        Measure(
            "mean absolute error [mm²]",
            _errors,
            lambda truth: error_of_one_number(truth.facts[TRUE_AREA]),
            is_share=False,
            falls=True,
        ),
    ),
    facts=_facts,
)
