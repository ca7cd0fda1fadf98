"""Tasks that predictions can be judged by, each a small definition: which columns it takes, records, measures, chance.

Values and limits are those of report and `metrics.json`: the same areas, resampled gearboxes and widened limits.

What is true of the records that predictions are judged on: class and gearbox of each.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from diagnostics.records.record_classes import STATE, RecordClasses, set_classes
from diagnostics.records.state_classes import CLASS
from diagnostics.statistics.detection import fewest_gearboxes
from diagnostics.statistics.evaluation import Predictions, balanced_accuracy, macro_auroc, weighted_auc
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError, counted

LABELS = ("record_id", "specimen_id", "split", "state")

DAMAGE, PROBABILITY = "damage", "p_"
"""Columns of predictions beside the class: a number that rises with damage, and what stands before a probability."""

Columns = Mapping[str, np.ndarray]


@dataclass(frozen=True, slots=True)
class Truth:
    """The records of one split.

    Attributes
    ----------
    split : str
    record_id, specimen : (n,) int
        In the order of the set.
    label : (n,) int
        Position of each record's class in `classes`.
    told : RecordClasses
        The classes of the whole set.
    elsewhere : (m,) int
        `record_id` of the records of the other splits.
    """

    split: str
    record_id: np.ndarray
    specimen: np.ndarray
    label: np.ndarray
    told: RecordClasses
    elsewhere: np.ndarray

    @property
    def classes(self) -> tuple[str, ...]:
        """The classes of the whole set."""
        return self.told.names

    @property
    def healthy(self) -> str | None:
        """The healthy class; None where no state is healthy throughout."""
        return self.told.healthy

    @property
    def damaged(self) -> np.ndarray:
        """(n,) bool: whether a record is of another class than the healthy one."""
        own = self.classes.index(self.healthy) if self.healthy else -1
        return np.asarray(self.label != own)

    @property
    def gearboxes(self) -> int:
        """Number of gearboxes."""
        return int(np.unique(self.specimen).size)

    def rows(self, chosen: np.ndarray) -> Truth:
        """Return the chosen records, (n,) bool."""
        return replace(self, record_id=self.record_id[chosen], specimen=self.specimen[chosen], label=self.label[chosen])


def truth_of(dataset: Dataset, split: str, kind: str = STATE) -> Truth:
    """Return what is true of the records of a split; `kind` says what a class is, `state` or `fault`.

    Raises
    ------
    UsageError
        If the split has no records, or the kind is unknown.
    """
    table = dataset.labels(columns=list(LABELS))
    labels = {name: np.asarray(table.column(name).to_pylist()) for name in LABELS}
    told = set_classes(dataset, kind)
    chosen = labels["split"] == split
    if not chosen.any():
        present = [f"{name} ({counted(int((labels['split'] == name).sum()), 'record')})" for name in dataset.splits]
        raise UsageError(f"{dataset.path}: received the split {split!r}; those with records are {', '.join(present)}")
    return Truth(
        split=split,
        record_id=labels["record_id"][chosen],
        specimen=labels["specimen_id"][chosen],
        label=told.places(labels["state"][chosen]),
        told=told,
        elsewhere=labels["record_id"][~chosen],
    )


@dataclass(frozen=True, slots=True)
class Measure:
    """How answers become a score.

    Attributes
    ----------
    name : str
    samples : callable
        Answers of n records, their truth and weights (b, n); returns the score for every row of weights, (b,).
    gearboxes : callable
        How many gearboxes the limits count.
    chance : callable
        What an answer without knowledge reaches.
    ranks : bool
        Whether it orders records by their numbers, which names of classes alone do not allow.
    """

    name: str
    samples: Callable[[np.ndarray, Truth, np.ndarray], np.ndarray]
    gearboxes: Callable[[Truth], int]
    chance: Callable[[Truth], float]
    ranks: bool = True


@dataclass(frozen=True, slots=True)
class Task:
    """One question to predictions.

    Attributes
    ----------
    name : str
    takes : str
        The columns that answer it, for messages.
    answers : callable
        Columns of n records and their truth; returns (n,) or (n, classes), None where no column answers.
    parts : callable
        Which records are judged, (n,) bool by what they are called; the first are all.
    measures : tuple of Measure
    """

    name: str
    takes: str
    answers: Callable[[Columns, Truth], np.ndarray | None]
    parts: Callable[[Truth], dict[str, np.ndarray]]
    measures: tuple[Measure, ...]


def probabilities(columns: Columns, truth: Truth) -> np.ndarray | None:
    """Return the probabilities of the classes, (n, classes); None without their columns."""
    names = [PROBABILITY + name for name in truth.classes]
    return np.stack([columns[name] for name in names], axis=1) if all(name in columns for name in names) else None


def _damage(columns: Columns, truth: Truth) -> np.ndarray | None:
    """Return a number that rises with damage: the column of that name, else 1 - p(healthy)."""
    found = probabilities(columns, truth)
    if DAMAGE in columns or found is None or truth.healthy is None:
        return columns.get(DAMAGE)
    return np.asarray(1.0 - found[:, truth.classes.index(truth.healthy)])


def _grades(columns: Columns, truth: Truth) -> np.ndarray | None:
    """Return the probabilities of the classes; of a named class 1, of the others 0."""
    found = probabilities(columns, truth)
    if found is not None or CLASS not in columns:
        return found
    return np.eye(len(truth.classes))[columns[CLASS]]


def _damages(truth: Truth) -> dict[str, np.ndarray]:
    """Return all records, and for every damaged class those of it with the healthy ones; none without both sides."""
    damaged = truth.damaged
    if truth.healthy is None or damaged.all() or not damaged.any():
        return {}
    own = {truth.classes[k]: ~damaged | (truth.label == k) for k in np.unique(truth.label[damaged]).tolist()}
    return {"every damage": np.ones(damaged.size, dtype=bool), **(own if len(own) > 1 else {})}


def _every(truth: Truth) -> dict[str, np.ndarray]:
    return {"all": np.ones(truth.label.size, dtype=bool)} if np.unique(truth.label).size > 1 else {}


def _as_predictions(answers: np.ndarray, truth: Truth) -> Predictions:
    return Predictions(truth.classes, truth.label, answers, truth.specimen)


DETECT = Task(
    "detect",
    f"{DAMAGE} (a number that rises with damage)",
    _damage,
    _damages,
    (
        Measure(
            "AUC",
            lambda answers, truth, weights: weighted_auc(answers, truth.damaged, weights, truth.specimen),
            lambda truth: fewest_gearboxes(truth.damaged, truth.specimen),
            lambda _: 0.5,
        ),
    ),
)
GRADE = Task(
    "grade",
    f"{PROBABILITY}<class> of every class (probabilities), or {CLASS} (its name)",
    _grades,
    _every,
    (
        Measure(
            "balanced accuracy",
            lambda answers, truth, weights: balanced_accuracy(_as_predictions(answers, truth), weights),
            lambda truth: truth.gearboxes,
            lambda truth: 1.0 / np.unique(truth.label).size,
            ranks=False,
        ),
        Measure(
            "macro AUROC",
            lambda answers, truth, weights: macro_auroc(_as_predictions(answers, truth), weights),
            lambda truth: truth.gearboxes,
            lambda _: 0.5,
        ),
    ),
)
TASKS = (DETECT, GRADE)
