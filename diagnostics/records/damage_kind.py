"""What kind of damage a state holds; sizes mean something among states of one kind only."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

THROUGH = " through the face"


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
