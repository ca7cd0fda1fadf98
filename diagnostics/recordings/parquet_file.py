"""Parquet files: one row per sample, or one record per row with a list in every cell, as this package writes them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.recordings.recorded_columns import Columns, refuse_twice
from siggen.errors import UsageError

IDENTITY = b"siggen.identity"
"""Key of the schema's metadata in every file that siggen writes."""


def read_parquet(path: Path, row: int | None = None) -> Columns:
    """Read the numeric columns of a Parquet file.

    Parameters
    ----------
    path : Path
        The file.
    row : int, optional
        Which record, from zero, where every cell holds a list.

    Raises
    ------
    UsageError
        If it is not one, or the row is missing or not there.
    """
    import pyarrow as pa
    from pyarrow import parquet

    try:
        schema = parquet.read_schema(path)
        refuse_twice(path, schema.names)
        lists = [field.name for field in schema if _is_list(field.type)]
        numbers = [
            field.name for field in schema if pa.types.is_floating(field.type) or pa.types.is_integer(field.type)
        ]
        table = parquet.read_table(path, columns=lists or numbers)
    except (OSError, pa.ArrowInvalid) as error:
        raise UsageError(f"{path}: cannot be read as Parquet ({error})") from error
    simulated = IDENTITY in (schema.metadata or {})
    if not lists:
        return Columns({name: _numbers(table.column(name).combine_chunks()) for name in numbers}, simulated=simulated)
    chosen = 0 if row is None and table.num_rows == 1 else row
    if chosen is None or not 0 <= chosen < table.num_rows:
        raise UsageError(
            f"{path}: holds {table.num_rows} records, one per row; received row {row}. Choose one as "
            f"{path.name}:ROW, from 0 to {table.num_rows - 1}."
        )
    return Columns({name: _numbers(table.column(name)[chosen].values) for name in lists}, simulated=simulated)


def _is_list(kind: Any) -> bool:
    import pyarrow as pa

    listed = pa.types.is_list(kind) or pa.types.is_large_list(kind) or pa.types.is_fixed_size_list(kind)
    return bool(listed and (pa.types.is_floating(kind.value_type) or pa.types.is_integer(kind.value_type)))


def _numbers(array: Any) -> np.ndarray:
    return np.asarray(array.to_numpy(zero_copy_only=False), dtype=np.float64)
