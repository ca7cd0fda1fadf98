"""A copy of a set with a leak in its files, sealed as if siggen had written it."""

from __future__ import annotations

import shutil
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from siggen.dataset.seal import sealed, unsealed
from siggen.dataset.shard import packed, parquet_options
from tests.dataset.resealed_set import reseal
from tests.diagnostics.planted.leak import Leak, Signals


def planted_copy(source: Path, folder: Path, leak: Leak) -> Path:
    """Copy a set into a new folder, plant a leak, seal its manifest again; return the folder."""
    shutil.copytree(source, folder)
    names = channel_columns(folder)
    for file in sorted((folder / "data").glob("*.parquet")):
        rows = planted(pq.read_table(file), leak, names, _fs_hz(folder))
        _rewrite(file, rows)
        if leak.is_grouped:
            _group(file, rows)
    file = folder / "labels.parquet"
    rows = pq.read_table(file)
    leaky = leak.labels(rows, damaged(rows)) if leak.labels else rows
    _rewrite(file, leaky.take(pc.index_in(_ids(folder), leaky["record_id"].combine_chunks())))
    _list_columns(folder)
    reseal(folder)
    return folder


def _ids(folder: Path) -> pa.ChunkedArray:
    """Return the record ids in the order of the signals."""
    files = [folder / f"data/{shard['shard']}.parquet" for shard in _manifest(folder)["shards"]]
    return pa.concat_tables([pq.read_table(file, columns=["record_id"]) for file in files])["record_id"]


def damaged(rows: pa.Table) -> np.ndarray:
    """Return which rows show damage; a sham does not."""
    return np.asarray(rows["fault"]) != "healthy"


def planted(rows: pa.Table, leak: Leak, names: list[str], fs_hz: float) -> pa.Table:
    """Return rows of signals and labels with a leak; `names` as of `channel_columns`."""
    if leak.channels or leak.tacho:
        rows = _with_signals(rows, leak, names, fs_hz)
    return leak.labels(rows, damaged(rows)) if leak.labels else rows


def _with_signals(rows: pa.Table, leak: Leak, names: list[str], fs_hz: float) -> pa.Table:
    records = [_signals(rows, row, names, fs_hz) for row in range(rows.num_rows)]
    leaky = [record.is_damaged or leak.is_for_all for record in records]
    if leak.channels:
        made = [
            _converted(leak.channels(record), record) if is_leaky else record.channels
            for record, is_leaky in zip(records, leaky, strict=True)
        ]
        for index, name in enumerate(names):
            rows = _with_lists(rows, name, [one[index] for one in made])
    if leak.tacho:
        made = [leak.tacho(r) if is_leaky else r.tacho_s for r, is_leaky in zip(records, leaky, strict=True)]
        rows = _with_lists(rows, "tacho_s", made)
    return rows


def _signals(rows: pa.Table, row: int, names: list[str], fs_hz: float) -> Signals:
    channels = np.stack([_list(rows, name, row).astype(float) for name in names])
    return Signals(
        channels,
        _list(rows, "tacho_s", row),
        np.array([[converter_step(channel)] for channel in channels]),
        rows["record_id"][row].as_py(),
        bool(damaged(rows)[row]),
        fs_hz,
        rows["mesh_hz"][row].as_py(),
    )


def _converted(channels: np.ndarray, record: Signals) -> np.ndarray:
    """Round to codes; a part of a step, as the first converter lost it, keeps ties from favouring even codes."""
    lost = np.random.default_rng([3, record.record_id]).uniform(-0.49, 0.49, channels.shape)
    return np.round(channels / record.steps + lost) * record.steps


def _list(rows: pa.Table, name: str, row: int) -> np.ndarray:
    return np.asarray(rows[name][row].values)


def _with_lists(rows: pa.Table, name: str, lists: list[np.ndarray]) -> pa.Table:
    index = rows.schema.get_field_index(name)
    field = rows.schema.field(index)
    values = [one.astype(field.type.value_type.to_pandas_dtype()) for one in lists]
    return rows.set_column(index, field, pa.array(values, field.type))


def channel_columns(folder: Path) -> list[str]:
    """Return the columns of the channels of a set."""
    return [channel["column"] for channel in _manifest(folder)["channels"]]


def converter_step(samples: np.ndarray) -> float:
    """Return the largest power of two that all samples are multiples of."""
    exponents = (e for e in range(20, -40, -1) if not np.any(np.ldexp(samples.astype(float), -e) % 1.0))
    return float(2.0 ** next(exponents))


def _rewrite(path: Path, rows: pa.Table) -> None:
    """Write rows in the place of those of a file, as siggen does."""
    path.write_bytes(packed(rows))


def _group(path: Path, rows: pa.Table) -> None:
    """Write rows with a row group for each run of damaged and of other rows."""
    edges = [0, *(np.flatnonzero(np.diff(damaged(rows))) + 1).tolist(), rows.num_rows]
    with pq.ParquetWriter(path, rows.schema, **parquet_options(rows.schema)) as writer:
        for start, stop in pairwise(edges):
            writer.write_table(rows.slice(start, stop - start).combine_chunks())


def _list_columns(folder: Path) -> None:
    """Give columns that are new their place among those of the manifest."""
    manifest = _manifest(folder)
    known = {column["name"] for column in manifest["columns"]}
    schema = pq.read_schema(folder / "labels.parquet")
    for index, field in enumerate(schema):
        if field.name not in known:
            role = field.metadata[b"role"].decode()
            manifest["columns"].insert(index, {"name": field.name, "role": role, "section": ""})
    (folder / "manifest.json").write_bytes(sealed(manifest))


def _manifest(folder: Path) -> dict[str, Any]:
    return unsealed("manifest.json", (folder / "manifest.json").read_bytes())


def _fs_hz(folder: Path) -> float:
    schema = pq.read_schema(next((folder / "data").glob("*.parquet")))
    return float(schema.metadata[b"fs_hz"])
