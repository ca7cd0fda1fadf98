"""Task `detect`: a number that rises with damage, of any kind and of each."""

from __future__ import annotations

import numpy as np

from diagnostics.scoring.grade import probabilities
from diagnostics.scoring.task import Columns, Measure, Taken, Task
from diagnostics.scoring.truth import Truth
from diagnostics.statistics.detection import fewest_gearboxes
from diagnostics.statistics.evaluation import weighted_auc

DAMAGE = "damage"
"""Column of a number that rises with damage."""
EVERY = "every damage"


def _damage(columns: Columns, truth: Truth) -> np.ndarray | None:
    """Return a number that rises with damage: the column of that name, else 1 - p(healthy)."""
    found = probabilities(columns, truth)
    if DAMAGE in columns or found is None or truth.healthy is None:
        return columns.get(DAMAGE)
    return np.asarray(1.0 - found[:, truth.classes.index(truth.healthy)])


def _damages(truth: Truth) -> dict[str, np.ndarray]:
    """Return all records, and for every damaged class those of it with the healthy ones; none without both sides."""
    damaged = truth.damaged
    if truth.healthy is None or damaged.all() or not damaged.any():
        return {}
    own = {truth.classes[k]: ~damaged | (truth.label == k) for k in np.unique(truth.label[damaged]).tolist()}
    return {EVERY: np.ones(damaged.size, dtype=bool), **(own if len(own) > 1 else {})}


DETECT = Task(
    "detect",
    f"{DAMAGE} (a number that rises with damage)",
    lambda _: (Taken(DAMAGE),),
    _damage,
    _damages,
    (
        Measure(
            "AUC",
            lambda answers, truth, weights: weighted_auc(answers, truth.damaged, weights, truth.specimen),
            lambda truth: fewest_gearboxes(truth.damaged, truth.specimen),
            lambda _: 0.5,
            ranks=True,
        ),
    ),
)
