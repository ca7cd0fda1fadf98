"""Names of the vibration channels in a file whose user named none: every column of numbers but time and tacho."""

from __future__ import annotations

from pathlib import Path

from diagnostics.recordings.columns import read_columns
from diagnostics.recordings.measured_recording import OWN_COLUMN
from diagnostics.recordings.recorded_columns import OWN_TACHO, Columns
from diagnostics.recordings.roles import ColumnUse, named_role
from diagnostics.recordings.units import unit_of_name
from siggen.errors import UsageError

MOST_CHANNELS = 32
PREFIX, SUFFIX = OWN_COLUMN.split("{}")


def is_vibration(found: Columns, name: str) -> bool:
    """Return whether neither the name nor the unit of a column says that it is another quantity."""
    return named_role(unit_of_name(name)[0], found.units.get(name, "")).role is ColumnUse.VIBRATION


def file_channels(path: Path, tacho: str | None = None, row: int | None = None) -> tuple[str, ...]:
    """Return the channels of a file, by the names that `read_recording` finds.

    Parameters
    ----------
    path : Path
    tacho : str, optional
        Column of the tacho.
    row : int, optional
        Of a Parquet file with one record per row.

    Raises
    ------
    UsageError
        If the file cannot be read, or holds no such column, or very many.
    """
    found = read_columns(path, row)
    if found.own:
        return tuple(found.own)
    own = [name for name in found.values if name.startswith(PREFIX) and name.endswith(SUFFIX)]
    others = {tacho, OWN_TACHO, *found.clocks}
    names = own or [name for name in found.values if name not in others and is_vibration(found, name)]
    if not 1 <= len(names) <= MOST_CHANNELS:
        raise UsageError(
            f"{path}: {len(names)} columns that could be vibration; allowed: 1 to {MOST_CHANNELS}. Name those that you "
            "mean: --channel NAME=COLUMN"
        )
    return tuple(name.removeprefix(PREFIX).removesuffix(SUFFIX) if name in own else name for name in names)
