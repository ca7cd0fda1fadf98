"""One row per shard of a finished set, in two tables, so that a set of 100,000 shards opens at once.

`index.parquet` is read whole when the set is opened. `checksums.parquet` says what the files of the shards must be; of
it 256 rows are read at a time, when one of these files is. The manifest promises both, as it promises every table.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager
from functools import cached_property, partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from siggen.dataset.checked_file import CheckedTable, parquet_file
from siggen.dataset.inventory import LARGEST, Inventory, ListedShard, PromisedFile
from siggen.dataset.object_name import (
    CHECKSUMS,
    DATA_FOLDER,
    INDEX,
    INTERNALS_FOLDER,
    SIDECAR_FOLDER,
    data_name,
    internals_name,
    sidecar_name,
)
from siggen.dataset.shard import FileFacts, write_table
from siggen.dataset.sidecar import Sidecar, read_sidecar
from siggen.dataset.storage import Storage
from siggen.errors import DatasetError, VerificationError, counted

INDEX_ROWS, CHECKSUM_ROWS = 1 << 16, 256
"""Shards of a row group: the index is read at once, checksums with those of a few neighbours."""

READERS = 8
"""Sidecars that are read at once: a store takes its time to answer."""

LISTED = pa.schema(
    [
        pa.field("shard", pa.string(), nullable=False),
        pa.field("rows", pa.int64(), nullable=False),
        pa.field("environment", pa.int32(), nullable=False),
        pa.field("specimens", pa.list_(pa.int64()), nullable=False),
        pa.field("records", pa.list_(pa.int64()), nullable=False),
    ]
)
"""What a set is opened with: `specimens` and `records` are inclusive ranges, first and last id in turn."""

KINDS = ("data", "internals", "sidecar")
FOLDERS = dict(zip((DATA_FOLDER, INTERNALS_FOLDER, SIDECAR_FOLDER), KINDS, strict=True))
PROMISED = pa.schema(
    [
        pa.field("shard", pa.string(), nullable=False),
        *(
            pa.field(f"{kind}_{name}", type_, nullable=kind == "internals")
            for kind in KINDS
            for name, type_ in (("bytes", pa.int64()), ("sha256", pa.binary(32)), ("crc32_per_64_kib", pa.binary()))
            if (kind, name) != ("sidecar", "crc32_per_64_kib")
        ),
    ]
)
"""What is asked for when a file is read; null where a set stores no internals."""

SHARD_NAME = r"^(train|validation|test)-[0-9]{5,12}$"


class IdOwners(NamedTuple):
    """Ranges of ids in the order of their first one, and which shard has each."""

    first: np.ndarray
    last: np.ndarray
    shard: np.ndarray


def write_index(storage: Storage, sidecars: Sequence[Sidecar], environments: Sequence[int]) -> list[FileFacts]:
    """Write index and checksums of shards that are all committed.

    Parameters
    ----------
    storage : Storage
    sidecars : sequence of Sidecar
        By split and number.
    environments : sequence of int
        Number of each one's environment in the manifest.
    """
    listed = [_listing(*row) for row in zip(sidecars, environments, strict=True)]
    cuts = range(0, len(sidecars), CHECKSUM_ROWS)
    index = pa.RecordBatch.from_pylist(listed, schema=LISTED)
    with ThreadPoolExecutor(READERS) as readers:
        groups = ([one.shard for one in sidecars[i : i + CHECKSUM_ROWS]] for i in cuts)
        promised = (list(readers.map(partial(_promises, storage), group)) for group in groups)
        checksums = (pa.RecordBatch.from_pylist(rows, schema=PROMISED) for rows in promised)
        return [
            write_table(storage, INDEX, LISTED, [index], INDEX_ROWS),
            write_table(storage, CHECKSUMS, PROMISED, checksums, CHECKSUM_ROWS),
        ]


def _listing(sidecar: Sidecar, environment: int) -> dict[str, Any]:
    return {
        "shard": sidecar.shard,
        "rows": sidecar.data.rows,
        "environment": environment,
        "specimens": [i for pair in sidecar.specimens for i in pair],
        "records": [i for pair in sidecar.records for i in pair],
    }


def _promises(storage: Storage, shard: str) -> dict[str, Any]:
    # read again, since a run does not keep the checksums of all shards
    sidecar = read_sidecar(storage, shard)
    content = storage.get(sidecar.name)
    return {
        "shard": shard,
        "sidecar_bytes": len(content),
        "sidecar_sha256": hashlib.sha256(content).digest(),
        **_promising("data", sidecar.data),
        **({} if sidecar.internals is None else _promising("internals", sidecar.internals)),
    }


def _promising(kind: str, facts: FileFacts) -> dict[str, Any]:
    digest, crc = bytes.fromhex(facts.sha256), bytes.fromhex(facts.crc32_per_64_kib)
    return {f"{kind}_bytes": facts.bytes, f"{kind}_sha256": digest, f"{kind}_crc32_per_64_kib": crc}


class ShardIndex:
    """The shards of a finished set.

    Parameters
    ----------
    storage : Storage
    inventory : Inventory
        What its manifest says.

    Raises
    ------
    DatasetError
        If the index is missing, damaged, or contradicts the manifest.
    """

    def __init__(self, storage: Storage, inventory: Inventory) -> None:
        self._storage, self._checksums = storage, inventory.files[CHECKSUMS]
        self._has_internals = bool(inventory.internals)
        with _table(storage, INDEX, inventory.files[INDEX]) as file:
            if not file.schema.equals(LISTED):
                raise self._broken(INDEX, f"columns: received {', '.join(file.schema.names)[:200]}")
            self._listed = file.read().combine_chunks()
        try:
            _check(self._listed, inventory)
        except VerificationError as error:
            raise self._broken(INDEX, str(error)) from error
        self._promises: tuple[int, pa.Table] = (-1, PROMISED.empty_table())
        self._footer: pq.FileMetaData | None = None

    def __len__(self) -> int:
        return int(self._listed.num_rows)

    def shards(self, split: str | None = None) -> Iterator[ListedShard]:
        """Yield the shards of a split, or of all splits, in the order of the labels."""
        for batch in self._listed.to_batches(max_chunksize=CHECKSUM_ROWS):
            for row in batch.to_pylist():
                if split is None or row["shard"].startswith(f"{split}-"):
                    yield self._shard(row)

    def rows_of_files(self, split: str) -> Iterator[tuple[str, int]]:
        """Yield the file and the rows of every shard of a split."""
        chosen = self._listed.filter(pc.starts_with(self._listed["shard"], f"{split}-"))
        for shard, rows in zip(chosen["shard"].to_pylist(), chosen["rows"].to_pylist(), strict=True):
            yield data_name(shard), rows

    def owner(self, record_id: int) -> ListedShard | None:
        """Return the shard that the plan gives a record to, whether it failed or not; None if there is none."""
        place = int(np.searchsorted(self.records.first, record_id, side="right")) - 1
        if place < 0 or self.records.last[place] < record_id:
            return None
        return self._shard(self._listed.slice(int(self.records.shard[place]), 1).to_pylist()[0])

    @cached_property
    def records(self) -> IdOwners:
        """Planned ids of all records."""
        column = self._listed["records"].combine_chunks()
        ids = np.asarray(column.flatten(), dtype=np.int64)
        owners = np.repeat(np.arange(len(self)), np.diff(np.asarray(column.offsets)) // 2)
        order = np.argsort(ids[0::2], kind="stable")
        return IdOwners(ids[0::2][order], ids[1::2][order], owners[order])

    def promised(self, name: str) -> PromisedFile | None:
        """Return what is promised of a file of a shard; None for any other name.

        Raises
        ------
        DatasetError
            If the checksums are missing, damaged, or not those of the shards.
        """
        folder, _, file = name.partition("/")
        shard, kind = file.rpartition(".")[0], FOLDERS.get(folder)
        if kind is None or shard not in self._numbers or name != _name(kind, shard):
            return None
        row = self._promises_of(self._numbers[shard])
        if row["shard"] != shard:
            raise self._broken(CHECKSUMS, f"received {str(row['shard'])[:40]!r} where {shard} is expected")
        return _promise(row, kind)

    @cached_property
    def _numbers(self) -> dict[str, int]:
        return {shard: i for i, shard in enumerate(self._listed["shard"].to_pylist())}

    def _promises_of(self, number: int) -> dict[str, Any]:
        group = number // CHECKSUM_ROWS
        if self._promises[0] != group:
            with _table(self._storage, CHECKSUMS, self._checksums, self._footer) as file:
                if not file.schema.equals(PROMISED) or file.footer.num_rows != len(self):
                    raise self._broken(CHECKSUMS, f"allowed: a row for each of {counted(len(self), 'shard')}")
                self._promises, self._footer = (group, file.group(group)), file.footer
        found = self._promises[1].slice(number % CHECKSUM_ROWS, 1).to_pylist()
        return found[0] if found else {"shard": None}

    def _shard(self, row: dict[str, Any]) -> ListedShard:
        shard = row["shard"]
        return ListedShard(
            shard=shard,
            split=shard.rpartition("-")[0],
            file=data_name(shard),
            rows=row["rows"],
            specimens=tuple(pairwise(row["specimens"]))[::2],
            records=tuple(pairwise(row["records"]))[::2],
            environment=row["environment"],
            internals=internals_name(shard) if self._has_internals else None,
        )

    def _broken(self, name: str, why: str) -> DatasetError:
        where = self._storage.location
        return DatasetError(
            f"{where}/{name}: {why}; delete it and manifest.json, and `siggen generate` with the set's config.yaml "
            "makes them again"
        )


def promised_files(storage: Storage, promised: PromisedFile) -> Iterator[tuple[str, PromisedFile]]:
    """Yield every file of every shard and what is promised of it, without checksums of blocks.

    Parameters
    ----------
    storage : Storage
    promised : PromisedFile
        What the manifest promises of `checksums.parquet`, whatever version wrote it.

    Raises
    ------
    DatasetError
        If that table is missing, damaged, or of other columns.
    """
    wanted = [name for name in PROMISED.names if not name.endswith("kib")]
    with _table(storage, CHECKSUMS, promised) as file:
        if missing := sorted(set(wanted) - set(file.schema.names)):
            raise DatasetError(f"{storage.location}/{CHECKSUMS} has no columns {', '.join(missing)}")
        for group in file.groups(wanted):
            for row in group.to_pylist():
                for kind in KINDS:
                    if (promise := _promise(row, kind)) is not None:
                        yield _name(kind, row["shard"]), promise


def _table(
    storage: Storage, name: str, promised: PromisedFile, footer: pq.FileMetaData | None = None
) -> AbstractContextManager[CheckedTable]:
    return parquet_file(storage, name, promised.crc32_per_64_kib or "", promised.bytes, footer)


def _promise(row: dict[str, Any], kind: str) -> PromisedFile | None:
    """Return what a row promises of one of a shard's files; None for internals that are not stored."""
    size, digest, crc = (row.get(f"{kind}_{name}") for name in ("bytes", "sha256", "crc32_per_64_kib"))
    if size is None or digest is None:
        return None
    return PromisedFile(bytes=size, sha256=digest.hex(), crc32_per_64_kib=None if crc is None else crc.hex())


def _name(kind: str, shard: str) -> str:
    return {"data": data_name, "internals": internals_name, "sidecar": sidecar_name}[kind](shard)


def _check(listed: pa.Table, inventory: Inventory) -> None:
    """Refuse an index that no set can have: the gate of what `inventory` takes for granted.

    Raises
    ------
    VerificationError
        With the first contradiction.
    """
    for problem in _contradictions(listed, inventory):
        raise VerificationError(problem)


def _contradictions(listed: pa.Table, inventory: Inventory) -> Iterator[str]:
    names, rows = listed["shard"], listed["rows"].to_numpy()
    if not listed.num_rows or any(listed[name].null_count for name in LISTED.names):
        yield "received no shard, or one without name, rows or ranges; allowed: at least one, whole"
        return
    if not pc.all(pc.match_substring_regex(names, SHARD_NAME)).as_py():
        yield "shard: allowed: a split and at least five digits, such as train-00000"
    if pc.count_distinct(names).as_py() != len(names):
        yield "shard: received one twice; allowed: every shard once"
    environments = listed["environment"].to_numpy()
    if environments.min() < 0 or environments.max() >= len(inventory.environments):
        yield f"environment: received {environments.max()}; allowed: below {len(inventory.environments)}"
    if rows.min() < 0:
        yield f"rows: received {rows.min()}; allowed: 0 and more"
    for name in ("specimens", "records"):
        yield from _unordered(name, listed[name].combine_chunks())
    splits = np.array([shard.rpartition("-")[0] for shard in names.to_pylist()])
    for split in sorted({*inventory.splits, *np.unique(splits)}):
        counted, found = inventory.splits.get(split), int(rows[splits == split].sum())
        if counted is None or counted.rows != found:
            yield f"rows of {split}: received {found}; allowed: those of the manifest"


def _unordered(name: str, ranges: pa.ListArray) -> Iterator[str]:
    """Yield whether ids of a shard are no ascending ranges; an id may be first and last of its range."""
    ids, offsets = np.asarray(ranges.flatten(), dtype=np.int64), np.asarray(ranges.offsets)
    if (np.diff(offsets) % 2).any() or (ids.size and (ids.min() < 0 or ids.max() > LARGEST)):
        yield f"{name}: allowed: first and last id of each range, from 0 to {LARGEST}"
        return
    begins = np.zeros(ids.size + 1, dtype=bool)
    begins[offsets] = True
    # from the last id of a range to the first of the next one they rise, unless another shard begins there
    if (ids[1::2] < ids[0::2]).any() or ((np.diff(ids)[1::2] <= 0) & ~begins[2:-1:2]).any():
        yield f"{name}: allowed: ascending ranges of ids, first and last one of each"
