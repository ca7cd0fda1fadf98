"""History of load from a file into the configuration, so that a set stays a function of it alone."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

from siggen.config.data_file import data_file_bytes, shortened_path
from siggen.config.life import MOST_H, MOST_SPEED_HZ, MOST_TORQUE_NM
from siggen.errors import Problem
from siggen.keys.problems import nearest

KEY = "life.history"
UNTIL, TORQUE, SPEED = COLUMNS = ("until_h", "torque_nm", "speed_hz")
"""Hour until which a row lasts, and its load."""
LARGEST = {UNTIL: MOST_H, TORQUE: MOST_TORQUE_NM, SPEED: MOST_SPEED_HZ}
MOST_ROWS = 10_000
ALLOWED = f"allowed: a CSV or Parquet file with the columns {', '.join(COLUMNS)}, 1 to {MOST_ROWS} rows of numbers"
HARMLESS = [[1.0, 1.0]]
"""What stands for a file that cannot be used, so that nothing else is said of it."""


class _Refusal(Exception):  # noqa: N818 - a refusal is no error of the program
    def __init__(self, received: str, allowed: str = ALLOWED) -> None:
        self.received, self.allowed = received, allowed
        super().__init__(received)


class _Rows(NamedTuple):
    """Names of the columns, rows of texts or numbers, and where in the file each row stands."""

    names: Sequence[str]
    rows: Sequence[Mapping[str, Any]]
    places: Sequence[str]


def with_history_file(raw: Mapping[str, Any], folder: Path) -> tuple[Mapping[str, Any], list[Problem]]:
    """Return a configuration's mapping with the numbers of the history file that it names, and what is wrong with them.

    Parameters
    ----------
    raw : mapping, left as it is
    folder : Path from which the path of the file counts
    """
    life = raw.get("life")
    history = life.get("history") if isinstance(life, Mapping) else None
    if not isinstance(life, Mapping) or not isinstance(history, Mapping) or "file" not in history:
        return raw, []
    name = str(history["file"])
    problems: list[Problem] = []
    try:
        blocks = _blocks(_rows(folder / name))
    except _Refusal as refused:
        blocks = HARMLESS
        problems = [Problem(f"{KEY}.file", f"{shortened_path(name)}{refused.received}", refused.allowed)]
    if more := [key for key in history if key != "file"]:
        problems.append(Problem(f"{KEY}.{more[0]}", "a key beside file", "allowed: file alone, or a list of blocks"))
    return {**raw, "life": {**life, "history": blocks}}, problems


def _rows(file: Path) -> _Rows:
    try:
        content = data_file_bytes(file)
        return _parquet_rows(content) if file.suffix.lower() == ".parquet" else _csv_rows(content)
    except OSError as error:
        raise _Refusal(f", which cannot be read ({error.strerror})") from None
    except (ValueError, csv.Error):
        raise _Refusal(", which is no such file") from None


def _csv_rows(content: bytes) -> _Rows:
    reader = csv.DictReader(io.StringIO(content.decode("utf-8-sig"), newline=""))
    rows, places = [], []
    for row in islice(reader, MOST_ROWS + 1):
        rows.append(row)
        places.append(f"line {reader.line_num}")
    return _Rows(reader.fieldnames or (), rows, places)


def _parquet_rows(content: bytes) -> _Rows:
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        file = pq.ParquetFile(io.BytesIO(content))
        names = file.schema_arrow.names
        count = min(file.metadata.num_rows, MOST_ROWS + 1)
        known = [name for name in COLUMNS if name in names]
        rows = file.read(columns=known).to_pylist() if count <= MOST_ROWS else [{}] * count
    except pa.ArrowException as error:
        raise ValueError(str(error)) from None
    return _Rows(names, rows, [f"row {number}" for number in range(1, len(rows) + 1)])


def _blocks(found: _Rows) -> list[list[float]]:
    """Return hours, torque [N m] and speed [Hz] of every row."""
    for column in COLUMNS:
        if column not in found.names:
            hint = nearest(column, [name for name in found.names if name not in COLUMNS])
            raise _Refusal(f" without a column {column}", f"{ALLOWED}{hint}")
    if not 1 <= len(found.rows) <= MOST_ROWS:
        many = f"more than {MOST_ROWS}" if found.rows else "no"
        raise _Refusal(f" with {many} rows", f"{ALLOWED}; join rows of one load")
    blocks: list[list[float]] = []
    before = 0.0
    for row, place in zip(found.rows, found.places, strict=True):
        until, *load = (_number(row[column], column, place) for column in COLUMNS)
        if until <= before:
            later = f"above {before:g}, the hour before: a row lasts until its hour" if blocks else "above 0"
            raise _Refusal(f", {place}: {UNTIL} {until:g}", f"allowed: {later}")
        blocks.append([until - before, *load])
        before = until
    return blocks


def _number(value: Any, column: str, place: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        shown = "nothing" if value in (None, "") else f"'{str(value)[:60]}'"
        raise _Refusal(f", {place}: {column} {shown}", "allowed: a number") from None
    if not 0.0 <= number <= LARGEST[column]:
        raise _Refusal(f", {place}: {column} {number:g}", f"allowed: from 0 to {LARGEST[column]:g}")
    return number
