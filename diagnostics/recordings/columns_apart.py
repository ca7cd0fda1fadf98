"""The columns of a recorded file, read in the process with limits; they come back as plain numbers in files.

Plain, since `numpy.load` parses a header as Python source, which fails in deep calls of Python 3.11.
"""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from diagnostics.base.reading_process import read_apart
from diagnostics.recordings.recorded_columns import Columns, refuse_many

LOADED_ONCE = ("diagnostics.recordings.file_columns", "pyarrow.csv", "pyarrow.parquet", "scipy.io")
"""What the reading process loads before it forks for a file."""


def columns_read_apart(path: Path, row: int | None = None) -> Columns:
    """Return `file_columns` of a file, read apart.

    Raises
    ------
    UsageError
        As of `file_columns` and `read_apart`.
    """
    with read_apart(path, f"{__name__}:keep_columns", row=row) as folder:
        return _columns(folder)


def keep_columns(path: Path, folder: Path, row: int | None) -> None:
    """Leave the columns of a recording in a folder; errors as of `file_columns`."""
    from diagnostics.recordings.file_columns import file_columns

    found = file_columns(path, row)
    refuse_many(path, len(found.values))
    facts = asdict(replace(found, values={})) | {"values": list(found.values)}
    (folder / "facts.json").write_text(json.dumps(facts), encoding="utf-8")
    for number, column in enumerate(found.values.values()):
        np.asarray(column, dtype=np.float64).tofile(folder / f"{number}.f64")


def _columns(folder: Path) -> Columns:
    facts = json.loads((folder / "facts.json").read_text(encoding="utf-8"))
    values = {name: np.fromfile(folder / f"{number}.f64") for number, name in enumerate(facts["values"])}
    return Columns(**{**facts, "values": values, "notes": tuple(facts["notes"])})
