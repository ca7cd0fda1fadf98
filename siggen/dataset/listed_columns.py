"""Roles of the columns of a finished set: by its manifest, else by its configuration, else those of a stranger.

A manifest that lists no columns is older than the list, or not from siggen. Of an older one the configuration says
what siggen would have listed. A column that nobody lists is a condition: known to whoever reads the set, so that it
must not tell the state.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from siggen.columns.record import listed_columns as columns_of
from siggen.columns.record import record_schema
from siggen.columns.versions import WITHOUT_ROLES
from siggen.dataset.inventory import Inventory, ListedColumn
from siggen.keys.column import Role


def listed_columns(inventory: Inventory, config: Mapping[str, Any]) -> dict[str, ListedColumn]:
    """Return the columns of a set whose roles are known, by name."""
    listed = inventory.columns
    if not listed and inventory.schema_version == WITHOUT_ROLES:
        listed = _by_configuration(config)
    return {column.name: column for column in listed}


def _by_configuration(config: Mapping[str, Any]) -> tuple[ListedColumn, ...]:
    """Return what siggen writes for a configuration; nothing for one that this version cannot read."""
    from siggen.config import parse

    found = parse(config).config
    if found is None:
        return ()
    return tuple(
        ListedColumn(name=one["name"], role=Role(one["role"]), section=one["section"])
        for one in columns_of(record_schema(found))
    )
