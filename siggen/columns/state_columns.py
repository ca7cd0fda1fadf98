"""Columns of what states of a set are beside their fault."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.keys.column import Column, list_of

if TYPE_CHECKING:
    from siggen.config import Config

SHAM_COLUMN = Column("sham", pa.bool_(), "", "whether its damage was drawn and passed on with nothing removed")

CHANGED_COLUMN = Column(
    "changed_keys", list_of(pa.string()), "", "keys that differ from the healthy gearbox, besides damage"
)


def state_columns(config: Config) -> tuple[Column, ...]:
    """Return the columns that sets have whose states need them."""
    sham = (SHAM_COLUMN,) if has_sham(config) else ()
    return (*sham, *((CHANGED_COLUMN,) if has_changes(config) else ()))


def has_changes(config: Config) -> bool:
    """Tell whether a state of a set changes keys of the machine."""
    return any(state.changes for state in config.states)


def has_sham(config: Config) -> bool:
    """Tell whether a state of a set is a sham."""
    return any(state.sham for state in config.states)
