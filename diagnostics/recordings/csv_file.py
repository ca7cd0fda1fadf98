"""Text files with one row per sample: comments, a line of names and one of units first, or none of them."""

from __future__ import annotations

import re
from itertools import islice
from pathlib import Path

import numpy as np

from diagnostics.recordings.recorded_columns import Columns, refuse_many, refuse_twice
from siggen.errors import UsageError

SEPARATORS = ("\t", ";", ",")
COMMENTS = ("#", "%")

UNIT = re.compile(r"[\[(].*[\])]|(m/s(2|²|\^2|\*\*2)|g|[mµu]?V|[mµun]?s|sec|k?Hz|-|)", re.IGNORECASE)
"""Cell of a row of units: anything in brackets, or one of the units that an acceleration or its time comes in."""

TIME_UNIT = re.compile(r"[mµu]?s|sec", re.IGNORECASE)
"""Units of columns of acceleration are the user's to say: a row of units often stands over columns it is not of."""


def read_csv(path: Path) -> Columns:
    """Read a text file; with semicolons or tabs a comma is a decimal comma.

    Lines that start with # or % and empty ones above the first row are skipped, and below a line of names one line of
    units.

    Raises
    ------
    UsageError
        If it holds no samples, a cell is not a number, rows differ in length or two columns have one name.
    """
    import pyarrow as pa
    from pyarrow import csv

    try:
        lines = _first_lines(path)
        if not lines:
            raise UsageError(f"{path}: holds no samples: nothing but comments or empty lines")
        first = lines[0][1]
        separator = next((mark for mark in SEPARATORS if mark in first), ",")
        decimal = "," if separator != "," and any("," in text for _, text in lines[1:]) else "."
        refuse_many(path, first.count(separator) + 1)
        rows = [_cells(text, separator) for _, text in lines]
        named = not all(_is_number(cell, decimal) for cell in rows[0])
        above = int(named) + int(named and len(rows) > 1 and _are_units(rows[1], len(rows[0]), decimal))
        if above == len(rows):
            raise UsageError(f"{path}: holds no samples, only a header ({first})")
        names = rows[0] if named else [str(k) for k in range(1, len(rows[0]) + 1)]
        refuse_twice(path, names)
        table = csv.read_csv(
            path,
            read_options=csv.ReadOptions(column_names=names, skip_rows=lines[above][0]),
            parse_options=csv.ParseOptions(delimiter=separator),
            convert_options=csv.ConvertOptions(decimal_point=decimal, column_types=dict.fromkeys(names, pa.float64())),
        )
    except (UnicodeDecodeError, pa.ArrowInvalid) as error:
        raise UsageError(
            f"{path}: cannot be read as a table of numbers ({error}); one row per sample, please, and text "
            f"above the names begins with {' or '.join(COMMENTS)}"
        ) from error
    filled = (np.asarray(column.to_numpy(), dtype=np.float64) for column in table.columns)
    units = {name: unit.strip("[]() ") for name, unit in zip(names, rows[1], strict=True)} if above == 2 else {}
    columns = dict(zip(names, filled, strict=True))
    return Columns(columns, units={name: unit for name, unit in units.items() if TIME_UNIT.fullmatch(unit)})


def _first_lines(path: Path) -> list[tuple[int, str]]:
    """Return up to three lines that hold something, with their number from zero: names, units, first samples."""
    with path.open(encoding="utf-8-sig") as file:
        numbered = ((number, line.rstrip("\r\n")) for number, line in enumerate(file))
        held = ((number, text) for number, text in numbered if text.strip() and not text.startswith(COMMENTS))
        return list(islice(held, 3))


def _cells(text: str, separator: str) -> list[str]:
    return [cell.strip().strip('"') for cell in text.split(separator)]


def _are_units(cells: list[str], columns: int, decimal: str) -> bool:
    """Return whether a row holds units only, one at least; a row with any number or word is for the reader to judge."""
    return (
        len(cells) == columns
        and any(cells)
        and not any(_is_number(cell, decimal) for cell in cells)
        and all(UNIT.fullmatch(cell) for cell in cells)
    )


def _is_number(cell: str, decimal: str) -> bool:
    try:
        float(cell.replace(decimal, "."))
    except ValueError:
        return False
    return True
