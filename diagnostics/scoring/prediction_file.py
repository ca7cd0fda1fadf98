"""Predictions as columns: read from a file or taken from Python, and written by every training.

One row per record and classifier: `record_id`, the columns of a task (`diagnostics.scoring.tasks`), and `classifier`
where a file holds several. What trainings write names the set in its metadata, so that it is never laid beside another
one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from diagnostics.scoring.tasks import PROBABILITY
from diagnostics.statistics.evaluation import Predictions
from siggen.errors import UsageError

PREDICTIONS_FILE, MODELS_FOLDER = "predictions.parquet", "models"
RECORD, CLASSIFIER, SPLIT = "record_id", "classifier", "split"
IDENTITY_KEY = b"diagnostics.identity"


@dataclass(frozen=True, slots=True)
class PredictedRecords:
    """What a classifier of a training says of the records of one split."""

    classifier: str
    split: str
    record_id: np.ndarray
    predictions: Predictions


def write_predictions(entries: Sequence[PredictedRecords], identity: str, folder: Path) -> Path:
    """Write the probabilities of all classifiers into the folder of their models; return the file's path."""
    from pyarrow import parquet

    table = pa.concat_tables([_rows(entry) for entry in entries]).replace_schema_metadata(
        {IDENTITY_KEY: identity.encode()}
    )
    path = folder / PREDICTIONS_FILE
    parquet.write_table(table, path, compression="zstd")
    return path


def _rows(entry: PredictedRecords) -> pa.Table:
    found = entry.predictions
    columns = {f"{PROBABILITY}{name}": found.probability[:, k] for k, name in enumerate(found.classes)}
    names = {CLASSIFIER: [entry.classifier] * entry.record_id.size, SPLIT: [entry.split] * entry.record_id.size}
    return pa.table({**names, RECORD: pa.array(entry.record_id, pa.int64()), **columns})


def prediction_table(predictions: Any) -> pa.Table:
    """Return predictions as a table.

    Parameters
    ----------
    predictions : path, mapping of str to (n,), pyarrow table or data frame
        Files: .parquet or .csv.

    Raises
    ------
    UsageError
        If they cannot be read, or their columns differ in length.
    """
    try:
        return _read(Path(predictions)) if isinstance(predictions, str | Path) else pa.table(predictions)
    except (OSError, TypeError, ValueError, pa.ArrowException) as error:
        what = predictions if isinstance(predictions, str | Path) else "predictions"
        raise UsageError(
            f"{what}: no readable table ({error}); allowed are .parquet and .csv, and in Python columns by name"
        ) from error


def _read(path: Path) -> pa.Table:
    if path.suffix == ".csv":
        from pyarrow import csv

        return csv.read_csv(path)
    from pyarrow import parquet

    return parquet.ParquetFile(path).read()


def baselines_file(folder: Path) -> Path:
    """Return the file of predictions in a folder of `report`.

    Raises
    ------
    UsageError
        If there is none.
    """
    places = (folder, folder / MODELS_FOLDER)
    for place in places:
        if (place / PREDICTIONS_FILE).is_file():
            return place / PREDICTIONS_FILE
    raise UsageError(
        f"{folder}: has no {PREDICTIONS_FILE}; allowed: a folder that `siggen-diagnostics report` wrote. "
        "One of an earlier version has none: run that command again"
    )


def check_identity(table: pa.Table, identity: str, where: Any) -> None:
    """Check that predictions which name their set are of this one.

    Raises
    ------
    UsageError
        If they are of another one.
    """
    named = (table.schema.metadata or {}).get(IDENTITY_KEY, identity.encode()).decode()
    if named != identity:
        raise UsageError(
            f"{where}: holds predictions of the set {named[:12]}; this one is {identity[:12]}. Train on this set: "
            "siggen-diagnostics report"
        )
