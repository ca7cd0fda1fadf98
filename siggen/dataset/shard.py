"""A table of a set as bytes: Parquet in one row group, and for a shard what it is, sealed, in its metadata.

A shard is the unit of work, of resuming, of checking and of reading. The bytes follow from rows and writer alone, so
that whoever reads a whole shard and writes it again can tell whether a bit of it was changed.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from tempfile import TemporaryFile
from typing import IO, Any

import pyarrow as pa
import pyarrow.parquet as pq

from siggen.dataset.inventory import PromisedFile
from siggen.errors import VerificationError

ABOUT = b"siggen.shard"
"""Key of what a shard is, in the metadata of its file of rows."""

LIST_LEAF = ".list.element"
"""What Parquet appends to a list column; an encoding asked for without it is accepted and ignored."""

ZSTD_LEVEL = 1
SPLIT_BYTES = "BYTE_STREAM_SPLIT"
MOST_BYTES = 1 << 36
"""Decoded: above that a table lies about itself."""

GROUP_ROWS = 1 << 13
"""Rows of a row group of the tables that hold a row per record or damage."""


def packed(table: pa.Table, about: Mapping[str, Any] | None = None) -> bytes:
    """Return a table as Parquet of one row group; a shard says what it is."""
    whole = table.combine_chunks()
    if about is not None:
        content = json.dumps(about, sort_keys=True)
        text = json.dumps({"sha256": hashlib.sha256(content.encode()).hexdigest(), "content": content})
        whole = whole.replace_schema_metadata({**(whole.schema.metadata or {}), ABOUT: text.encode()})
    sink = pa.BufferOutputStream()
    pq.write_table(whole, sink, row_group_size=max(1, whole.num_rows), **parquet_options(whole.schema))
    return bytes(sink.getvalue().to_pybytes())


class PackedTable:
    """A table that grows batch by batch in a file without a name; its bytes do not depend on how batches cut it."""

    def __init__(self, schema: pa.Schema) -> None:
        self._file: IO[bytes] = TemporaryFile()  # noqa: SIM115 - closed by `close`
        self._writer = pq.ParquetWriter(self._file, schema, **parquet_options(schema))
        self._pending = schema.empty_table()

    def add(self, batch: pa.RecordBatch) -> None:
        """Write the row groups that a batch completes."""
        more = pa.Table.from_batches([batch]).cast(self._pending.schema)
        self._pending = pa.concat_tables([self._pending, more])
        while self._pending.num_rows >= GROUP_ROWS:
            self._write(self._pending.slice(0, GROUP_ROWS))
            self._pending = self._pending.slice(GROUP_ROWS)

    def finish(self) -> tuple[IO[bytes], PromisedFile]:
        """Return the file from its beginning, and what is promised of it."""
        self._write(self._pending)
        self._writer.close()
        size = self._file.tell()
        self._file.seek(0)
        digest = hashlib.file_digest(self._file, "sha256").hexdigest()  # type: ignore[arg-type]
        self._file.seek(0)
        return self._file, PromisedFile(bytes=size, sha256=digest)

    def close(self) -> None:
        """Give the file back."""
        try:
            self._writer.close()
        finally:
            self._file.close()

    def _write(self, rows: pa.Table) -> None:
        # one contiguous piece: page borders would otherwise follow the borders of the batches
        self._writer.write_table(rows.combine_chunks(), row_group_size=GROUP_ROWS)


def unpacked(content: bytes, columns: Sequence[str] | None = None, *, hashed: bool = False) -> pa.Table:
    """Return the rows of a table; its pages are compared with their checksums unless all of it was with its hash.

    Raises
    ------
    VerificationError
        If it is no Parquet, or a page does not match its checksum.
    """
    with _opened(content, hashed=hashed) as file:
        footer = file.metadata
        size = sum(footer.row_group(i).total_byte_size for i in range(footer.num_row_groups))
        if not 0 <= size <= MOST_BYTES:
            raise VerificationError(f"it says of itself that it takes {size} bytes")
        return file.read(columns=None if columns is None else list(columns), use_threads=False)


def columns_of(content: bytes) -> list[str]:
    """Return the names of the columns of a table. Raises as `unpacked`."""
    with _opened(content) as file:
        return list(file.schema_arrow.names)


def group_rows(content: bytes) -> tuple[int, ...]:
    """Return how many rows each row group of a table has. Raises as `unpacked`."""
    with _opened(content, hashed=True) as file:
        return tuple(file.metadata.row_group(group).num_rows for group in range(file.num_row_groups))


@contextmanager
def _opened(content: bytes, *, hashed: bool = False) -> Iterator[pq.ParquetFile]:
    try:
        with pq.ParquetFile(pa.BufferReader(content), page_checksum_verification=not hashed) as file:
            yield file
    except (OSError, pa.ArrowException, ValueError, KeyError, OverflowError, RuntimeError) as error:
        raise VerificationError("it cannot be decoded") from error


def about_of(table: pa.Table) -> dict[str, Any]:
    """Return what a shard says of itself.

    Raises
    ------
    VerificationError
        If it says nothing, or that was changed.
    """
    try:
        found = json.loads((table.schema.metadata or {})[ABOUT])
        content = found["content"]
        if hashlib.sha256(content.encode()).hexdigest() != found["sha256"]:
            raise VerificationError("what it says of itself was changed")
        return dict(json.loads(content))
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise VerificationError(f"it does not say what it is ({type(error).__name__})") from error


def promised(content: bytes) -> PromisedFile:
    """Return size and hash of a file."""
    return PromisedFile(bytes=len(content), sha256=hashlib.sha256(content).hexdigest())


def parquet_options(schema: pa.Schema) -> dict[str, Any]:
    """Return how a table is written."""
    leaves = {field.name: leaf(field) for field in schema}
    numeric_lists = [leaves[field.name] for field in schema if _is_series(field)]
    return {
        "compression": "zstd",
        "compression_level": ZSTD_LEVEL,
        "use_dictionary": [leaves[field.name] for field in schema if pa.types.is_string(field.type)],
        "column_encoding": dict.fromkeys(numeric_lists, SPLIT_BYTES),
        "write_statistics": [leaves[field.name] for field in schema if not _is_series(field)],
        "write_page_index": True,
        "write_page_checksum": True,
    }


def leaf(field: pa.Field) -> str:
    """Return the path of the values of a column in Parquet."""
    name: str = field.name
    return name + LIST_LEAF if isinstance(field.type, pa.ListType | pa.FixedSizeListType) else name


def _is_series(field: pa.Field) -> bool:
    """Tell whether a column holds series of floating-point numbers: signals, pulse times, outlines."""
    is_list = isinstance(field.type, pa.ListType | pa.FixedSizeListType)
    return is_list and pa.types.is_floating(field.type.value_type)
