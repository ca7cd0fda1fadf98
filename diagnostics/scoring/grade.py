"""Task `grade`: which class a record is of, by probabilities or by a name."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from diagnostics.records.state_classes import CLASS
from diagnostics.scoring.task import Columns, Measure, Problem, Taken, Task, every_record
from diagnostics.scoring.truth import Truth
from diagnostics.statistics.evaluation import Predictions, balanced_accuracy, macro_auroc

PROBABILITY = "p_"
"""What stands before a probability."""
SUM_TOLERANCE = 1e-3
"""How far probabilities may be from 1 together: float32, and files that round to four digits."""


def probabilities(columns: Columns, truth: Truth) -> np.ndarray | None:
    """Return the probabilities of the classes, (n, classes); None without their columns."""
    names = [PROBABILITY + name for name in truth.classes]
    return np.stack([columns[name] for name in names], axis=1) if names and set(names) <= set(columns) else None


def grades(columns: Columns, truth: Truth) -> np.ndarray | None:
    """Return the probabilities of the classes; of a named class 1, of the others 0."""
    found = probabilities(columns, truth)
    if found is not None or CLASS not in columns:
        return found
    return np.eye(len(truth.classes))[columns[CLASS]]


def _columns(truth: Truth) -> tuple[Taken, ...]:
    """Return a probability for every class, and a name; a state stands for its class, unless a class has that name."""
    if truth.told is None:
        return ()
    place = {name: truth.classes.index(own) for name, own in truth.told.class_of.items()}
    place |= {name: number for number, name in enumerate(truth.classes)}
    low, high = -SUM_TOLERANCE, 1.0 + SUM_TOLERANCE
    numbers = (Taken(PROBABILITY + name, "0 to 1", low, high) for name in truth.classes)
    return (*numbers, Taken(CLASS, "a class", places=place))


def _problems(columns: Columns, truth: Truth) -> Iterator[Problem]:
    """Yield classes without a column where others have one, and sums that are not 1."""
    nowhere = np.zeros(truth.record_id.size, dtype=bool)
    missing = [PROBABILITY + name for name in truth.classes if PROBABILITY + name not in columns]
    if 0 < len(missing) < len(truth.classes):
        yield f"no column {', '.join(missing)}", nowhere, "one for every class, or none"
    found = probabilities(columns, truth)
    if found is None or not np.isfinite(found).all():
        return
    total = found.sum(axis=1)
    bad = np.abs(total - 1.0) > SUM_TOLERANCE
    if bad.any():
        yield f"the sum of the probabilities is {total[bad][0]:g}", bad, "1"


def _as_predictions(answers: np.ndarray, truth: Truth) -> Predictions:
    return Predictions(truth.classes, truth.label, answers, truth.specimen)


GRADE = Task(
    "grade",
    f"{PROBABILITY}<class> of every class (probabilities), or {CLASS} (its name)",
    _columns,
    grades,
    every_record,
    (
        Measure(
            "balanced accuracy",
            lambda answers, truth, weights: balanced_accuracy(_as_predictions(answers, truth), weights),
            lambda truth: 1.0 / np.unique(truth.label).size,
        ),
        Measure(
            "macro AUROC",
            lambda answers, truth, weights: macro_auroc(_as_predictions(answers, truth), weights),
            lambda _: 0.5,
            ranks=True,
        ),
    ),
    problems=_problems,
)
