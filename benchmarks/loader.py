"""Shuffled windows of a loader, a scan and random records beside plain decoding of the same files by pyarrow."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

import siggen
from benchmarks.row import Row
from benchmarks.shipped import QUICKSTART
from benchmarks.timing import Candidate, medians
from diagnostics.loader.window_index import StreamSettings
from diagnostics.loader.window_stream import WindowLoader, WindowStream
from siggen.columns.record import signal_matrix
from siggen.dataset.reading import Split

GOAL = 0.8
HALF_A_RECORD = StreamSettings(revolutions=8, hop_revolutions=8, samples_per_revolution=None)
ORDERS = StreamSettings()


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield records per second of CPU time (one process, files in the cache) of both, as a ratio of one run."""
    with tempfile.TemporaryDirectory() as folder:
        config = siggen.load_config(QUICKSTART, overrides=[f"specimens={5 if quick else 20}"])
        siggen.generate(config, Path(folder) / "set")
        dataset = siggen.open(Path(folder) / "set")
        count = dataset.labels("train", ["record_id"]).num_rows
        streams = {
            "shuffled": WindowStream(dataset, "train", HALF_A_RECORD),
            "orders": WindowStream(dataset, "train", ORDERS),
            "cached": WindowStream(dataset, "train", ORDERS, cache=Path(folder) / "cache"),
        }
        candidates = {name: Candidate(lambda _, s=stream: _drained(s)) for name, stream in streams.items()}
        sequential = Candidate(lambda _: _decoded(dataset))
        candidates["scan"] = Candidate(lambda _: list(siggen.open(dataset.path).records("train", columns)))
        candidates["random"] = Candidate(lambda _: _drawn(siggen.open(dataset.path)["train"]))
        columns = [channel.column for channel in dataset.channels]
        megabytes = 4e-6 * len(dataset.channels) * round(dataset.fs_hz * dataset.duration_s)
        _drained(streams["cached"])  # which fills the cache
        cost_s = medians({"sequential": sequential, **candidates}, 3 if quick else 9, time.process_time)
    speed = {name: count / cost for name, cost in cost_s.items()}
    decoding = f"pyarrow, sequential: {speed['sequential']:.0f} records/s"
    for name, what in (
        ("shuffled", "records in shuffled windows"),
        ("orders", "the same, resampled to equal angles"),
        ("cached", "the same, from the cache"),
    ):
        ratio = speed[name] / speed["sequential"]
        goal = (f">= {GOAL:g}", ratio >= GOAL) if name == "shuffled" else ("", None)
        yield Row(what, f"{speed[name]:.0f} records/s", decoding, ratio, *goal)
    for name, what, least in (
        ("scan", "signals of all records in order", 300.0),
        ("random", "records in random order", 100.0),
    ):
        found = megabytes * speed[name]
        measured = f"{found:.0f} MB of signals per CPU s"
        yield Row(f"{what}, opened anew", measured, decoding, None, f">= {least:.0f}", found >= least)


def _drawn(split: Split) -> None:
    for number in np.random.default_rng(0).permutation(len(split)):
        split[int(number)]


def _drained(stream: WindowStream) -> None:
    for _ in WindowLoader(stream):
        pass


def _decoded(dataset: siggen.Dataset) -> None:
    """Decode all signal columns of the training split, row group by row group, with pyarrow alone."""
    columns = [channel.column for channel in dataset.channels]
    for path in sorted((dataset.path / "data").glob("train-*.parquet")):
        with pq.ParquetFile(path) as file:
            for group in range(file.num_row_groups):
                table = file.read_row_group(group, columns=columns, use_threads=False)
                for name in columns:
                    signal_matrix(table[name])
