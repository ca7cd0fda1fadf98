"""Problem of a list of gear pairs that holds none: whoever writes it may mean no pairs, or forgot them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from siggen.config.gears import Gears
from siggen.errors import Problem


def emptied_pairs(raw: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the problem of an empty `gears.pairs` that someone wrote.

    Parameters
    ----------
    raw : mapping
        As written, without what it extends. A stored configuration states every key of `gears`, so an empty list there
        is the default and nobody's slip.
    """
    gears = raw.get("gears")
    if not isinstance(gears, Mapping) or gears.get("pairs") not in ([], ()) or set(Gears.model_fields) <= set(gears):
        return
    yield Problem("gears.pairs", "a list without a pair", "allowed: one pair at least, or null for none")
