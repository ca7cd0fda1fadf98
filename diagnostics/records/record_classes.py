"""What a class is: a state of a set, or the primary fault of its states; the healthy ones are one class either way.

Everything that learns, judges or names classes takes them from `RecordClasses`, so that all mean the same by a class.

A set may have several healthy states (a second healthy record of every gearbox is what paired comparisons need). They
differ by noise and start angle alone, so asking which of them a record is in would only dilute the scores.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from diagnostics.records.state_classes import HEALTHY, healthy_states, ordered_states
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError, UsageError

STATE, FAULT = "state", "fault"
KINDS = (STATE, FAULT)
"""What a class can be; the word of `--classes`, and of messages."""

PRIMARY = "primary_fault"
"""Column of sets with combined states; of all others `fault` says the same."""


@dataclass(frozen=True, slots=True)
class RecordClasses:
    """The class of every record of a set, by its state.

    Attributes
    ----------
    kind : str
        `state` or `fault`: what a class is.
    class_of : dict of str to str
        The class of every state, in the order of the configuration.
    healthy : str or None
        Name of the class of all healthy states; None where no state is healthy throughout.
    """

    kind: str
    class_of: dict[str, str]
    healthy: str | None

    @property
    def names(self) -> tuple[str, ...]:
        """The classes; one stands where its first state does."""
        return tuple(dict.fromkeys(self.class_of.values()))

    @property
    def members(self) -> dict[str, tuple[str, ...]]:
        """The states of every class."""
        return {name: tuple(s for s, own in self.class_of.items() if own == name) for name in self.names}

    def of(self, states: np.ndarray) -> np.ndarray:
        """Return the class of every record, (n,) str, from its state, (n,) str."""
        return np.array([self.class_of[state] for state in states.tolist()])

    def places(self, states: np.ndarray) -> np.ndarray:
        """Return the position in `names` of every record's class, (n,) int64, from its state, (n,) str."""
        place = {name: number for number, name in enumerate(self.names)}
        return np.array([place[self.class_of[state]] for state in states.tolist()], dtype=np.int64)


def check_kind(kind: str, where: str = "classes") -> str:
    """Return what a class is to be.

    Raises
    ------
    UsageError
        If it is neither `state` nor `fault`.
    """
    if kind not in KINDS:
        raise UsageError(f"{where}: received {kind!r}; allowed are {', '.join(KINDS)}")
    return kind


def record_classes(labels: Mapping[str, np.ndarray], kind: str = STATE, healthy: str | None = None) -> RecordClasses:
    """Return the classes of labelled records.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Columns `state`, `state_id`, `fault` of all splits, so that they agree; for faults `primary_fault` too, where
        the set has it.
    kind : str
        `state` or `fault`.
    healthy : str, optional
        Name of the healthy class of states, default the first healthy state; another set takes the name of the set
        that was trained on. As a fault it is always `healthy`.

    Raises
    ------
    UsageError
        If the kind is unknown.
    DatasetError
        If the records of one state have several primary faults.
    """
    check_kind(kind)
    merged, states = healthy_states(labels), ordered_states(labels)
    if kind == FAULT:
        return RecordClasses(kind, {state: _fault(labels, state) for state in states}, HEALTHY if merged else None)
    name = (healthy or merged[0]) if merged else None
    return RecordClasses(kind, {state: name if name and state in merged else state for state in states}, name)


def check_dataset(dataset: object, caller: str) -> None:
    """Check that a function of the public face got a set.

    Raises
    ------
    UsageError
        If it is something else; says how a set is opened.
    """
    if not hasattr(dataset, "labels") or not hasattr(dataset, "manifest"):
        said = repr(str(dataset)) if isinstance(dataset, (str, Path)) else f"a {type(dataset).__name__}"
        path = str(dataset) if isinstance(dataset, (str, Path)) else "runs/quickstart"
        raise UsageError(f"{caller}: received {said}; allowed: what siggen.open returned, siggen.open({path!r})")


def refuse_lives(dataset: Dataset) -> None:
    """Raise UsageError for a set of lives: its inspections are no states that gearboxes have in common."""
    if dataset.config.get("life"):
        raise UsageError(
            f"{dataset.path}: received a set of lives, which has no classes: an inspection is healthy in one gearbox "
            "and pitted in another. Allowed: a set with states (siggen inspect life --out writes those of one "
            "gearbox). Ages, phases and remaining lives of this one are in its folder life/; siggen-diagnostics "
            "report judges what tells them"
        )


def set_classes(dataset: Dataset, kind: str = STATE, healthy: str | None = None) -> RecordClasses:
    """Return the classes of a set; parameters and errors as of `record_classes`, UsageError for lives."""
    check_kind(kind)
    refuse_lives(dataset)
    primary = [PRIMARY] if kind == FAULT and PRIMARY in dataset.labels().column_names else []
    table = dataset.labels(columns=["state", "state_id", "fault", *primary])
    labels = {name: np.asarray(table.column(name).to_pylist()) for name in table.column_names}
    return record_classes(labels, kind, healthy)


def _fault(labels: Mapping[str, np.ndarray], state: str) -> str:
    """Return the primary fault of a state: the one of its records that are not healthy."""
    words = labels[PRIMARY] if PRIMARY in labels else labels["fault"]
    found = [word for word in dict.fromkeys(words[labels["state"] == state].tolist()) if word != HEALTHY]
    if len(found) > 1:
        raise DatasetError(
            f"state {state}: its records have the primary faults {', '.join(found)}; allowed is one for each state. "
            "Give them states of their own, or take states as classes."
        )
    return found[0] if found else HEALTHY
