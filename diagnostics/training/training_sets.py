"""The set that is trained on and the one that is judged on too, opened, checked, with their feature tables."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pyarrow as pa

from diagnostics.base.progress import Stage
from diagnostics.indicators.feature_table import feature_table, with_notes
from diagnostics.records.usable_channels import with_channels
from diagnostics.records.usable_records import check_records
from diagnostics.training.other_set import check_other_set
from diagnostics.training.training import OtherSet
from siggen.dataset import reading
from siggen.dataset.reading import Dataset


def open_sets(directory: Path, test: Path | None, channels: Sequence[str]) -> tuple[Any, Any | None]:
    """Open both sets with the named channels, all where none is named.

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
    check_other_set(dataset, other)
    return dataset, other


def set_table(dataset: Dataset, stage: Stage, title: str = "indicators") -> pa.Table:
    """Return the feature table of a set whose records are usable, with notes on those to be taken with care.

    Raises
    ------
    DatasetError
        As of `check_records`.
    """
    notes = check_records(dataset, can_leave_channels=True)
    with stage(title, int(dataset.labels(columns=["record_id"]).num_rows)) as advance:
        return with_notes(feature_table(dataset, advance=advance), notes)


def other_table(other: Dataset, stage: Stage) -> OtherSet:
    """Return the other set with its feature table."""
    return OtherSet(other, set_table(other, stage, "indicators of the other set"))
