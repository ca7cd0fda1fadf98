"""internals/: series that no sensor sees, as a second table of a set, one row per record that has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pyarrow as pa

from siggen.columns.record import ID_COLUMNS, SetColumns, SimulatedRecord, record_value, schema_metadata, signal_array
from siggen.errors import DatasetError
from siggen.keys.column import Column, list_of
from siggen.mesh.contact_names import PAIR_PREFIX, is_of_contact_alone


def internals_schema(columns: SetColumns) -> pa.Schema:
    """Return the schema of `internals/*.parquet`: the ids of the records, then one series per quantity."""
    series = [_field(columns, column) for column in columns.quantities]
    return pa.schema([*(column.field() for column in ID_COLUMNS), *series], metadata=schema_metadata(columns))


def internals_batch(columns: SetColumns, records: Sequence[SimulatedRecord]) -> pa.RecordBatch:
    """Return the internals of the records that have some, as rows of `internals_schema`.

    Raises
    ------
    DatasetError
        If a record lacks a quantity, or one has another number of samples.
    """
    schema = internals_schema(columns)
    chosen = [record for record in records if record.internals is not None]
    arrays = [pa.array([record_value(record, c.name) for record in chosen], c.type) for c in ID_COLUMNS]
    for quantity in columns.quantities:
        series = [_series(columns.sampling.samples, record, quantity.name) for record in chosen]
        arrays.append(signal_array(series, schema.field(quantity.name).type))
    return pa.RecordBatch.from_arrays(arrays, schema=schema)


def _field(columns: SetColumns, column: Column) -> pa.Field:
    facts = {"unit": column.unit, "meaning": column.meaning, "fs_hz": repr(float(columns.sampling.fs_hz))}
    return pa.field(column.name, list_of(pa.float32(), columns.sampling.samples), nullable=False, metadata=facts)


def _series(samples: int, record: SimulatedRecord, name: str) -> np.ndarray:
    internals: Mapping[str, np.ndarray] = record.internals or {}
    where = f"record {record.planned.record_id}, internal quantity {name}"
    if name not in internals:
        if PAIR_PREFIX in name:
            # Its teeth never have that many pairs in reach: what pairs without contact have.
            return np.full(samples, np.nan if is_of_contact_alone(name) else 0.0, dtype=np.float32)
        raise DatasetError(f"{where}: missing; the record has {', '.join(sorted(internals))}")
    values = np.asarray(internals[name], dtype=np.float32)
    if values.shape != (samples,):
        raise DatasetError(f"{where}: received shape {values.shape}; allowed is ({samples},)")
    return values
