"""internals/: series that no sensor sees, as a second table of a set, one row per record that has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from siggen.columns.record import ID_COLUMNS, SimulatedRecord, record_value, schema_metadata
from siggen.dynamics.mesh.contact_names import PAIR_PREFIX, is_of_contact_alone
from siggen.errors import DatasetError
from siggen.keys.column import Column, list_of
from siggen.planning.plan import GROUP_BYTES, GROUP_CHANNEL_BYTES

if TYPE_CHECKING:
    from siggen.config import Config


def internals_schema(config: Config, quantities: Sequence[Column]) -> pa.Schema:
    """Return the schema of `internals/*.parquet`: the ids of the records, then one series per quantity."""
    series = [_field(config, column) for column in quantities]
    return pa.schema([*(column.field() for column in ID_COLUMNS), *series], metadata=schema_metadata(config))


def internals_group_rows(config: Config, quantities: Sequence[Column]) -> int:
    """Return the number of records in a row group, a power of two, so that a group stays below 64 MB."""
    row_bytes = config.samples * 4
    rows = min(GROUP_CHANNEL_BYTES // row_bytes, GROUP_BYTES // (row_bytes * max(1, len(quantities))))
    return 1 << (max(1, rows).bit_length() - 1)


def internals_batch(config: Config, quantities: Sequence[Column], records: Sequence[SimulatedRecord]) -> pa.RecordBatch:
    """Return the internals of the records that have some, as rows of `internals_schema`.

    Raises
    ------
    DatasetError
        If a record lacks a quantity, or one has another number of samples.
    """
    schema = internals_schema(config, quantities)
    chosen = [record for record in records if record.internals is not None]
    columns = [pa.array([record_value(record, c.name) for record in chosen], c.type) for c in ID_COLUMNS]
    for quantity in quantities:
        series = [_series(config, record, quantity.name) for record in chosen]
        values = np.concatenate(series) if series else np.empty(0, dtype=np.float32)
        column = pa.FixedSizeListArray.from_arrays(
            pa.array(values, pa.float32()), type=schema.field(quantity.name).type
        )
        columns.append(column)
    return pa.RecordBatch.from_arrays(columns, schema=schema)


def _field(config: Config, column: Column) -> pa.Field:
    facts = {"unit": column.unit, "meaning": column.meaning, "fs_hz": repr(float(config.fs_hz))}
    return pa.field(column.name, list_of(pa.float32(), config.samples), nullable=False, metadata=facts)


def _series(config: Config, record: SimulatedRecord, name: str) -> np.ndarray:
    internals: Mapping[str, np.ndarray] = record.internals or {}
    where = f"record {record.planned.record_id}, internal quantity {name}"
    if name not in internals:
        if PAIR_PREFIX in name:
            # Its teeth never have that many pairs in reach: what pairs without contact have.
            return np.full(config.samples, np.nan if is_of_contact_alone(name) else 0.0, dtype=np.float32)
        raise DatasetError(f"{where}: missing; the record has {', '.join(sorted(internals))}")
    values = np.asarray(internals[name], dtype=np.float32)
    if values.shape != (config.samples,):
        raise DatasetError(f"{where}: received shape {values.shape}; allowed is ({config.samples},)")
    return values
