"""What is made of a shard before the shard is: results of chunks, kept in small files by the workers that made them.

A piece is `pieces/<shard>/<first record>`, a file of `sealed_streams`. Whoever closes the shard takes over what is
whole and of its own making, and deletes the pieces once the shard is committed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import pyarrow as pa

from siggen.columns.internals import internals_schema
from siggen.columns.record import RecordFailure, SetColumns, record_schema
from siggen.dataset.chunk import Chunk, ChunkResult
from siggen.dataset.sealed_streams import UNUSABLE, Maker, read_head, read_streams, sealed_streams
from siggen.dataset.storage import Storage

FOLDER = "pieces"


@dataclass(frozen=True, slots=True)
class Pieces:
    """The pieces of a set that is being made."""

    storage: Storage
    maker: Maker
    columns: SetColumns

    @property
    def schemas(self) -> tuple[pa.Schema, pa.Schema | None]:
        """Of rows and of internal quantities; worked out anew, since pyarrow's do not survive the way to a worker."""
        return record_schema(self.columns), internals_schema(self.columns) if self.columns.quantities else None

    def put(self, results: Sequence[ChunkResult]) -> None:
        """Keep results of one shard, which follow each other."""
        self.storage.put(piece_name(results[0].chunk), _packed(self.maker, results))

    def find(self, shards: Sequence[str]) -> dict[str, tuple[Chunk, ...]]:
        """Return what earlier runs kept of shards, judged by the heads of pieces; what is of no use is deleted."""
        found: dict[str, tuple[Chunk, ...]] = {}
        wanted = set(shards)
        for name in self.storage.names(FOLDER):
            shard = name.split("/")[1]
            held = self._chunks(name) if shard in wanted else ()
            if held and all(chunk.shard == shard for chunk in held) and piece_name(held[0]) == name:
                found[shard] = (*found.get(shard, ()), *held)
            else:
                self.storage.delete(name)
        return found

    def of_shard(self, shard: str) -> ShardPieces:
        """Return the pieces that are there of a shard."""
        return ShardPieces(self, shard, frozenset(self.storage.names(f"{FOLDER}/{shard}")))

    def read(self, name: str) -> tuple[ChunkResult, ...]:
        """Return what a piece holds; nothing if it is gone or not whole, or of another maker."""
        try:
            held = tuple(_parts(*read_streams(self.storage, name, self.maker)))
            schemas = self.schemas
            return held if all(_is_sound(one, schemas) for one in held) else ()
        except UNUSABLE:
            return ()

    def clear(self) -> None:
        """Delete all pieces, also of shards that are no part of this run."""
        self.storage.delete_below(FOLDER)

    def _chunks(self, name: str) -> tuple[Chunk, ...]:
        try:
            facts = read_head(self.storage, name, self.maker)
            return tuple(_chunk(facts, part) for part in facts["parts"])
        except UNUSABLE:
            return ()


@dataclass(slots=True)
class ShardPieces:
    """The pieces of a shard, read one after the other, so that one at a time is in memory."""

    pieces: Pieces
    shard: str
    names: frozenset[str]
    _read: tuple[str, Mapping[int, ChunkResult]] = ("", {})

    def result(self, chunk: Chunk) -> ChunkResult | None:
        """Return the result that begins with a chunk and holds no more; None if no piece has it."""
        found = self._read[1].get(chunk.records.start)
        name = piece_name(chunk)
        if found is None and name in self.names and name != self._read[0]:
            self._read = (name, {one.chunk.records.start: one for one in self.pieces.read(name)})
            found = self._read[1].get(chunk.records.start)
        is_of_it = found is not None and found.chunk.shard == self.shard
        return found if found is not None and is_of_it and found.chunk.records.stop <= chunk.records.stop else None

    def drop(self) -> None:
        """Delete the pieces."""
        if self.names:
            self.pieces.storage.delete_below(f"{FOLDER}/{self.shard}")


def piece_name(first: Chunk) -> str:
    """Return the name of the piece that begins with a chunk."""
    return f"{FOLDER}/{first.shard}/{first.records.start:012d}"


def _packed(maker: Maker, results: Sequence[ChunkResult]) -> bytes:
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
    return sealed_streams(maker, {"shard": results[0].chunk.shard, "parts": parts}, streams)


def _chunk(facts: Mapping[str, Any], part: Mapping[str, Any]) -> Chunk:
    first, stop = part["records"]
    if not 0 <= first < stop:
        raise ValueError("no records")
    return Chunk(str(facts["shard"]), range(first, stop))


def _parts(facts: Mapping[str, Any], streams: bytes) -> Iterator[ChunkResult]:
    start = 0
    for part in facts["parts"]:
        middle = start + part["rows"]
        end = middle + (part["internals"] or 0)
        internals = None if part["internals"] is None else streams[middle:end]
        failures = tuple(RecordFailure(**failure) for failure in part["failures"])
        yield ChunkResult(_chunk(facts, part), streams[start:middle], failures, internals)
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
