"""Densities of noise from files into the configuration, so that a set stays a function of it alone."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from itertools import islice
from pathlib import Path
from typing import Any

from siggen.errors import Problem
from siggen.keys.data_file import data_file_bytes, shortened_path
from siggen.noise.kinds import SOURCES

COLUMNS = ("frequency_hz", "density")
MOST_KNOTS = 10_000


def with_density_files(raw: Mapping[str, Any], folder: Path) -> tuple[Mapping[str, Any], list[Problem]]:
    """Return a configuration's mapping with the numbers of the density files it names, and what is wrong with them.

    Parameters
    ----------
    raw : mapping, left as it is
    folder : Path from which the paths of the files count
    """
    problems: list[Problem] = []

    def filled(parent: Any, key: str, path: str, columns: tuple[str, ...] = COLUMNS) -> Any:
        table = parent.get(key) if isinstance(parent, Mapping) else None
        if not isinstance(table, Mapping) or "file" not in table:
            return parent
        numbers, problem = _read(folder / str(table["file"]), f"{path}.file", columns)
        problems.extend(problem)
        return {**parent, key: {**{k: v for k, v in table.items() if k != "file"}, **numbers}}

    found = dict(raw)
    if isinstance(sensors := raw.get("sensors"), Mapping):
        for source in (one for one in SOURCES if one.file_columns):
            key, columns = source.key, source.file_columns
            sensors = {name: filled(one, key, f"sensors.{name}.{key}", columns) for name, one in sensors.items()}
        found["sensors"] = sensors
    return found, problems


def _read(file: Path, where: str, columns: tuple[str, ...]) -> tuple[dict[str, list[float]], list[Problem]]:
    """Return the lists of a file; harmless ones with a problem if it cannot be used."""
    harmless = {column: [1.0, 2.0] for column in columns}
    least = 2 if columns == COLUMNS else 1
    allowed = f"allowed: a CSV file with the columns {', '.join(columns)}, {least} to {MOST_KNOTS} rows of numbers"
    try:
        lines = io.StringIO(data_file_bytes(file).decode("utf-8-sig"), newline="")
        rows = list(islice(csv.DictReader(lines), MOST_KNOTS + 1))
        numbers = {column: [float(row[column]) for row in rows] for column in columns}
    except OSError as error:
        return harmless, [Problem(where, f"{shortened_path(file)}: {error.strerror}", allowed)]
    except (KeyError, TypeError, ValueError, csv.Error):
        return harmless, [Problem(where, f"{file}: columns are missing, or not numbers", allowed)]
    if not least <= len(rows) <= MOST_KNOTS:
        return harmless, [Problem(where, f"{file}: {len(rows)} rows", allowed)]
    return numbers, []
