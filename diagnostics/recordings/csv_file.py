"""Text files with one row per sample: with or without a line of names, separated by comma, semicolon or tab."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from diagnostics.recordings.columns import Columns
from siggen.errors import UsageError

SEPARATORS = ("\t", ";", ",")


def read_csv(path: Path) -> Columns:
    """Read a text file; with semicolons or tabs a comma is a decimal comma.

    Raises
    ------
    UsageError
        If a cell is not a number or rows differ in length.
    """
    import pyarrow as pa
    from pyarrow import csv

    try:
        first = _first_line(path)
        separator = next((mark for mark in SEPARATORS if mark in first), ",")
        decimal = "," if separator != "," and "," in _second_line(path) else "."
        cells = [cell.strip().strip('"') for cell in first.split(separator)]
        named = not all(_is_number(cell, decimal) for cell in cells)
        names = cells if named else [str(k) for k in range(1, len(cells) + 1)]
        table = csv.read_csv(
            path,
            read_options=csv.ReadOptions(column_names=names, skip_rows=int(named)),
            parse_options=csv.ParseOptions(delimiter=separator),
            convert_options=csv.ConvertOptions(decimal_point=decimal, column_types=dict.fromkeys(names, pa.float64())),
        )
    except (UnicodeDecodeError, pa.ArrowInvalid) as error:
        raise UsageError(
            f"{path}: cannot be read as a table of numbers ({error}); one row per sample, please"
        ) from error
    filled = (np.asarray(column.to_numpy(), dtype=np.float64) for column in table.columns)
    return Columns(dict(zip(names, filled, strict=True)))


def _first_line(path: Path) -> str:
    with path.open(encoding="utf-8-sig") as file:
        return file.readline().rstrip("\r\n")


def _second_line(path: Path) -> str:
    with path.open(encoding="utf-8-sig") as file:
        file.readline()
        return file.readline()


def _is_number(cell: str, decimal: str) -> bool:
    try:
        float(cell.replace(decimal, "."))
    except ValueError:
        return False
    return True
