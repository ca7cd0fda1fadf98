"""What is made of a shard before the shard is: results of chunks, kept in small files so that little can be lost.

A piece is `pieces/<shard>/<first record>`: sealed JSON, a NUL, then Arrow streams one behind the other. It says for
which set, by which code and in which environment it was made, and carries the hash of its streams. A run takes over
what fits in all of this and deletes the rest. Pieces end with the commit of their shard; a finished set has none.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Collection, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import pyarrow as pa

from siggen.columns.record import RecordFailure
from siggen.columns.versions import SCHEMA_VERSION, SIMULATION_VERSION
from siggen.dataset.chunk import Chunk, ChunkResult
from siggen.dataset.seal import sealed, unsealed
from siggen.dataset.storage import Storage
from siggen.errors import DatasetError, VerificationError

FOLDER = "pieces"
KEEP_S = 10.0
"""How long results wait for others: one request per so many seconds, and no file at all for a shard that takes less."""

KEEP_BYTES = 64 << 20
END_OF_HEAD = b"\0"


@dataclass(frozen=True, slots=True)
class Maker:
    """What makes the bytes of a row; pieces of another maker are of no use."""

    identity: str
    fingerprint: str
    environment: Mapping[str, str]

    def facts(self) -> dict[str, object]:
        """Return them with the versions of the files, as a piece carries them."""
        versions = {"schema_version": SCHEMA_VERSION, "simulation_version": SIMULATION_VERSION}
        return {**versions, **asdict(self), "environment": dict(self.environment)}


@dataclass(slots=True)
class Pieces:
    """The pieces of a set that is being made; used by the one process that writes the set.

    Attributes
    ----------
    schemas
        Of rows and of internal quantities, None without them.
    found
        Shard -> chunks that earlier runs left, with the pieces that hold them.
    """

    storage: Storage
    maker: Maker
    schemas: tuple[pa.Schema, pa.Schema | None]
    found: dict[str, dict[Chunk, str]] = field(default_factory=dict)
    _written: dict[str, set[str]] = field(default_factory=dict)
    _waiting: dict[str, list[ChunkResult]] = field(default_factory=dict)
    _records: dict[str, int] = field(default_factory=dict)
    _kept_s: float = field(default_factory=time.monotonic)
    _last: tuple[str, dict[Chunk, ChunkResult]] = ("", {})

    def find(self, shards: Collection[str]) -> None:
        """Look for what earlier runs left of these shards; what is of no use is deleted."""
        for name in self.storage.sizes(FOLDER):
            shard = name.split("/")[1]
            held = _usable(self.storage, name, self.maker, self.schemas) if shard in shards else None
            if not held or any(chunk.shard != shard for chunk in held):
                self.storage.delete(name)
                continue
            self.found.setdefault(shard, {}).update(dict.fromkeys(held, name))
            self._written.setdefault(shard, set()).add(name)
            self._count(held)

    def read(self, chunk: Chunk) -> ChunkResult:
        """Return a chunk that was found."""
        name = self.found[chunk.shard][chunk]
        if self._last[0] != name:
            held = _usable(self.storage, name, self.maker, self.schemas)
            if held is None:
                raise DatasetError(f"{self.storage.location}/{name} was changed just now; the same command goes on")
            self._last = (name, held)
        return self._last[1][chunk]

    def add(self, result: ChunkResult) -> None:
        """Take a result, which is on disk `KEEP_S` later at most if another comes."""
        self._waiting.setdefault(result.chunk.shard, []).append(result)
        self._count([result.chunk])
        size = sum(len(one.rows) + len(one.internals or b"") for shard in self._waiting.values() for one in shard)
        if time.monotonic() - self._kept_s >= KEEP_S or size >= KEEP_BYTES:
            self.keep()

    def keep(self) -> None:
        """Write what waits."""
        for shard, results in list(self._waiting.items()):
            name = f"{FOLDER}/{shard}/{results[0].chunk.records.start:012d}"
            self.storage.put(name, _packed(self.maker, results))
            self._written.setdefault(shard, set()).add(name)
            del self._waiting[shard]
        self._kept_s = time.monotonic()

    def records(self) -> int:
        """Return the number of records of unfinished shards that are kept or wait for it."""
        return sum(self._records.values())

    def drop(self, shard: str) -> None:
        """Delete the pieces of a shard that is committed."""
        self._waiting.pop(shard, None)
        self.found.pop(shard, None)
        self._records.pop(shard, None)
        self._last = ("", {})
        for name in sorted(self._written.pop(shard, ())):
            self.storage.delete(name)

    def clear(self) -> None:
        """Delete all pieces, also of shards that are no part of this run."""
        for name in self.storage.sizes(FOLDER):
            self.storage.delete(name)

    def _count(self, held: Collection[Chunk]) -> None:
        for chunk in held:
            self._records[chunk.shard] = self._records.get(chunk.shard, 0) + len(chunk.records)


def _packed(maker: Maker, results: list[ChunkResult]) -> bytes:
    streams = b"".join(one.rows + (one.internals or b"") for one in results)
    parts = [
        {
            "records": [one.chunk.records.start, one.chunk.records.stop],
            "rows": len(one.rows),
            "internals": None if one.internals is None else len(one.internals),
            "failures": [asdict(failure) for failure in one.failures],
        }
        for one in results
    ]
    sha256 = hashlib.sha256(streams).hexdigest()
    head = {**maker.facts(), "shard": results[0].chunk.shard, "sha256": sha256, "parts": parts}
    return sealed(head) + END_OF_HEAD + streams


def _usable(
    storage: Storage, name: str, maker: Maker, schemas: tuple[pa.Schema, pa.Schema | None]
) -> dict[Chunk, ChunkResult] | None:
    """Return what a piece holds; None if it is not whole, or of another maker."""
    head, _, streams = storage.get(name).partition(END_OF_HEAD)
    try:
        facts = unsealed(name, head)
        if any(facts.get(key) != value for key, value in maker.facts().items()):
            return None
        if hashlib.sha256(streams).hexdigest() != facts["sha256"]:
            return None
        held = {one.chunk: one for one in _parts(facts, streams)}
        return held if all(_is_sound(one, schemas) for one in held.values()) else None
    except (VerificationError, LookupError, TypeError, ValueError, pa.ArrowException):  # from whoever wrote it
        return None


def _parts(facts: Mapping[str, Any], streams: bytes) -> Iterator[ChunkResult]:
    start = 0
    for part in facts["parts"]:
        chunk = Chunk(str(facts["shard"]), range(*part["records"]))
        middle = start + part["rows"]
        end = middle + (part["internals"] or 0)
        internals = None if part["internals"] is None else streams[middle:end]
        failures = tuple(RecordFailure(**failure) for failure in part["failures"])
        yield ChunkResult(chunk, streams[start:middle], failures, internals)
        start = end


def _is_sound(result: ChunkResult, schemas: tuple[pa.Schema, pa.Schema | None]) -> bool:
    """Tell whether a result has the rows that it says, in the columns of the set."""
    for batch, schema in zip((result.batch(), result.internals_batch()), schemas, strict=True):
        if (batch is None) != (schema is None):
            return False
        if batch is not None:
            batch.validate(full=True)
            if not batch.schema.equals(schema):
                return False
    rows = result.batch().column("record_id").to_pylist()
    inner = result.internals_batch()
    has_inner = [] if inner is None else inner.column("record_id").to_pylist()
    made = sorted([*rows, *(failure.record_id for failure in result.failures)])
    return made == list(result.chunk.records) and set(has_inner) <= set(rows)
