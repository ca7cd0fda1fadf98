"""What is true of the records that predictions are judged on: gearbox and class, and what tasks ask for besides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from diagnostics.records.record_classes import STATE, RecordClasses, set_classes
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError, counted

LABELS = ("record_id", "specimen_id", "split", "state")


@dataclass(frozen=True, slots=True)
class Truth:
    """The records of one split.

    Attributes
    ----------
    split : str
    record_id, specimen : (n,) int
        In the order of the set.
    label : (n,) int
        Position of each record's class in `classes`; 0 in sets of lives, which have none.
    told : RecordClasses or None
        The classes of the whole set; None in sets of lives.
    elsewhere : (m,) int
        `record_id` of the records of the other splits, and of those that no task asks for.
    facts : mapping of str to (n,)
        What tasks ask for, by name.
    gears : mapping of str to (n,) int
        Teeth of every gear of each record's gearbox, by what the table of damage calls it.
    """

    split: str
    record_id: np.ndarray
    specimen: np.ndarray
    label: np.ndarray
    told: RecordClasses | None
    elsewhere: np.ndarray
    facts: Mapping[str, np.ndarray] = field(default_factory=dict)
    gears: Mapping[str, np.ndarray] = field(default_factory=dict)

    @property
    def classes(self) -> tuple[str, ...]:
        """The classes of the whole set."""
        return self.told.names if self.told else ()

    @property
    def healthy(self) -> str | None:
        """The healthy class; None where no state is healthy throughout."""
        return self.told.healthy if self.told else None

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
        return replace(
            self,
            record_id=self.record_id[chosen],
            specimen=self.specimen[chosen],
            label=self.label[chosen],
            facts={name: values[chosen] for name, values in self.facts.items()},
            gears={name: teeth[chosen] for name, teeth in self.gears.items()},
        )


def is_lives(dataset: Dataset) -> bool:
    """Return whether the gearboxes of a set run to failure."""
    return dataset.config.get("life") is not None


def judged_records(dataset: Dataset, split: str, kind: str = STATE) -> Truth:
    """Return the records of a split without what tasks ask for besides; `kind` says what a class is.

    Raises
    ------
    UsageError
        If the split has no records, or the kind is unknown.
    """
    table = dataset.labels(columns=list(LABELS))
    labels = {name: np.asarray(table.column(name).to_pylist()) for name in LABELS}
    told = None if is_lives(dataset) else set_classes(dataset, kind)
    chosen = labels["split"] == split
    if not chosen.any():
        present = [f"{name} ({counted(int((labels['split'] == name).sum()), 'record')})" for name in dataset.splits]
        raise UsageError(f"{dataset.path}: received the split {split!r}; those with records are {', '.join(present)}")
    own = labels["state"][chosen]
    return Truth(
        split=split,
        record_id=labels["record_id"][chosen],
        specimen=labels["specimen_id"][chosen],
        label=np.zeros(own.size, dtype=np.int64) if told is None else told.places(own),
        told=told,
        elsewhere=labels["record_id"][~chosen],
    )
