"""The states of a set that a judgement takes: the healthy ones, and the damages that the user names."""

from __future__ import annotations

from collections.abc import Sequence

from diagnostics.records.state_classes import HEALTHY
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError


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
