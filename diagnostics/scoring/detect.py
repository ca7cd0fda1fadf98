"""Task `detect`: a number that rises with damage, of any kind and of each; and whether it rises with a sham.

A sham is damage without effect. What tells it from healthy records has found a leak of the set.
"""

from __future__ import annotations

import numpy as np

from diagnostics.records.state_classes import SHAM
from diagnostics.scoring.grade import probabilities
from diagnostics.scoring.task import Columns, Measure, Taken, Task
from diagnostics.scoring.truth import Truth
from diagnostics.statistics.evaluation import fewest_gearboxes, weighted_auc
from siggen.dataset.reading import Dataset

DAMAGE = "damage"
"""Column of a number that rises with damage."""
EVERY = "every damage"
LEAK = "sham against healthy"


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
    sham = truth.facts.get(SHAM, np.zeros(damaged.size, dtype=bool))
    leak = {LEAK: ~damaged} if sham.any() and not sham[~damaged].all() else {}
    return {EVERY: np.ones(damaged.size, dtype=bool), **(own if len(own) > 1 else {}), **leak}


def _facts(dataset: Dataset, truth: Truth) -> dict[str, np.ndarray]:
    """Return which records are shams, where the set has some."""
    table = dataset.labels(truth.split)
    return {SHAM: np.asarray(table.column(SHAM).to_pylist(), dtype=bool)} if SHAM in table.column_names else {}


def _positive(truth: Truth) -> np.ndarray:
    """Return the damaged records, (n,) bool; where none is, the shams."""
    return truth.damaged if truth.damaged.any() else truth.facts[SHAM]


DETECT = Task(
    "detect",
    f"{DAMAGE} (a number that rises with damage)",
    lambda _: (Taken(DAMAGE),),
    _damage,
    _damages,
    (
        Measure(
            "AUC",
            lambda answers, truth, weights: weighted_auc(answers, _positive(truth), weights, truth.specimen),
            lambda _: 0.5,
            lambda truth: fewest_gearboxes(_positive(truth), truth.specimen),
            ranks=True,
        ),
    ),
    facts=_facts,
)
