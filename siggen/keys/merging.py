"""Raw mappings of a file laid over others: what a file extends, a state takes over, or a catalogue gives."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from siggen.keys.distributions import WORDS

OTHERS = "others"
"""Key of a mapping that takes nothing over where it is null."""
LIKE = "like"
"""Key of a section that begins with the numbers of a catalogue, or of a state that takes over those of another one."""
REPLACING = ("kind", LIKE, "times", "add", *WORDS)
"""Keys of a mapping that stands for itself: it takes nothing from the one that it replaces."""
BY_WORD = ("variation", "background")
"""Sections for which a word of the catalogue may stand."""


def in_keys(value: Any) -> Any:
    """Return a section for which a word stands as a mapping; anything else as it is."""
    return {LIKE: value} if isinstance(value, str) else value


def merged(base: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    """Return `base` with the values of `own`, mappings merged key by key.

    Everything else replaces what it is laid over: numbers, lists, null, and mappings that have a `kind` of their own,
    are `like` something or stand for a number. A key that is new stands behind the one before it in `own`, and at the
    end where there is none.
    """
    if OTHERS in own and own[OTHERS] is None:
        return {key: value for key, value in own.items() if key != OTHERS}
    keys = [*base]
    at = len(keys) - 1
    for key in own:
        at = keys.index(key) if key in keys else at + 1
        keys[at:at] = [] if key in keys else [key]
    result = {key: base.get(key) for key in keys}
    for key, value in own.items():
        below = in_keys(result[key]) if key in BY_WORD else result[key]
        both = isinstance(below, Mapping) and isinstance(value, Mapping)
        replaces = not both or any(word in value for word in REPLACING)
        result[key] = value if replaces else merged(below, value)  # type: ignore[arg-type]
    return result
