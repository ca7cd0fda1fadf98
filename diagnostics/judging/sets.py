"""The set that is trained on and the one that is judged on too, opened, checked, with their feature tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa

from diagnostics.base.progress import Stage
from diagnostics.indicators.classifier_table import check_table, classifier_table
from diagnostics.indicators.own_indicator import OwnIndicator
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.records.record_classes import STATE, set_classes
from diagnostics.records.recording import names_of
from diagnostics.records.state_classes import HEALTHY
from diagnostics.records.usable_records import with_channels
from siggen.dataset import reading
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError


@dataclass(frozen=True, slots=True)
class OtherSet:
    """Another set to judge on: what `siggen.open` returned, and its feature table."""

    dataset: Dataset
    table: pa.Table


def check_other_set(dataset: Dataset, other: Dataset, kind: str = STATE) -> None:
    """Check that classifiers of a set can be judged on another one; `kind` says what their classes are.

    Raises
    ------
    UsageError
        If channels, sampling rate or indicators differ, no damage is known, or both are the same set.
    """
    if dataset.manifest["identity"] == other.manifest["identity"]:
        raise UsageError(f"--test {other.path}: is the set that is trained on; leave --test out, or give another set")
    names = [tuple(channel.name for channel in found.channels) for found in (dataset, other)]
    if names[0] != names[1]:
        raise UsageError(
            f"--test {other.path}: received the channels {', '.join(names[1])}; the classifiers take "
            f"{', '.join(names[0])}. Generate it with the same `sensors`, or choose common ones with --channel."
        )
    if dataset.fs_hz != other.fs_hz:
        raise UsageError(
            f"--test {other.path}: received a sampling rate of {other.fs_hz:g} Hz; the classifiers were trained at "
            f"{dataset.fs_hz:g} Hz, and indicators of another band are others. Generate it with `fs_hz: "
            f"{dataset.fs_hz:g}`."
        )
    named = [names_of(found) for found in (dataset, other)]
    if named[0] != named[1]:
        ours, theirs = (", ".join(dict.fromkeys(gear for mesh in one for gear in mesh.gears)) for one in named)
        raise UsageError(
            f"--test {other.path}: received indicators of {theirs}; the classifiers take those of {ours}. Generate it "
            "with the same names in `stages`, or the same kind of gearbox."
        )
    known, found = (set(set_classes(each, kind, HEALTHY).names) for each in (dataset, other))
    if not found & known - {HEALTHY}:  # any healthy state belongs to the healthy class, whatever its name
        raise UsageError(
            f"--test {other.path}: has the {kind}s {', '.join(sorted(found - known))}, which training does not know; "
            f"allowed are {', '.join(sorted(known))} and others beside them. Name its {kind}s like those, or train on "
            "a set that has them."
        )


def open_sets(
    directory: Path, test: Path | None, channels: Sequence[str], classes: str = STATE
) -> tuple[Any, Any | None]:
    """Open both sets with the named channels, all where none is named; `classes` are states or faults.

    Raises
    ------
    DatasetError
        If a folder is not a finished set.
    UsageError
        If a channel does not exist, or the second set cannot be judged by classifiers of the first.
    """
    dataset = with_channels(reading.open(directory), channels)
    if test is None:
        return dataset, None
    other = with_channels(reading.open(test), channels)
    check_other_set(dataset, other, classes)
    return dataset, other


def measured_table(
    dataset: Dataset, stage: Stage, title: str = "indicators", own: Sequence[OwnIndicator] = (), workers: int = 1
) -> RecordTable:
    """Return everything that is taken of the records of a set."""
    with stage(title, int(dataset.labels(columns=["record_id"]).num_rows)) as advance:
        return record_table(dataset, own=own, workers=workers, advance=advance)


def checked_table(table: RecordTable, dataset: Dataset) -> pa.Table:
    """Return what classifiers take of a set whose records are usable, with notes on those to be taken with care.

    Raises
    ------
    DatasetError
        As of `check_table`.
    """
    return classifier_table(table, check_table(table, dataset, can_leave_channels=True))


def set_table(dataset: Dataset, stage: Stage, title: str = "indicators", own: Sequence[OwnIndicator] = ()) -> pa.Table:
    """Return the checked table of a set."""
    return checked_table(measured_table(dataset, stage, title, own), dataset)


def other_table(other: Any, stage: Stage, own: Sequence[OwnIndicator] = ()) -> OtherSet:
    """Return the other set with its table."""
    return OtherSet(other, set_table(other, stage, "indicators of the other set", own))
