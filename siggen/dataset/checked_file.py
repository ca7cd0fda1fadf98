"""A file of which every byte that is read was compared with a checksum before.

Parquet's own page checksums cover the pages alone. Their headers, the page index and the footer decide as much what a
reader sees, so the checksums here are of blocks of the whole file, whatever stands in them.
"""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import BinaryIO, NamedTuple
from zlib import crc32

import pyarrow as pa
import pyarrow.parquet as pq

from siggen.dataset.object_file import ObjectFile
from siggen.dataset.storage import HOW_TO_GO_ON, READ_BYTES, Storage
from siggen.errors import DatasetError

BLOCK_BYTES = 1 << 16
"""Of one checksum: 8 characters in the sidecar per 64 KiB, and at most that much is read in vain at either end."""

DIGITS = 8


class Checksums(NamedTuple):
    """SHA-256 of a file, and the CRC-32 of its blocks of 64 KiB as 8 hexadecimal digits each, one after the other."""

    sha256: str
    crc32_per_64_kib: str


def checksums(file: BinaryIO) -> Checksums:
    """Return the checksums of an open file, read in pieces from where it stands."""
    digest, blocks = hashlib.sha256(), []
    while piece := file.read(READ_BYTES):
        digest.update(piece)
        blocks += [_crc(piece[start : start + BLOCK_BYTES]) for start in range(0, len(piece), BLOCK_BYTES)]
    return Checksums(digest.hexdigest(), "".join(blocks))


class CheckedFile(io.RawIOBase):
    """A file for reading whose blocks are compared with their CRC-32 before any byte of them is given out.

    Parameters
    ----------
    file : binary file
        Closed together with this one.
    crc32_per_64_kib : str
        As `checksums` gives it.
    """

    def __init__(self, file: BinaryIO, crc32_per_64_kib: str) -> None:
        super().__init__()
        self._file, self._crc = file, crc32_per_64_kib
        self._end = file.seek(0, os.SEEK_END)
        self._place = 0

    def readable(self) -> bool:
        """Tell that it can be read."""
        return True

    def seekable(self) -> bool:
        """Tell that it has places to go to."""
        return True

    def tell(self) -> int:
        """Return the place of the next byte."""
        return self._place

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """Go to a place and return it."""
        self._place = offset + {os.SEEK_SET: 0, os.SEEK_CUR: self._place, os.SEEK_END: self._end}[whence]
        return self._place

    def read(self, size: int | None = -1) -> bytes:
        """Return the next bytes, all that are left for a negative size.

        Raises
        ------
        OSError
            If a block is not what its checksum promises.
        """
        end = self._end if size is None or size < 0 else min(self._place + size, self._end)
        begin = self._place - self._place % BLOCK_BYTES
        self._file.seek(begin)
        content = self._file.read(min(-(-end // BLOCK_BYTES) * BLOCK_BYTES, self._end) - begin) if end > begin else b""
        for start in range(0, len(content), BLOCK_BYTES):
            self._check(content[start : start + BLOCK_BYTES], begin + start)
        found = content[self._place - begin : end - begin]
        self._place += len(found)
        return found

    def expect(self, first: int, end: int) -> None:
        """Fetch the blocks of a stretch at once where they come from a store."""
        if isinstance(self._file, ObjectFile):
            self._file.expect(first - first % BLOCK_BYTES, -(-end // BLOCK_BYTES) * BLOCK_BYTES)

    def close(self) -> None:
        """Close the file below as well."""
        self._file.close()
        super().close()

    def _check(self, block: bytes, begin: int) -> None:
        place = begin // BLOCK_BYTES * DIGITS
        if self._crc[place : place + DIGITS] != _crc(block):
            raise OSError(f"bytes {begin} to {begin + len(block) - 1} do not match their checksum")


class CheckedTable(NamedTuple):
    """A Parquet file over a checked one; of a store, a row group is one request."""

    file: CheckedFile
    parquet: pq.ParquetFile

    @property
    def schema(self) -> pa.Schema:
        """The columns."""
        return self.parquet.schema_arrow

    @property
    def footer(self) -> pq.FileMetaData:
        """What the file says of its row groups."""
        return self.parquet.metadata

    def groups(self, columns: Sequence[str] | None = None) -> Iterator[pa.Table]:
        """Yield the row groups one by one, all columns or some."""
        for number in range(self.footer.num_row_groups):
            yield self.group(number, columns)

    def group(self, number: int, columns: Sequence[str] | None = None) -> pa.Table:
        """Return the rows of a row group, all columns or some."""
        self.file.expect(*self._span(number, columns))
        wanted = None if columns is None else list(columns)
        return self.parquet.read_row_group(number, columns=wanted, use_threads=False)

    def read(self, columns: Sequence[str] | None = None) -> pa.Table:
        """Return all rows, all columns or some."""
        if columns is None:
            self.file.expect(0, self.file.seek(0, os.SEEK_END))
        return self.parquet.read(columns=None if columns is None else list(columns), use_threads=False)

    def _span(self, number: int, columns: Sequence[str] | None) -> tuple[int, int]:
        """Return where column chunks of a row group lie: first byte, byte behind the last."""
        group = self.footer.row_group(number)
        chunks = [group.column(i) for i in range(self.footer.num_columns)]
        wanted = [c for c in chunks if columns is None or c.path_in_schema.partition(".")[0] in columns]
        firsts = [c.dictionary_page_offset or c.data_page_offset for c in wanted]
        ends = [first + c.total_compressed_size for first, c in zip(firsts, wanted, strict=True)]
        return min(firsts, default=0), max(ends, default=0)


@contextmanager
def parquet_file(
    storage: Storage, name: str, crc32_per_64_kib: str, size: int | None = None, footer: pq.FileMetaData | None = None
) -> Iterator[CheckedTable]:
    """Open a Parquet object of a set; no byte of it is decoded unchecked.

    Parameters
    ----------
    size : int, optional
        Its promised bytes, which need not be asked for then.
    footer : FileMetaData, optional
        Its footer, if it was read before.

    Raises
    ------
    DatasetError
        If it is missing, or as soon as bytes are read that do not match their checksum or are no Parquet; the message
        says how to go on.
    """
    try:
        with (
            CheckedFile(storage.open(name, size), crc32_per_64_kib) as file,
            pq.ParquetFile(file, metadata=footer, page_checksum_verification=True) as table,
        ):
            yield CheckedTable(file, table)
    except (OSError, pa.ArrowException) as error:
        raise DatasetError(f"{storage.location}/{name} cannot be read ({error}); {HOW_TO_GO_ON}") from error


def _crc(block: bytes) -> str:
    return f"{crc32(block):0{DIGITS}x}"
