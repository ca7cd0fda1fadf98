"""A file of which every byte that is read was compared with a checksum before.

Parquet's own page checksums cover the pages alone. Their headers, the page index and the footer decide as much what a
reader sees, so the checksums here are of blocks of the whole file, whatever stands in them.
"""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO, NamedTuple
from zlib import crc32

import pyarrow as pa
import pyarrow.parquet as pq

from siggen.dataset.storage import READ_BYTES, Storage
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

    def close(self) -> None:
        """Close the file below as well."""
        self._file.close()
        super().close()

    def _check(self, block: bytes, begin: int) -> None:
        place = begin // BLOCK_BYTES * DIGITS
        if self._crc[place : place + DIGITS] != _crc(block):
            raise OSError(f"bytes {begin} to {begin + len(block) - 1} do not match their checksum")


@contextmanager
def parquet_file(storage: Storage, name: str, crc32_per_64_kib: str) -> Iterator[pq.ParquetFile]:
    """Open a Parquet object of a set; no byte of it is decoded unchecked.

    Raises
    ------
    DatasetError
        If it is missing, or as soon as bytes are read that do not match their checksum or are no Parquet; the message
        says how to go on.
    """
    try:
        with (
            storage.open(name) as file,
            pq.ParquetFile(CheckedFile(file, crc32_per_64_kib), page_checksum_verification=True) as table,
        ):
            yield table
    except (OSError, pa.ArrowException) as error:
        raise DatasetError(
            f"{storage.location}/{name} cannot be read ({error}); `siggen verify {storage.location}` finds all "
            "damaged files; delete them, and `siggen generate` with the set's config.yaml makes them again"
        ) from error


def _crc(block: bytes) -> str:
    return f"{crc32(block):0{DIGITS}x}"
