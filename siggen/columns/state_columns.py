"""Columns of what states of a set are beside their fault."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.keys.column import Column

if TYPE_CHECKING:
    from siggen.config import Config

SHAM_COLUMN = Column("sham", pa.bool_(), "", "whether its damage was drawn and passed on with nothing removed")


def state_columns(config: Config) -> tuple[Column, ...]:
    """Return the columns that sets have whose states need them."""
    return (SHAM_COLUMN,) if has_sham(config) else ()


def has_sham(config: Config) -> bool:
    """Tell whether a state of a set is a sham."""
    return any(state.sham for state in config.states)
