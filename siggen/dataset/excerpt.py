"""What the small tables of a set need of one shard: its labels, its rows of damage and of lives.

Whoever makes a shard puts its excerpt beside it, `excerpts/<shard>`, a file of `sealed_streams`. The tables are written
from excerpts alone, so that who writes them simulates nothing and reads no shard.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import groupby
from operator import itemgetter

import pyarrow as pa

from siggen.columns.life import LIFE_TABLES, NULLABLE
from siggen.columns.record import SetColumns, damage_schema, label_schema, schema_metadata
from siggen.dataset.checked_file import parquet_file
from siggen.dataset.chunk import packed_batch, unpacked_batch
from siggen.dataset.manifest import DAMAGE_FOLDER, LIFE_FOLDER, METADATA_FOLDER
from siggen.dataset.sealed_streams import UNUSABLE, Maker, read_streams, sealed_streams
from siggen.dataset.sidecar import Sidecar, read_sidecar
from siggen.dataset.storage import Storage

FOLDER = "excerpts"
READERS = 8

DamageRows = Callable[[Sequence[int]], Iterable[Mapping[str, object]]]
"""Ids of one specimen's records -> rows of the damage table, as siggen.record gives them."""

LifeRows = Callable[[int], Mapping[str, Sequence[Mapping[str, object]]]]
"""specimen -> rows by the name of their table, as siggen.record gives them."""

Excerpt = Mapping[str, pa.RecordBatch]
"""Folder of the table -> rows of a shard; see `excerpt_schemas`."""


def excerpt_name(shard: str) -> str:
    """Return the object name of a shard's excerpt."""
    return f"{FOLDER}/{shard}"


def excerpt_schemas(columns: SetColumns) -> dict[str, pa.Schema]:
    """Return folder -> schema of the tables that a set has for every split; those of `life/` only if it has lives."""
    return {
        METADATA_FOLDER: label_schema(columns),
        DAMAGE_FOLDER: damage_schema(columns),
        **{f"{LIFE_FOLDER}/{name}": life_schema(columns, name) for name in (LIFE_TABLES if columns.lives else ())},
    }


def life_schema(columns: SetColumns, table: str) -> pa.Schema:
    """Return the schema of a table of `life/`."""
    fields = [column.field().with_nullable(column.name in NULLABLE) for column in LIFE_TABLES[table]]
    return pa.schema(fields, metadata=schema_metadata(columns))


@dataclass(frozen=True, slots=True)
class Excerpts:
    """The excerpts of a set that is being made.

    Attributes
    ----------
    damage_rows, life_rows
        What makes the rows that stand in no shard: pure, and importable by name.
    """

    columns: SetColumns
    storage: Storage
    maker: Maker
    damage_rows: DamageRows
    life_rows: LifeRows

    def put(self, shard: str) -> None:
        """Make the excerpt of a committed shard, and keep it."""
        sidecar = read_sidecar(self.storage, shard)
        self.storage.put(excerpt_name(shard), self._packed(sidecar, self._made(sidecar)))

    def read(self, shard: str) -> Excerpt:
        """Return the excerpt of a committed shard: the one that was kept, or if it is of no use a new one."""
        sidecar = read_sidecar(self.storage, shard)
        return self._kept(sidecar) or self._made(sidecar)

    def in_order(self, shards: Sequence[str]) -> Iterator[Excerpt]:
        """Yield the excerpts of shards, a few of which are read at once: a store takes its time to answer."""
        with ThreadPoolExecutor(READERS) as readers:
            for start in range(0, len(shards), READERS):
                yield from readers.map(self.read, shards[start : start + READERS])

    def missing(self, shards: Iterable[str]) -> list[str]:
        """Return the shards without an excerpt."""
        there = set(self.storage.names(FOLDER))
        return [shard for shard in shards if excerpt_name(shard) not in there]

    def clear(self) -> None:
        """Delete all excerpts."""
        self.storage.delete_below(FOLDER)

    def _made(self, sidecar: Sidecar) -> Excerpt:
        schemas = excerpt_schemas(self.columns)
        facts = sidecar.data
        with parquet_file(self.storage, facts.name, facts.crc32_per_64_kib, facts.bytes) as file:
            labels = file.read(schemas[METADATA_FOLDER].names)
        specimens = [i for first, last in sidecar.specimens for i in range(first, last + 1)]
        owners = zip(labels["specimen_id"].to_pylist(), labels["record_id"].to_pylist(), strict=True)
        records = ([record for _, record in own] for _, own in groupby(owners, key=itemgetter(0)))
        damage = [row for of_specimen in records for row in self.damage_rows(of_specimen)]
        rows = {DAMAGE_FOLDER: damage, **self._lives(sidecar.split, specimens)}
        made = {name: pa.RecordBatch.from_pylist(rows[name], schema=schemas[name]) for name in rows}
        return {METADATA_FOLDER: _one_batch(labels, schemas[METADATA_FOLDER]), **made}

    def _lives(self, split: str, specimens: Sequence[int]) -> dict[str, list[dict[str, object]]]:
        if not self.columns.lives:
            return {}
        rows: dict[str, list[dict[str, object]]] = {f"{LIFE_FOLDER}/{name}": [] for name in LIFE_TABLES}
        for specimen in specimens:
            for name, found in self.life_rows(specimen).items():
                rows[f"{LIFE_FOLDER}/{name}"] += [{**row, "split": split} for row in found]
        return rows

    def _packed(self, sidecar: Sidecar, excerpt: Excerpt) -> bytes:
        streams = {name: packed_batch(excerpt[name]) for name in sorted(excerpt)}
        about = {**_about(sidecar), "tables": {name: len(stream) for name, stream in streams.items()}}
        return sealed_streams(self.maker, about, b"".join(streams.values()))

    def _kept(self, sidecar: Sidecar) -> Excerpt | None:
        try:
            facts, streams = read_streams(self.storage, excerpt_name(sidecar.shard), self.maker)
            if any(facts[key] != value for key, value in _about(sidecar).items()):
                return None
            found = dict(_batches(facts["tables"], streams))
        except UNUSABLE:
            return None
        schemas = excerpt_schemas(self.columns)
        is_sound = set(found) == set(schemas) and all(found[name].schema.equals(schemas[name]) for name in schemas)
        return found if is_sound and found[METADATA_FOLDER].num_rows == sidecar.data.rows else None


def _about(sidecar: Sidecar) -> dict[str, object]:
    return {"shard": sidecar.shard, "data_sha256": sidecar.data.sha256}


def _batches(lengths: Mapping[str, int], streams: bytes) -> Iterator[tuple[str, pa.RecordBatch]]:
    start = 0
    for name in sorted(lengths):
        yield name, unpacked_batch(streams[start : start + lengths[name]])
        start += lengths[name]


def _one_batch(table: pa.Table, schema: pa.Schema) -> pa.RecordBatch:
    whole = table.cast(schema).combine_chunks()
    return whole.to_batches()[0] if whole.num_rows else pa.RecordBatch.from_pylist([], schema=schema)
