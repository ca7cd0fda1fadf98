"""The set that is trained on and the one that is judged on too, opened, checked, with their feature tables."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pyarrow as pa

from diagnostics.base.progress import Stage
from diagnostics.indicators.classifier_table import check_table, classifier_table
from diagnostics.indicators.own_indicator import OwnIndicator
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.records.record_classes import STATE
from diagnostics.records.usable_records import with_channels
from diagnostics.training.other_set import OtherSet, check_other_set
from siggen.dataset import reading
from siggen.dataset.reading import Dataset


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
