"""How many paths a family may have: a set's configuration holds them all, and it may have 4 MiB."""

from __future__ import annotations

PATH_BYTES = 49_200
"""Of one path of one sensor: frequencies and four complex curves of 1,025 points as float32 in base64."""
MOST_BYTES = 2_800_000


def family_size(wanted: int, sensors: int) -> int:
    """Return the wanted number of paths, or what fits for so many sensors."""
    return max(1, min(wanted, MOST_BYTES // (PATH_BYTES * sensors)))
