"""A set of 100,000 shards, of which only what a reader opens is there: manifest, index, configuration."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pyarrow as pa

import siggen
from benchmarks.row import Row, duration_text
from siggen.columns.versions import SCHEMA_VERSION, SIMULATION_VERSION
from siggen.dataset.folder import config_bytes
from siggen.dataset.manifest import CONFIG, MANIFEST
from siggen.dataset.object_name import CHECKSUMS, INDEX
from siggen.dataset.seal import sealed
from siggen.dataset.shard import FileFacts, write_table
from siggen.dataset.shard_index import CHECKSUM_ROWS, INDEX_ROWS, LISTED, PROMISED
from siggen.dataset.storage import LocalFolder, sha256
from siggen.sets.set_run import manifest_facts

SHARDS, RECORDS, BLOCKS = 100_000, 120, 600
"""RECORDS of a shard, and BLOCKS of 64 KiB: a shard of quickstart has about 40 MB."""

GOAL_S = 2.0


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield what opening and listing cost in seconds of this process."""
    count = SHARDS // 100 if quick else SHARDS
    with TemporaryDirectory() as name:
        folder = LocalFolder(Path(name))
        size = _fabricate(folder, count)
        begin = time.process_time()
        dataset = siggen.open(folder.path)
        opened = time.process_time() - begin
        groups = dataset.row_groups()
        listed = time.process_time() - begin - opened
        begin = time.process_time()
        assert (owner := dataset.index.owner(count * RECORDS // 3)) is not None
        assert dataset.index.promised(owner.file) is not None
        found = time.process_time() - begin
    what = f"{count:,} shards, {size / 1e6:.0f} MB of index:"
    yield Row(f"{what} siggen.open", duration_text(opened), goal=f"<= {GOAL_S:g} s", met=opened <= GOAL_S)
    listing = f"{what} list of {len(groups):,} row groups"
    yield Row(listing, duration_text(listed), goal=f"<= {GOAL_S:g} s", met=listed <= GOAL_S)
    yield Row(f"{what} file and checksums of the first record asked for", duration_text(found))


def _fabricate(folder: LocalFolder, count: int) -> int:
    """Write a set whose shards are missing, and return the bytes of its index."""
    config = siggen.load_config("quickstart", [f"specimens={count * RECORDS // 4}"])
    folder.put(CONFIG, config_bytes(config))
    promised = {CONFIG: {"bytes": folder.size(CONFIG), "sha256": sha256(folder, CONFIG)}}
    tables = _tables(folder, count)
    promised |= {one.name: {k: v for k, v in asdict(one).items() if k not in ("name", "rows")} for one in tables}
    split = {"specimens": config.specimens, "rows": count * RECORDS, "failed": 0, "states": {}, "shards": count}
    environment = {"siggen": "made up"}
    folder.put(MANIFEST, sealed(_manifest(manifest_facts(config, ()), promised, {**split, "bytes": 0}, environment)))
    return tables[0].bytes


def _manifest(facts: Mapping[str, Any], files: Any, split: Any, environment: Any) -> dict[str, Any]:
    return {
        "schema_version": SCHEMA_VERSION,
        "simulation_version": SIMULATION_VERSION,
        **facts,
        "splits": {"train": split},
        "rows": split["rows"],
        "failures": [],
        "environments": [environment],
        "files": files,
    }


def _tables(folder: LocalFolder, count: int) -> list[FileFacts]:
    chance = np.random.default_rng(0)
    listed = pa.RecordBatch.from_pylist([_listed(i) for i in range(count)], schema=LISTED)
    cuts = range(0, count, CHECKSUM_ROWS)
    promised = ([_promised(i, chance) for i in range(cut, min(cut + CHECKSUM_ROWS, count))] for cut in cuts)
    batches = (pa.RecordBatch.from_pylist(rows, schema=PROMISED) for rows in promised)
    return [
        write_table(folder, INDEX, LISTED, [listed], INDEX_ROWS),
        write_table(folder, CHECKSUMS, PROMISED, batches, CHECKSUM_ROWS),
    ]


def _listed(i: int) -> dict[str, Any]:
    return {
        "shard": f"train-{i:05d}",
        "rows": RECORDS,
        "environment": 0,
        "specimens": [i * RECORDS // 4, (i + 1) * RECORDS // 4 - 1],
        "records": [i * RECORDS, (i + 1) * RECORDS - 1],
    }


def _promised(i: int, chance: np.random.Generator) -> dict[str, Any]:
    return {
        "shard": f"train-{i:05d}",
        "data_bytes": BLOCKS * 65536,
        "data_sha256": chance.bytes(32),
        "data_crc32_per_64_kib": chance.bytes(4 * BLOCKS),
        "sidecar_bytes": 6000,
        "sidecar_sha256": chance.bytes(32),
    }
