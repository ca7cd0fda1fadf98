"""Memory that a process frees and takes again for every record, kept by it.

glibc gives arrays of some megabytes back to the system as soon as they are freed. The system clears every page of the
next one: a seventh of what the indicators of a record of 10 s cost.
"""

from __future__ import annotations

import ctypes
import sys

TRIM_THRESHOLD, MMAP_THRESHOLD = -1, -3
"""Parameters of `mallopt`, as in glibc's malloc.h."""
LARGEST_BYTES, KEPT_BYTES = 32 << 20, 256 << 20
"""Arrays up to the first size lie on the heap, of which the second stays; 32 MB is the most that glibc allows."""


def keep_memory() -> None:
    """Keep freed memory in this process from now on; without glibc nothing changes.

    For processes of our own alone: commands and workers, not what imports this package.
    """
    if sys.platform != "linux":
        return
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(MMAP_THRESHOLD, LARGEST_BYTES)
        mallopt(TRIM_THRESHOLD, KEPT_BYTES)
