"""Columns of what states of a set are beside their fault."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.keys.column import Column, Role, in_role, list_of

if TYPE_CHECKING:
    from siggen.config import Config

SHAM_COLUMN = Column("sham", pa.bool_(), "", "whether its damage was drawn and passed on with nothing removed")

PRIMARY_COLUMN = Column(
    "primary_fault", pa.string(), "", "fault, and of a combined state what its first damage in the list is called"
)

CHANGED_COLUMN = Column(
    "changed_keys", list_of(pa.string()), "", "keys that differ from the healthy gearbox, besides damage"
)


def state_columns(config: Config) -> tuple[Column, ...]:
    """Return the columns that sets have whose states need them."""
    sham = (SHAM_COLUMN,) if has_sham(config) else ()
    words = combined_words(config)
    kinds = (Column(f"has_{word}", pa.bool_(), "", f"whether it shows {word}") for word in words)
    primary = (PRIMARY_COLUMN,) if words else ()
    changed = (CHANGED_COLUMN,) if has_changes(config) else ()
    return in_role(Role.TARGET, *sham, *changed, *primary, *kinds)


def combined_words(config: Config) -> tuple[str, ...]:
    """Return what damage a set has by its words, where a state has several sections at once; else nothing."""
    if not any(len(state.damages) > 1 for state in config.states):
        return ()
    return tuple(sorted({one.word for state in config.states if state.damaged for one in state.damages}))


def shown_words(config: Config, state_id: int) -> set[str]:
    """Return the words of what a state and its milder states damage."""
    found: set[str] = set()
    index: int | None = state_id
    while index is not None:
        state = config.states[index]
        found |= {one.word for one in state.damages if state.damaged}
        index = config.grown_from(index)
    return found


def has_changes(config: Config) -> bool:
    """Tell whether a state of a set changes keys of the machine."""
    return any(state.changes for state in config.states)


def has_sham(config: Config) -> bool:
    """Tell whether a state of a set is a sham."""
    return any(state.sham for state in config.states)
