"""What classifiers tell apart: the states of a set, all of its healthy states together as one class.

A set may have several healthy states (a second healthy record of every gearbox is what paired comparisons need). They
differ by noise and start angle alone, so asking which of them a record is in would only dilute the scores.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

HEALTHY = "healthy"
CLASS = "class"
"""Label column with the name of each record's class, beside `state`, which stays as it is."""


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


def class_names(labels: Mapping[str, np.ndarray], healthy: str | None = None) -> np.ndarray:
    """Return the class of every record, (n,) str: its state, or one name for all healthy states.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Columns `state`, `state_id`, `fault`.
    healthy : str, optional
        Name of the healthy class; default the first healthy state. Another set needs the name of the set that was
        trained on.
    """
    merged = healthy_states(labels)
    name = healthy or (merged[0] if merged else "")
    return np.array([name if state in merged else state for state in labels["state"].tolist()])


def class_ids(labels: Mapping[str, np.ndarray]) -> dict[str, int]:
    """Return the position of every state's class among the classes of a set.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Columns `state`, `state_id`, `fault`, of all splits, so that they agree on the numbers.
    """
    members = class_members({**labels, CLASS: class_names(labels)})
    return {state: number for number, states in enumerate(members.values()) for state in states}


def class_members(labels: Mapping[str, np.ndarray]) -> dict[str, tuple[str, ...]]:
    """Return the states of every class, in the order of the configuration; a class stands where its first state does.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Columns `state`, `state_id`, `class`.
    """
    owner = dict(zip(labels["state"].tolist(), labels[CLASS].tolist(), strict=True))
    members: dict[str, tuple[str, ...]] = {}
    for state in ordered_states(labels):
        members[owner[state]] = (*members.get(owner[state], ()), state)
    return members
