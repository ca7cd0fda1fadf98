"""What is true of the records that predictions are judged on: class and gearbox of each."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from diagnostics.records.state_classes import CLASS, class_members, class_names, healthy_states
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError, counted

LABELS = ("record_id", "specimen_id", "split", "state", "state_id", "fault")


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
    classes : tuple of str
        Of the whole set; all healthy states are one, under the name of the first.
    healthy : str or None
        That class; None where no state is healthy throughout.
    class_of : dict of str to str
        The class of every state.
    elsewhere : (m,) int
        `record_id` of the records of the other splits.
    """

    split: str
    record_id: np.ndarray
    specimen: np.ndarray
    label: np.ndarray
    classes: tuple[str, ...]
    healthy: str | None
    class_of: dict[str, str]
    elsewhere: np.ndarray

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


def truth_of(dataset: Dataset, split: str) -> Truth:
    """Return what is true of the records of a split.

    Raises
    ------
    UsageError
        If the split has no records.
    """
    table = dataset.labels(columns=list(LABELS))
    labels = {name: np.asarray(table.column(name).to_pylist()) for name in LABELS}
    labels[CLASS] = class_names(labels)
    classes = tuple(class_members(labels))
    chosen = labels["split"] == split
    if not chosen.any():
        present = [f"{name} ({counted(int((labels['split'] == name).sum()), 'record')})" for name in dataset.splits]
        raise UsageError(f"{dataset.path}: received the split {split!r}; those with records are {', '.join(present)}")
    place = {name: number for number, name in enumerate(classes)}
    return Truth(
        split=split,
        record_id=labels["record_id"][chosen],
        specimen=labels["specimen_id"][chosen],
        label=np.array([place[name] for name in labels[CLASS][chosen].tolist()], dtype=np.int64),
        classes=classes,
        healthy=next(iter(healthy_states(labels)), None),
        class_of=dict(zip(labels["state"].tolist(), labels[CLASS].tolist(), strict=True)),
        elsewhere=labels["record_id"][~chosen],
    )
