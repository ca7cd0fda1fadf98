"""The states of a set that a judgement takes: the healthy ones, and the damages that the user names.

What kind of damage a state holds; sizes mean something among states of one kind only.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

THROUGH = " through the face"

HEALTHY, SHAM = "healthy", "sham"
CLASS = "class"
"""Label column with the name of each record's class, beside `state`, which stays as it is."""


def chosen_states(dataset: Dataset, names: Sequence[str]) -> tuple[str, ...]:
    """Return all healthy states and the named ones, in the order of the set.

    A set may hold several ladders of damage, such as pits beside spalls of growing length. Sizes, trends and histories
    only mean something along one of them.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    names : sequence of str
        States to take besides the healthy ones; all where empty.

    Raises
    ------
    UsageError
        If the set has no state of that name, or it is a healthy one.
    """
    labels = dataset.labels(columns=["state_id", "state", "fault"]).to_pylist()
    faults = {row["state"]: row["fault"] for row in sorted(labels, key=lambda row: row["state_id"])}
    if unknown := [name for name in names if name not in faults]:
        raise UsageError(f"{dataset.path}: has no state {', '.join(unknown)}; it has {', '.join(faults)}")
    if healthy := [name for name in names if faults[name] == HEALTHY]:
        damaged = [state for state, fault in faults.items() if fault != HEALTHY]
        raise UsageError(
            f"{dataset.path}: state {', '.join(healthy)} is healthy and taken anyway; name damaged ones, "
            f"of which the set has {', '.join(damaged) or 'none'}"
        )
    return tuple(state for state, fault in faults.items() if not names or fault == HEALTHY or state in names)


def damage_kind(labels: Mapping[str, np.ndarray], rows: np.ndarray) -> str:
    """Return the fault; damage through the face is another kind, since no land beside it carries at any length.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Column `fault`, and `through_face` where the set has it.
    rows : (n,) bool
        Records of one state.
    """
    fault = str(labels["fault"][rows][0])
    through = "through_face" in labels and bool(np.all(labels["through_face"][rows]))
    return f"{fault}{THROUGH}" if through else fault


def kind_name(kind: str, others: Iterable[str]) -> str:
    """Return what a reader calls a kind: of a part of the face, where the same damage through it is a kind as well."""
    return f"{kind} of a part of the face" if f"{kind}{THROUGH}" in others else kind


def damage_kinds(labels: Mapping[str, np.ndarray], states: Sequence[str]) -> dict[str, list[str]]:
    """Return the states of every kind of damage, in the given order; `labels` has the column `state` too."""
    kinds: dict[str, list[str]] = {}
    for state in states:
        kinds.setdefault(damage_kind(labels, labels["state"] == state), []).append(state)
    return kinds


def ordered_states(labels: Mapping[str, np.ndarray]) -> tuple[str, ...]:
    """Return the states in the order of the configuration.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Columns `state`, `state_id`.
    """
    order = dict(zip(labels["state"].tolist(), labels["state_id"].tolist(), strict=True))
    return tuple(sorted(order, key=lambda state: order[state]))


def healthy_states(labels: Mapping[str, np.ndarray]) -> tuple[str, ...]:
    """Return the states whose every record is healthy, in the order of the configuration.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Columns `state`, `state_id`, `fault`.
    """
    damaged = set(labels["state"][labels["fault"] != HEALTHY].tolist())
    return tuple(state for state in ordered_states(labels) if state not in damaged)
