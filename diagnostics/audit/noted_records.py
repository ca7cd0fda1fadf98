"""Records that metadata of a table name by their ids, such as a note in the schema of a Parquet file.

A program that writes tables may leave there which records it treated. siggen's own metadata name none. Source: derived.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

import numpy as np
import pyarrow as pa

OWN = frozenset({b"unit", b"meaning", b"role", b"section"})
FEWEST = 2
"""Ids in a text from which it counts; one number may be anything."""


def noted_records(schemas: Iterable[pa.Schema], record_id: np.ndarray) -> dict[str, np.ndarray]:
    """Return which records (records,) each text of the metadata names, (records,) bool by the text's place.

    Parameters
    ----------
    schemas : iterable of pyarrow.Schema
        Of the labels of every split; texts of one place are taken together.
    record_id : (records,) int
    """
    found: dict[str, np.ndarray] = {}
    for place, text in (entry for schema in schemas for entry in _texts(schema)):
        found[place] = found.get(place, False) | np.isin(record_id, _numbers(text))
    return {place: named for place, named in found.items() if FEWEST <= named.sum() < named.size}


def _texts(schema: pa.Schema) -> Iterator[tuple[str, str]]:
    for key, value in (schema.metadata or {}).items():
        yield f"named in `{key.decode(errors='replace')}` of the file", value.decode(errors="replace")
    for field in schema:
        for key, value in (field.metadata or {}).items():
            if key not in OWN:
                yield f"named in `{key.decode(errors='replace')}` of {field.name}", value.decode(errors="replace")


def _numbers(text: str) -> list[int]:
    return [int(number) for number in re.findall(r"(?<![\w.])\d{1,18}(?![\w.])", text)]
