"""The names of a finished set's gears, shafts and meshes, by its config.yaml."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from siggen.columns.record import label_columns
from siggen.names import PAIR, Names


def set_names(config: Mapping[str, Any]) -> tuple[Names, dict[str, str]]:
    """Return the names of a set, and what the simulation calls the value of each column that bears one of them.

    Those of a pair without any column, for sets without a machine, and of a version that this one cannot read.
    """
    if config.get("machine") is None:
        return PAIR, {}
    from siggen.config import parse

    found = parse(config).config
    if found is None:
        return PAIR, {}
    return found.names, {column.name: column.filled_by for column in label_columns(found) if column.label}
