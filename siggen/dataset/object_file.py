"""An object of a store as a file for reading: pieces are fetched as they are asked for, further ahead in a row."""

from __future__ import annotations

import io
import os
from collections.abc import Callable

FIRST_BYTES = 1 << 16
MOST_BYTES = 8 << 20
"""Fetched at once by whoever reads in a row; a footer or one column costs little more than its own bytes."""


class ObjectFile(io.RawIOBase):
    """A file for reading with seek.

    Parameters
    ----------
    size : int
        Bytes of the object.
    fetch : callable
        (first byte, byte behind the last) -> content.
    """

    def __init__(self, size: int, fetch: Callable[[int, int], bytes]) -> None:
        super().__init__()
        self._size, self._fetch = size, fetch
        self._place = 0
        self._kept, self._kept_at = b"", 0
        self._ahead = FIRST_BYTES

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
        self._place = offset + {os.SEEK_SET: 0, os.SEEK_CUR: self._place, os.SEEK_END: self._size}[whence]
        return self._place

    def read(self, size: int | None = -1) -> bytes:
        """Return the next bytes, all that are left for a negative size."""
        end = self._size if size is None or size < 0 else min(self._place + size, self._size)
        if end <= self._place:
            return b""
        if not self._kept_at <= self._place <= end <= self._kept_at + len(self._kept):
            self._keep(end)
        found = self._kept[self._place - self._kept_at : end - self._kept_at]
        self._place = end
        return found

    def expect(self, first: int, end: int) -> None:
        """Fetch a stretch at once, of which all is going to be read piece by piece."""
        first, end = max(first, 0), min(end, self._size)
        if first < end and not self._kept_at <= first <= end <= self._kept_at + len(self._kept):
            self._kept_at, self._kept = first, self._fetch(first, end)

    def _keep(self, end: int) -> None:
        """Fetch from the place on, at least to `end`."""
        in_a_row = self._kept_at <= self._place <= self._kept_at + len(self._kept) and self._kept != b""
        self._ahead = min(2 * self._ahead, MOST_BYTES) if in_a_row else FIRST_BYTES
        last = min(max(end, self._place + self._ahead), self._size)
        self._kept_at, self._kept = self._place, self._fetch(self._place, last)
