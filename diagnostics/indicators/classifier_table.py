"""What classifiers and the report take of the one table: all indicators of single records, with labels.

`diagnostics.table`: all indicators of a set with labels, for one's own classifier.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

import siggen
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.own_indicator import load_indicators
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.indicators.table import RecordTable, record_table, revolution_columns
from diagnostics.records.gear_train import MeshNames
from diagnostics.records.record_classes import STATE, RecordClasses, check_dataset, record_classes, set_classes
from diagnostics.records.state_classes import CLASS, SHAM
from diagnostics.records.usable_records import RecordCheck, first_lines, problem_lines
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError, UsageError
from siggen.file_writing import write_file
from siggen.keys.column import Role

SETTINGS_KEY = b"diagnostics.indicators"
NOTES_KEY = b"diagnostics.notes"
LABELS_KEY, OTHERS_KEY, GEARS_KEY = b"diagnostics.labels", b"diagnostics.others", b"diagnostics.gears"
"""Columns that are labels, those that are neither labels nor indicators, and what indicators are called after."""
LIFE_LABELS = {"age_h": Role.CONDITION, "rul_h": Role.TARGET}
"""Age and remaining life of an inspection [h]."""
WRITERS = (".parquet", ".csv")
KINDS = ("through_face", SHAM)


def table(dataset: Dataset, *, indicators: Sequence[str] = (), workers: int = 1, classes: str = STATE) -> FeatureMatrix:
    """Return one row per record: indicators of every channel, labels with their roles, gearbox and split.

    Sets of lives have the labels `age_h` and `rul_h` in place of `class`. Indicators that no record has are left out,
    and named in `undefined`; single values may be NaN.

    The indicators are those that the classifiers of `siggen-diagnostics report` take. They are kept beside the set, so
    that only the first call computes them.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    indicators : sequence of str
        Your own besides, as `MODULE:FUNCTION`.
    workers : int
        Processes for the first call.
    classes : str
        What the label `class` is: the `state` of a record, or its primary `fault`; healthy ones are one class.

    Returns
    -------
    FeatureMatrix

    Raises
    ------
    DatasetError
        If records cannot be used; the message names them.
    UsageError
        If the classes are of an unknown kind, or no set is given.
    """
    check_dataset(dataset, "table")
    lives = dataset.config.get("life") is not None
    told = None if lives else set_classes(dataset, classes)
    found = record_table(dataset, own=load_indicators(list(indicators)), workers=workers)
    notes = check_table(found, dataset)
    for note in notes:
        warnings.warn(f"{dataset.path}: {note}", stacklevel=2)
    own = classifier_table(found, notes)
    matrix = with_kinds(_arrays(own) if lives else feature_matrix(own, told), dataset).defined()
    roles = {name: dataset.role(name) for name in matrix.labels}
    if not lives:
        return replace(matrix, label_roles={**roles, CLASS: Role.TARGET})
    labels = {**matrix.labels, **_life_labels(dataset, matrix.labels)}
    return replace(matrix, labels=labels, label_roles={**roles, **LIFE_LABELS})


def with_kinds(matrix: FeatureMatrix, dataset: Dataset) -> FeatureMatrix:
    """Return the matrix with the labels that set damage through the face and shams apart, where the set has them."""
    present = [name for name in KINDS if name in dataset.labels().column_names]
    by_record = {row["record_id"]: row for row in dataset.labels(columns=["record_id", *present]).to_pylist()}
    rows = [by_record[record] for record in matrix.labels["record_id"].tolist()]
    more = {name: np.array([bool(row[name]) for row in rows]) for name in present}
    return replace(matrix, labels={**matrix.labels, **more})


def _life_labels(dataset: Dataset, labels: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return age and remaining life of records; NaN where a gearbox was taken out, or a benchmark does not tell."""
    rows = {(row["specimen_id"], row["inspection"]): row for row in dataset.life("inspections").to_pylist()}
    own = [rows[key] for key in zip(labels["specimen_id"].tolist(), labels["state_id"].tolist(), strict=True)]
    return {name: np.array([row.get(name) for row in own], dtype=np.float64) for name in LIFE_LABELS}


def check_table(table: RecordTable, dataset: Dataset, *, can_leave_channels: bool = False) -> tuple[str, ...]:
    """Check that every record can be used: known gears, a usable angle, channels finite, varying and not clipped.

    Parameters
    ----------
    table : RecordTable
        Of the set.
    dataset : siggen Dataset
        The set.
    can_leave_channels : bool
        Whether the command has `--channel`, which the message then offers.

    Returns
    -------
    tuple of str
        Notes on what is used all the same.

    Raises
    ------
    DatasetError
        As of `RecordCheck.finish`, or if an indicator of the user's fails.
    """
    check, own = RecordCheck(), {*table.channels, ""}
    numbers = table.select(["record_id"]).column("record_id").to_pylist()
    for number, refused, clipped in zip(numbers, table.texts("refused"), table.texts("clipped"), strict=True):
        check.add(
            int(number),
            [(channel, text) for channel, text in refused if channel in own],
            [channel for channel in clipped if channel in own],
        )
    notes = check.finish(dataset, can_leave_channels=can_leave_channels)
    if table.own_problems:
        raise DatasetError(
            f"{dataset.path}: an indicator of yours failed\n{first_lines(problem_lines(table.own_problems))}\n"
            "Mend the function, or leave the indicator out."
        )
    return (*notes, table.note) if table.note else notes


def classifier_table(table: RecordTable, notes: Sequence[str] = ()) -> pa.Table:
    """Return labels, revolutions, notes and the columns that classifiers take, with the settings in the metadata.

    Parameters
    ----------
    table : RecordTable
        Of the set, checked.
    notes : sequence of str
        Notes on its records; `table_notes` reads them.
    """
    names = table.names()
    values = dict(zip(names, table.values(names).T, strict=True))
    others = [*revolution_columns(table.named), "notes"]
    found = table.select([*table.label_names, *others])
    for name, column in values.items():
        found = found.append_column(name, pa.array(column))
    said = {
        SETTINGS_KEY: asdict(table.settings),
        NOTES_KEY: list(notes),
        LABELS_KEY: table.label_names,
        OTHERS_KEY: others,
        GEARS_KEY: table.named,
    }
    return found.replace_schema_metadata({key: json.dumps(value).encode() for key, value in said.items()})


def table_notes(table: pa.Table) -> tuple[str, ...]:
    """Return the notes on a table's records; none where it carries none."""
    return tuple(json.loads((table.schema.metadata or {}).get(NOTES_KEY, b"[]")))


def table_settings(table: pa.Table) -> IndicatorSettings:
    """Return the settings that a table was made with."""
    return IndicatorSettings(**json.loads(table.schema.metadata[SETTINGS_KEY]))


def indicator_names(table: pa.Table) -> tuple[str, ...]:
    """Return the columns of a table that are indicators."""
    known = {name for key in (LABELS_KEY, OTHERS_KEY) for name in _listed(table, key)}
    return tuple(name for name in table.column_names if name not in known)


def _listed(table: pa.Table, key: bytes) -> list[Any]:
    return list(json.loads(table.schema.metadata[key]))


def feature_matrix(table: pa.Table, classes: RecordClasses | None = None) -> FeatureMatrix:
    """Return a classifier table as arrays, with the class of every record among its labels.

    Parameters
    ----------
    table : pyarrow.Table
        What `classifier_table` returned.
    classes : RecordClasses, optional
        Of the set; default its states, the healthy ones as one.
    """
    found = _arrays(table)
    found.labels[CLASS] = (classes or record_classes(found.labels)).of(found.labels["state"])
    return found


def _arrays(table: pa.Table) -> FeatureMatrix:
    """Return a classifier table as arrays, without classes."""
    names = indicator_names(table)
    columns = [table.column(name).to_numpy(zero_copy_only=False).astype(np.float64) for name in names]
    labels = {name: np.asarray(table.column(name).to_pylist()) for name in _listed(table, LABELS_KEY)}
    gears = tuple(MeshNames(name, tuple(own), planetary) for name, own, planetary in _listed(table, GEARS_KEY))
    return FeatureMatrix(np.stack(columns, axis=1), names, labels, gears=gears)


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
    if path.suffix == ".csv":
        siggen.write_csv(table, path)
        return
    from pyarrow import parquet

    write_file(path, lambda draft: parquet.write_table(table, draft, compression="zstd"))
