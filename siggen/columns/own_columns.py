"""Columns and labels in the user's own names of gears, shafts and meshes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from siggen.columns.background_columns import background_columns
from siggen.columns.common_columns import common_columns
from siggen.columns.state_columns import CHANGED_COLUMN
from siggen.keys.column import Column

if TYPE_CHECKING:
    from siggen.config import Config
    from siggen.config.names import Names

GEARS = {
    "faulty_gear": "gear with damage: none, {}, or several",
    "gear": "{}; none for damage that is on no gear",
    "tooth": "index of the tooth; -1 for all teeth of its gear, or none",
}
"""Column about gears of any mesh -> its meaning."""


def own_columns(names: Names, columns: Iterable[Column]) -> tuple[Column, ...]:
    """Return columns of the program in the user's words; as they are without a machine."""
    return tuple(_own(names, column) for column in columns) if names.gears else tuple(columns)


def own_labels(config: Config, labels: Mapping[str, object]) -> dict[str, object]:
    """Return labels of a record in the user's words; those of channels have names of their own."""
    names = config.names
    if not names.gears:
        return dict(labels)
    known = {column.name for column in (*common_columns(config), *background_columns(config))}
    found = {names.column(name) if name in known else name: value for name, value in labels.items()}
    if CHANGED_COLUMN.name in found:
        found[CHANGED_COLUMN.name] = [names.own_path(str(path)) for path in _listed(found[CHANGED_COLUMN.name])]
    return {**found, "faulty_gear": names.gear(str(labels["faulty_gear"]))}


def _listed(value: object) -> list[object]:
    return value if isinstance(value, list) else []


def _own(names: Names, column: Column) -> Column:
    own = ", ".join(name for _, name in names.gears)
    meaning = GEARS[column.name].format(own) if column.name in GEARS else names.text(column.meaning)
    return replace(column, name=names.column(column.name), meaning=meaning)
