"""Everything the audit measures of a set, once per record and channel, kept as Parquet beside the report."""

from __future__ import annotations

import hashlib
import json
import math
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from diagnostics.audit.channel_quantities import channel_quantities
from diagnostics.audit.speed_variation import speed_variation_percent
from diagnostics.records.recording import TACHO_NAME, Recording
from diagnostics.records.usable_records import RecordCheck
from diagnostics.signal.order_domain import angle_grid
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError

VERSION = "1"
"""Changes with every definition below, so that numbers of an older version are not taken over."""

CACHE_KEY = b"diagnostics.audit"
NEEDED = ("record_id", "teeth_pinion", "teeth_gear")
BATCH_ROWS = 16
TEXT_COLUMNS = ("channel",)


@dataclass(frozen=True, slots=True)
class MeasuredSet:
    """Labels of all records and what was measured of their channels.

    Attributes
    ----------
    labels : dict of str to (records,) array
        Scalar label columns as the set has them; lists stay lists (object arrays).
    channels : tuple of str
        Channel names.
    values : dict of str to (records, channels) float64
        Measured numbers by name, NaN where undefined.
    waveforms : list of lists of (orders,) complex64
        Lines of the averaged waveform by record and channel.
    sketches : list of lists of (k,) complex64
        Noise sketches, empty where there is no noise.
    checksums : (records, channels) int64
        Checksum of the samples of every channel.
    config, failures
        Configuration and failed records of the set.
    """

    labels: dict[str, np.ndarray]
    channels: tuple[str, ...]
    values: dict[str, np.ndarray]
    waveforms: list[list[np.ndarray]]
    sketches: list[list[np.ndarray]]
    checksums: np.ndarray
    config: dict[str, Any]
    failures: list[dict[str, Any]]

    @property
    def healthy(self) -> np.ndarray:
        """(records,) bool: which records show no damage."""
        return np.asarray(self.labels["fault"] == "healthy")

    def states(self) -> tuple[str, ...]:
        """Return the states in the order of the configuration."""
        order = dict(zip(self.labels["state"].tolist(), self.labels["state_id"].tolist(), strict=True))
        return tuple(sorted(order, key=lambda state: order[state]))


def measured_set(dataset: Dataset, cache: Path | None = None, advance: Callable[[], None] | None = None) -> MeasuredSet:
    """Measure a set, or read what an earlier call measured of this very set.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    cache : Path, optional
        Parquet file to read and write.
    advance : callable, optional
        Called after every record.

    Raises
    ------
    DatasetError
        If the set holds no records, or some that cannot be used.
    """
    key = _key(dataset)
    table = _cached(cache, key) if cache else None
    if table is None:
        rows = list(_rows(dataset, advance))
        if not rows:
            raise DatasetError(f"{dataset.path}: no records to audit; its splits are {list(dataset.splits)}")
        table = pa.Table.from_pylist(rows).replace_schema_metadata({CACHE_KEY: key.encode()})
        if cache:
            cache.parent.mkdir(parents=True, exist_ok=True)
            pq.write_table(table, cache, compression="zstd")
    return _as_set(dataset, table)


def _key(dataset: Dataset) -> str:
    """Return what the measured numbers depend on: identity, definitions, and the bytes of the signals."""
    files = dataset.manifest.get("files", {})
    data = sorted((name, facts["sha256"]) for name, facts in files.items() if name.startswith("data/"))
    text = json.dumps([VERSION, dataset.manifest["identity"], data], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def _cached(cache: Path, key: str) -> pa.Table | None:
    if not cache.is_file():
        return None
    try:
        table = pq.read_table(cache)
    except (OSError, pa.ArrowException):
        return None
    return table if (table.schema.metadata or {}).get(CACHE_KEY) == key.encode() else None


def _rows(dataset: Dataset, advance: Callable[[], None] | None) -> Iterator[dict[str, Any]]:
    columns = [*NEEDED, *(channel.column for channel in dataset.channels), TACHO_NAME]
    check = RecordCheck()
    for split in dataset.splits:
        for batch in dataset.records(split=split, columns=columns, batch_rows=BATCH_ROWS):
            for row in range(batch.num_rows):
                record = _recording(batch, row, dataset)
                if check.usable(record):
                    yield from _record_rows(record, dataset)
                if advance:
                    advance()
    check.finish(dataset)


def _recording(batch: Any, row: int, dataset: Dataset) -> Recording:
    labels = {name: batch.column(name)[row].as_py() for name in NEEDED}
    signals = {channel.name: np.asarray(batch.column(channel.column)[row].values) for channel in dataset.channels}
    tacho_s = np.asarray(batch.column(TACHO_NAME)[row].values, dtype=np.float64)
    return Recording(labels, signals, tacho_s, dataset.fs_hz)


def _record_rows(record: Recording, dataset: Dataset) -> Iterator[dict[str, Any]]:
    record_id, *teeth = (int(record.labels[name]) for name in NEEDED)
    tacho_s = record.tacho_s
    pulses = len(tacho_s)
    grid = None
    if pulses > 2:
        # as many steps as the record has samples in its slowest revolution: no band limit, no waste
        grid = angle_grid(tacho_s, _steps(dataset.fs_hz * float(np.diff(tacho_s).max())))
    for channel in dataset.channels:
        signal = record.channels[channel.name]
        found = (
            channel_quantities(signal, dataset.fs_hz, grid, tacho_s, (teeth[0], teeth[1])) if grid is not None else None
        )
        last = np.flatnonzero(signal != signal[-1])
        yield {
            "record_id": record_id,
            "channel": channel.name,
            "checksum": zlib.crc32(signal.tobytes()),
            "samples": float(last[-1] + 2 if last.size else 0.0),
            "pulses_per_s": (pulses - 1) / float(tacho_s[-1] - tacho_s[0]) if pulses > 1 else math.nan,
            "speed_variation_percent": speed_variation_percent(tacho_s),
            "start_turn": _start_turn(tacho_s),
            **(found.values if found else {}),
            "waveform": _interleaved(found.waveform if found else np.empty(0, np.complex64)),
            "sketch": _interleaved(found.sketch if found else np.empty(0, np.complex64)),
        }


def _steps(samples_per_turn: float) -> int:
    from scipy.fft import next_fast_len

    return int(next_fast_len(math.ceil(samples_per_turn), real=True))


def _start_turn(tacho_s: np.ndarray) -> float:
    """Return the pinion's angle at the first sample, in revolutions after a pulse."""
    if len(tacho_s) < 2:
        return math.nan
    return float((-tacho_s[0] / (tacho_s[1] - tacho_s[0])) % 1.0)


def _interleaved(values: np.ndarray) -> np.ndarray:
    return np.asarray(values.astype(np.complex64).view(np.float32))


def _as_set(dataset: Dataset, table: pa.Table) -> MeasuredSet:
    labels = {name: _array(column) for name, column in _scalar_labels(dataset).items()}
    channels = tuple(channel.name for channel in dataset.channels)
    shape = (-1, len(channels))
    skipped = {"record_id", "channel", "checksum", "waveform", "sketch"}
    values = {
        name: table.column(name).to_numpy(zero_copy_only=False).astype(np.float64).reshape(shape)
        for name in table.column_names
        if name not in skipped
    }
    order = table.column("record_id").to_numpy().reshape(shape)[:, 0]
    if not np.array_equal(order, labels["record_id"]):
        raise DatasetError(f"{dataset.path}: labels and signals are not in the same order; `siggen verify` names why")
    return MeasuredSet(
        labels=labels,
        channels=channels,
        values=values,
        waveforms=_complex_rows(table.column("waveform"), len(channels)),
        sketches=_complex_rows(table.column("sketch"), len(channels)),
        checksums=table.column("checksum").to_numpy().reshape(shape),
        config=dict(dataset.config),
        failures=list(dataset.manifest.get("failures", [])),
    )


def _scalar_labels(dataset: Dataset) -> dict[str, Any]:
    signals = {channel.column for channel in dataset.channels} | {TACHO_NAME}
    names = [field.name for field in dataset.labels().schema if field.name not in signals]
    table = dataset.labels(columns=names)
    return {name: table.column(name) for name in names}


def _array(column: Any) -> np.ndarray:
    if pa.types.is_list(column.type) or pa.types.is_fixed_size_list(column.type):
        rows = column.to_pylist()
        found = np.empty(len(rows), dtype=object)
        found[:] = [tuple(row) if row is not None else () for row in rows]
        return found
    return np.asarray(column.to_pylist())


def _complex_rows(column: Any, channels: int) -> list[list[np.ndarray]]:
    flat = [np.asarray(row.values, dtype=np.float32).view(np.complex64) for row in column]
    return [flat[i : i + channels] for i in range(0, len(flat), channels)]
