"""The specimen-wise split of a set, checked: no specimen in two splits, every split usable."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from diagnostics.records.record_classes import FAULT, STATE, RecordClasses, record_classes
from siggen.errors import DatasetError

TRAIN, VALIDATION, TEST = "train", "validation", "test"
FEWEST_SPECIMENS = 2
DIFFERENT = {STATE: "states that differ by damage", FAULT: "faults, of which healthy counts as one"}


@dataclass(frozen=True, slots=True)
class SpecimenSplit:
    """Record masks of the three splits, and what is told apart.

    Attributes
    ----------
    train, validation, test : (n,) bool
        Whose records are whose.
    classes : tuple of str
        In the order of the configuration.
    healthy : str or None
        Name of that class; None where no state is healthy throughout.
    members : dict of str to tuple of str
        States of every class.
    kind : str
        What a class is: `state` or `fault`.
    """

    train: np.ndarray
    validation: np.ndarray
    test: np.ndarray
    classes: tuple[str, ...]
    healthy: str | None = None
    members: dict[str, tuple[str, ...]] = field(default_factory=dict)
    kind: str = STATE


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


def specimen_split(labels: dict[str, np.ndarray], classes: RecordClasses | None = None) -> SpecimenSplit:
    """Return the split of labelled records.

    Parameters
    ----------
    labels : dict of str to (n,)
        Columns `specimen_id`, `split`, `state`, `state_id`, `fault`.
    classes : RecordClasses, optional
        Of the set; default its states, the healthy ones as one.

    Raises
    ------
    DatasetError
        If a specimen is in two splits, training or test has no specimen, training has a single
        class, or a single specimen of a class.
    """
    check_specimens(labels["specimen_id"], labels["split"])
    masks = {name: labels["split"] == name for name in (TRAIN, VALIDATION, TEST)}
    counts = {name: int(np.unique(labels["specimen_id"][mask]).size) for name, mask in masks.items()}
    for name in (TRAIN, TEST):
        if counts[name] == 0:
            raise DatasetError(
                f"split {name!r} has no specimens: received {_listed(counts)}; training and judging need at least one "
                "specimen each. The same `siggen generate` with `--set specimens=N` goes on with this set; or change "
                "`splits`, in a new folder."
            )
    classes = classes or record_classes(labels)
    _check_classes(labels, classes, masks[TRAIN])
    told = (classes.names, classes.healthy, classes.members, classes.kind)
    return SpecimenSplit(masks[TRAIN], masks[VALIDATION], masks[TEST], *told)


def _check_classes(labels: dict[str, np.ndarray], classes: RecordClasses, train: np.ndarray) -> None:
    """Check that training has two classes, and of each more than one specimen."""
    own = classes.of(labels["state"])
    specimens = {
        name: int(np.unique(labels["specimen_id"][train & (own == name)]).size)
        for name in dict.fromkeys(own[train].tolist())
    }
    if len(specimens) < 2:
        states = sorted(set(labels["state"][train].tolist()))
        found = f"the single {classes.kind} {sorted(specimens)}"
        if len(states) > 1:
            found = "healthy states only" if classes.healthy in specimens else found
            found += f" ({', '.join(states)})"
        raise DatasetError(
            f"training has {found}; a classifier needs at least two {DIFFERENT[classes.kind]}. Add damaged "
            "and healthy states under `states` in the configuration, and generate the set into a new folder."
        )
    if single := [name for name, count in specimens.items() if count < FEWEST_SPECIMENS]:
        raise DatasetError(
            f"training has one specimen of {', '.join(single)}; a classifier would learn that gearbox instead of its "
            f"{classes.kind}. The same `siggen generate` with `--set specimens=N` goes on with this set; or give "
            "`splits` a larger share of train, in a new folder."
        )


def _listed(counts: dict[str, int]) -> str:
    return ", ".join(f"{name} {count}" for name, count in counts.items())
