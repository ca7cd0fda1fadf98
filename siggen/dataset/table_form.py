"""What every table of a set has at least, whoever wrote it: the columns that readers count on, of one type, whole."""

from __future__ import annotations

from collections.abc import Collection, Mapping

import pyarrow as pa

from siggen.columns.damage import DAMAGE_COLUMNS
from siggen.columns.life import LIFE_TABLES, NULLABLE
from siggen.columns.record import ID_COLUMNS, TACHO_COLUMN
from siggen.dataset.inventory import Inventory
from siggen.dataset.object_name import DAMAGE, DATA_FOLDER, INTERNALS_FOLDER, LABELS, life_name
from siggen.errors import VerificationError
from siggen.keys.column import list_of

TEXTS = ("fault", "severity", "faulty_gear")
NUMBERS = (
    *("damaged_area_mm2", "damaged_area_share", "damage_profile_length_mm", "mesh_stiffness_loss"),
    *("speed_hz", "torque_nm"),
)
Form = Mapping[str, pa.DataType]
"""Column -> type."""


def needed(name: str, inventory: Inventory) -> Form:
    """Return the columns that a file of a set has at least."""
    samples = round(inventory.fs_hz * inventory.duration_s)
    ids = {column.name: column.type for column in ID_COLUMNS}
    labels = ids | dict.fromkeys(TEXTS, pa.string()) | dict.fromkeys(NUMBERS, pa.float64())
    if name == LABELS:
        return labels
    if name == DAMAGE:
        return {column.name: column.type for column in DAMAGE_COLUMNS}
    if name.startswith(f"{DATA_FOLDER}/"):
        signals = {channel.column: list_of(pa.float32(), samples) for channel in inventory.channels}
        return labels | signals | {TACHO_COLUMN.name: TACHO_COLUMN.type}
    if name.startswith(f"{INTERNALS_FOLDER}/"):
        return ids | {one.name: list_of(pa.float32(), samples) for one in inventory.internals}
    return {}


def check_form(table: pa.Table, form: Form, *, asked: Collection[str] | None = None) -> None:
    """Compare a table, or those of its columns that were asked for, with what readers count on.

    Raises
    ------
    VerificationError
        If a column is missing, twice, of another type, or holds nulls.
    """
    found = dict(zip(table.column_names, table.columns, strict=True))
    if len(found) != table.num_columns:
        raise VerificationError("it has two columns of one name")
    for name, kind in form.items():
        if asked is not None and name not in asked:
            continue
        if name not in found:
            raise VerificationError(f"it has no column {name}")
        if not _alike(found[name].type, kind):
            raise VerificationError(f"its column {name} is of type {found[name].type} instead of {kind}")
    for name, column in found.items():
        if column.null_count and name not in NULLABLE:
            raise VerificationError(f"its column {name} holds nulls")
        if _is_list(column.type) and any(chunk.values.null_count for chunk in column.chunks):
            raise VerificationError(f"its column {name} holds lists with nulls")


def life_form(table: str) -> Form:
    """Return the columns that a table of lives has, of whose columns a blind set may show some alone."""
    return {column.name: column.type for column in LIFE_TABLES.get(table, ())}


def form_of(name: str, inventory: Inventory, columns: Collection[str]) -> Form:
    """Return the form of a file with these columns: a table of lives is held to those of its columns that it has."""
    for table in LIFE_TABLES:
        if name == life_name(table):
            own = {column: kind for column, kind in life_form(table).items() if column in columns}
            return {"split": pa.string(), "specimen_id": pa.int64()} | own
    return needed(name, inventory)


def _alike(found: pa.DataType, kind: pa.DataType) -> bool:
    if _is_list(kind):
        size = getattr(kind, "list_size", -1)
        return (
            _is_list(found)
            and found.value_type == kind.value_type
            and (not isinstance(kind, pa.FixedSizeListType) or getattr(found, "list_size", -1) == size)
        )
    return bool(found == kind)


def _is_list(kind: pa.DataType) -> bool:
    return isinstance(kind, pa.ListType | pa.FixedSizeListType)
