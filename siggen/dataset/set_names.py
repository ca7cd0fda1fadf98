"""The user's own names of a finished set, by its config.yaml."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from siggen.columns.background_columns import background_columns
from siggen.columns.common_columns import common_columns
from siggen.config.names import NO_NAMES, Names


def set_names(config: Mapping[str, Any]) -> tuple[Names, dict[str, str]]:
    """Return the names of a set's gears, shafts and meshes, and the program's name of each column that has an own one.

    Both empty for sets in the short form, and for sets of another version that this one cannot read.
    """
    if config.get("machine") is None:
        return NO_NAMES, {}
    from siggen.config import parse

    found = parse(config).config
    if found is None:
        return NO_NAMES, {}
    columns = (*common_columns(found), *background_columns(found))
    return found.names, {found.names.column(one.name): one.name for one in columns}
