"""Indicators of every record of a set as one table: labels, revolutions averaged, notes, one column per feature."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from diagnostics.indicators.features import FeatureSettings, record_features
from diagnostics.records.recording import LABEL_NAMES, Recording, recordings
from diagnostics.records.state_classes import CLASS, class_names
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError, UsageError

BOOKKEEPING = ("revolutions_pinion", "revolutions_gear", "notes")
SETTINGS_KEY = b"diagnostics.indicators.features"
NOTES_KEY = b"diagnostics.notes"
WRITERS = (".parquet", ".csv")


@dataclass(frozen=True, slots=True)
class FeatureMatrix:
    """Labels and indicators of all records as arrays.

    Attributes
    ----------
    values : (records, features) float64
        NaN where undefined.
    names : tuple of str
        Feature names, `<definition>__<channel>`.
    labels : dict of str to (records,)
        Label columns, and `class`: what classifiers tell apart.
    """

    values: np.ndarray
    names: tuple[str, ...]
    labels: dict[str, np.ndarray]

    def rows(self, mask: np.ndarray) -> FeatureMatrix:
        """Return the chosen records."""
        return FeatureMatrix(self.values[mask], self.names, {k: v[mask] for k, v in self.labels.items()})

    def columns(self, names: Sequence[str]) -> FeatureMatrix:
        """Return the chosen features."""
        position = [self.names.index(name) for name in names]
        return FeatureMatrix(self.values[:, position], tuple(names), self.labels)


def feature_table(
    dataset: Dataset,
    splits: Sequence[str] | None = None,
    settings: FeatureSettings | None = None,
    advance: Callable[[], None] | None = None,
) -> pa.Table:
    """Return the indicators of a set, one row per record in the order of the files.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    splits : sequence of str, optional
        Default: all.
    settings : FeatureSettings, optional
        Stored in the table's metadata.
    advance : callable, optional
        Called after every record.

    Raises
    ------
    DatasetError
        If the set holds no records.
    """
    chosen = settings or FeatureSettings()
    rows = list(_rows(recordings(dataset, splits), chosen, advance))
    if not rows:
        raise DatasetError(f"{dataset.path}: no records to take features of; received splits {list(dataset.splits)}")
    table = pa.Table.from_pylist(rows)
    return table.replace_schema_metadata({SETTINGS_KEY: json.dumps(asdict(chosen)).encode()})


def _rows(
    records: Iterator[Recording], settings: FeatureSettings, advance: Callable[[], None] | None
) -> Iterator[dict[str, Any]]:
    for record in records:
        teeth = (int(record.labels["teeth_pinion"]), int(record.labels["teeth_gear"]))
        found = record_features(record.channels, record.tacho_s, record.fs_hz, teeth, settings)
        bookkeeping = (found.revolutions_pinion, found.revolutions_gear, found.notes)
        yield {**record.labels, **dict(zip(BOOKKEEPING, bookkeeping, strict=True)), **found.values}
        if advance:
            advance()


def with_notes(table: pa.Table, notes: Sequence[str]) -> pa.Table:
    """Return the table with notes on its records in the metadata; `table_notes` reads them."""
    metadata = {**(table.schema.metadata or {}), NOTES_KEY: json.dumps(list(notes)).encode()}
    return table.replace_schema_metadata(metadata)


def table_notes(table: pa.Table) -> tuple[str, ...]:
    """Return the notes on a table's records; none where it carries none."""
    return tuple(json.loads((table.schema.metadata or {}).get(NOTES_KEY, b"[]")))


def feature_settings(table: pa.Table) -> FeatureSettings:
    """Return the settings a feature table was made with."""
    return FeatureSettings(**json.loads(table.schema.metadata[SETTINGS_KEY]))


def feature_names(table: pa.Table) -> tuple[str, ...]:
    """Return the feature columns of a table."""
    known = {*LABEL_NAMES, *BOOKKEEPING}
    return tuple(name for name in table.column_names if name not in known)


def feature_matrix(table: pa.Table, healthy: str | None = None) -> FeatureMatrix:
    """Return a feature table as arrays; healthy states are one class, see `diagnostics.records.state_classes`.

    Parameters
    ----------
    table : pyarrow.Table
        What `feature_table` returned.
    healthy : str, optional
        Name of the healthy class; default the first healthy state of the table.
    """
    names = feature_names(table)
    columns = [table.column(name).to_numpy(zero_copy_only=False).astype(np.float64) for name in names]
    labels = {name: np.asarray(table.column(name).to_pylist()) for name in LABEL_NAMES}
    labels[CLASS] = class_names(labels, healthy)
    return FeatureMatrix(np.stack(columns, axis=1), names, labels)


def check_suffix(path: Path) -> None:
    """Check that a table can be written under this name.

    Raises
    ------
    UsageError
        If the suffix is neither .parquet nor .csv.
    """
    if path.suffix not in WRITERS:
        raise UsageError(f"{path}: received suffix {path.suffix!r}; allowed are {', '.join(WRITERS)}")


def write_table(table: pa.Table, path: Path) -> None:
    """Write a table as Parquet or CSV, by the file's suffix; undefined values are NaN.

    Raises
    ------
    UsageError
        If the suffix is neither.
    """
    check_suffix(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.suffix == ".csv":
        from pyarrow import csv

        csv.write_csv(table, path)
        return
    from pyarrow import parquet

    parquet.write_table(table, path, compression="zstd")
