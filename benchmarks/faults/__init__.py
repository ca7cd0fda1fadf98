"""Faults made on purpose, and what came of them: flipped bits, hostile files, shortages, kills; one digest of all ways.

Here `measured` is how many were found or refused, `alternative` what else happened, and the goal is all of them.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator

from benchmarks.row import Row

PARTS = (
    *("mutated_configurations", "mutated_recordings", "hostile_files", "foreign_sets", "bit_flips", "digests"),
    *("shortages", "kills"),
)
"""Each is a topic by itself: `python -m benchmarks faults.kills`."""


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield one row per kind of fault: repetitions, outcome, whether every one was met with words."""
    for part in PARTS:
        yield from importlib.import_module(f"{__name__}.{part}").rows(quick=quick)
