"""The specimen-wise split of a set, checked: no specimen in two splits, every split usable."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from diagnostics.records.state_classes import CLASS, class_members, class_names, healthy_states
from siggen.errors import DatasetError

TRAIN, VALIDATION, TEST = "train", "validation", "test"
FEWEST_SPECIMENS = 2


@dataclass(frozen=True, slots=True)
class SpecimenSplit:
    """Record masks of the three splits, and what is told apart.

    Attributes
    ----------
    train, validation, test : (n,) bool
        Whose records are whose.
    classes : tuple of str
        States in the order of the configuration, all healthy ones as one class under the name of the first.
    healthy : str or None
        Name of that class; None where no state is healthy throughout.
    members : dict of str to tuple of str
        States of every class.
    """

    train: np.ndarray
    validation: np.ndarray
    test: np.ndarray
    classes: tuple[str, ...]
    healthy: str | None = None
    members: dict[str, tuple[str, ...]] = field(default_factory=dict)


def check_specimens(specimen: np.ndarray, split: np.ndarray) -> None:
    """Check that no specimen occurs in two splits.

    Raises
    ------
    DatasetError
        Naming the specimens that do: a score on them would measure memory, not diagnosis.
    """
    owners: dict[int, set[str]] = {}
    for number, name in zip(specimen.tolist(), split.tolist(), strict=True):
        owners.setdefault(number, set()).add(name)
    shared = {number: sorted(names) for number, names in owners.items() if len(names) > 1}
    if shared:
        shown = ", ".join(f"specimen {number} in {' and '.join(names)}" for number, names in sorted(shared.items())[:5])
        raise DatasetError(
            f"{len(shared)} specimens occur in more than one split ({shown}); a specimen may be in one only, "
            "otherwise the test repeats what was trained on. Generate the set again or correct its `split` column."
        )


def specimen_split(labels: dict[str, np.ndarray]) -> SpecimenSplit:
    """Return the split of labelled records.

    Parameters
    ----------
    labels : dict of str to (n,)
        Columns `specimen_id`, `split`, `state`, `state_id`, `fault`.

    Raises
    ------
    DatasetError
        If a specimen is in two splits, training or test has no specimen, training has a single
        state, or a single specimen of a state.
    """
    check_specimens(labels["specimen_id"], labels["split"])
    masks = {name: labels["split"] == name for name in (TRAIN, VALIDATION, TEST)}
    counts = {name: int(np.unique(labels["specimen_id"][mask]).size) for name, mask in masks.items()}
    for name in (TRAIN, TEST):
        if counts[name] == 0:
            raise DatasetError(
                f"split {name!r} has no specimens: received {_listed(counts)}; training and judging need at least one "
                "specimen each. Generate more specimens (`--set specimens=N`, new folder) or change `splits`."
            )
    own = class_names(labels)
    members = class_members({**labels, CLASS: own})
    _check_classes(labels, own, masks[TRAIN])
    healthy = next(iter(healthy_states(labels)), None)
    return SpecimenSplit(masks[TRAIN], masks[VALIDATION], masks[TEST], tuple(members), healthy, members)


def _check_classes(labels: dict[str, np.ndarray], own: np.ndarray, train: np.ndarray) -> None:
    """Check that training has two classes, and of each more than one specimen."""
    specimens = {
        name: int(np.unique(labels["specimen_id"][train & (own == name)]).size)
        for name in dict.fromkeys(own[train].tolist())
    }
    if len(specimens) < 2:
        states = sorted(set(labels["state"][train].tolist()))
        found = f"the single state {states}" if len(states) == 1 else f"healthy states only ({', '.join(states)})"
        raise DatasetError(
            f"training has {found}; a classifier needs at least two states that differ by damage. Add damaged "
            "and healthy states under `states` in the configuration, and generate the set into a new folder."
        )
    if single := [state for state, count in specimens.items() if count < FEWEST_SPECIMENS]:
        raise DatasetError(
            f"training has one specimen of {', '.join(single)}; a classifier would learn that gearbox instead of its "
            "state. Generate more specimens (`--set specimens=N`, new folder) or give `splits` a larger share of train."
        )


def _listed(counts: dict[str, int]) -> str:
    return ", ".join(f"{name} {count}" for name, count in counts.items())
