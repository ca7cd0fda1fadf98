"""Signals written and read: siggen's Parquet files beside those of pyarrow's defaults, with their sizes."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from benchmarks.row import Row
from benchmarks.shipped import QUICKSTART, shipped
from benchmarks.timing import Candidate, medians
from siggen.columns.record import Record, channels, record_batch, signal_matrix
from siggen.config import Config
from siggen.dataset.checked_file import checksums, parquet_file
from siggen.dataset.shard import write_table
from siggen.dataset.storage import LocalFolder
from siggen.planning.plan import record_ids_of, rows_per_group
from siggen.record.simulation import simulate_specimen

OWN, DEFAULT = "own.parquet", "default.parquet"


@dataclass(frozen=True, slots=True)
class _Files:
    """The same rows as two files in a folder."""

    config: Config
    table: pa.Table
    folder: Path

    def write_own(self, _number: int) -> None:
        """Write as `siggen generate` does: encoded, compressed, hashed, checked, flushed to the disk."""
        batches = self.table.to_batches()
        write_table(LocalFolder(self.folder), OWN, self.table.schema, batches, rows_per_group(self.config))

    def write_default(self, _number: int) -> None:
        """Write with pyarrow's defaults, flushed to the disk."""
        pq.write_table(self.table, self.folder / DEFAULT)
        with (self.folder / DEFAULT).open("rb") as file:
            os.fsync(file.fileno())

    def read(self, name: str) -> None:
        """Read all signals group by group, unchecked."""
        with pq.ParquetFile(self.folder / name) as file:
            self._read_groups(file)

    def read_checked(self, crc32_per_64_kib: str) -> None:
        """Read siggen's file with every byte checked, as `siggen.open(...).records()` does."""
        with parquet_file(LocalFolder(self.folder), OWN, crc32_per_64_kib) as file:
            self._read_groups(file.parquet)

    def _read_groups(self, file: pq.ParquetFile) -> None:
        for group in range(file.num_row_groups):
            table = file.read_row_group(group, use_threads=False)
            for channel in channels(self.config):
                signal_matrix(table[channel.column])


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield signals per second written and read (wall time, files in the cache), and bytes per signal."""
    config = shipped(QUICKSTART)
    table = _simulated(config, specimens=1 if quick else 4)
    signals = table.num_rows * len(channels(config))
    with tempfile.TemporaryDirectory() as folder:
        files = _Files(config, table, Path(folder))
        written = {"own": Candidate(files.write_own), "default": Candidate(files.write_default)}
        written_s = medians(written, 3 if quick else 9, time.perf_counter)
        read = {"own": Candidate(lambda _: files.read(OWN)), "default": Candidate(lambda _: files.read(DEFAULT))}
        with (Path(folder) / OWN).open("rb") as file:
            crc32 = checksums(file).crc32_per_64_kib
        read["checked"] = Candidate(lambda _: files.read_checked(crc32))
        read_s = medians(read, 3 if quick else 9, time.perf_counter)
        sizes = {name: (Path(folder) / name).stat().st_size / signals for name in (OWN, DEFAULT)}
    what = f"{signals} signals of {config.duration_s:g} s"
    yield _speed_row(f"{what} written", signals, written_s)
    yield _speed_row(f"{what} read unchecked", signals, read_s)
    checked, unchecked = signals / read_s["checked"], signals / read_s["own"]
    read_text = f"{checked:.0f} signals/s", f"unchecked: {unchecked:.0f} signals/s"
    yield Row(f"{what} read with every byte checked", *read_text, checked / unchecked)
    own, default = sizes[OWN] / 1e3, sizes[DEFAULT] / 1e3
    yield Row("size per signal", f"{own:.1f} kB", f"pyarrow defaults: {default:.1f} kB", default / own)
    yield Row(
        "size per signal",
        f"{own:.1f} kB",
        f"float32, no file: {config.samples * 4e-3:.1f} kB",
        config.samples * 4e-3 / own,
    )


def _simulated(config: Config, specimens: int) -> pa.Table:
    batches = []
    for specimen in range(specimens):
        results = list(simulate_specimen(config, record_ids_of(config, specimen)))
        batches.append(record_batch(config, [result for result in results if isinstance(result, Record)]))
    return pa.Table.from_batches(batches)


def _speed_row(what: str, signals: int, cost_s: dict[str, float]) -> Row:
    own, default = signals / cost_s["own"], signals / cost_s["default"]
    return Row(what, f"{own:.0f} signals/s", f"pyarrow defaults: {default:.0f} signals/s", own / default)
