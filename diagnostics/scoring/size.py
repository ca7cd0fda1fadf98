"""Task `size`: the damaged area of a record in mm²."""

from __future__ import annotations

import numpy as np

from diagnostics.scoring.task import Columns, Measure, Taken, Task, weighted_mean
from diagnostics.scoring.truth import Truth
from siggen.dataset.reading import Dataset

AREA, TRUE_AREA = "area_mm2", "damaged_area_mm2"


def _facts(dataset: Dataset, truth: Truth) -> dict[str, np.ndarray]:
    table = dataset.labels(truth.split, ["record_id", TRUE_AREA])
    of_record = dict(zip(*(table.column(name).to_pylist() for name in ("record_id", TRUE_AREA)), strict=True))
    return {TRUE_AREA: np.array([of_record[record] for record in truth.record_id.tolist()], dtype=np.float64)}


def _answers(columns: Columns, _truth: Truth) -> np.ndarray | None:
    return columns.get(AREA)


def _parts(truth: Truth) -> dict[str, np.ndarray]:
    """Return all records, and those with a damaged area; none where no record has one."""
    area = truth.facts.get(TRUE_AREA, np.zeros(0))
    if truth.told is None or not (area > 0.0).any():
        return {}
    return {"all": np.ones(area.size, dtype=bool), "damaged": area > 0.0}


def _errors(answers: np.ndarray, truth: Truth, weights: np.ndarray) -> np.ndarray:
    return weighted_mean(np.abs(answers - truth.facts[TRUE_AREA]), weights)


def _error_of_one_number(truth: Truth) -> float:
    """Return the error of the one number that is best for all of these records: their median."""
    area = truth.facts[TRUE_AREA]
    return float(np.abs(area - np.median(area)).mean())


SIZE = Task(
    "size",
    f"{AREA} (damaged area of all teeth)",
    lambda _: (Taken(AREA, "0 or more", low=0.0),),
    _answers,
    _parts,
    (
        Measure(
            "mean absolute error [mm²]",
            _errors,
            lambda truth: truth.gearboxes,
            _error_of_one_number,
            is_share=False,
            falls=True,
        ),
    ),
    facts=_facts,
)
