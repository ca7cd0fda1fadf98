"""Labels of the records of a page as packed columns: numbers, or texts by their places in a list of names."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pyarrow as pa

from siggen.dataset.reading import Dataset

MOST_NAMES = 65_535
"""Texts of a column, in 16 bits; a column of more is no choice of anything."""


def packed_labels(labels: Mapping[str, np.ndarray], titles: Mapping[str, str]) -> list[dict[str, Any]]:
    """Return name, title, kind and packed values of every column.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Numbers, texts, or objects of either with None where there is none.
    titles : mapping of str to str
        Of columns that are not shown by their own names.
    """
    return [{"name": name, "title": titles.get(name, name), **_packed(values)} for name, values in labels.items()]


def _packed(values: np.ndarray) -> dict[str, Any]:
    given = [value for value in values.tolist() if value is not None]
    if any(isinstance(value, str) for value in given):
        return _packed_texts(values.tolist())
    whole = len(given) == values.size and all(isinstance(value, int) for value in given)
    if whole and all(abs(value) < 2**31 for value in given):
        return {"kind": "whole", "data": _base64(np.asarray(given, "<i4"))}
    numbers = np.array([np.nan if value is None else float(value) for value in values.tolist()])
    return {"kind": "float", "data": _base64(numbers.astype("<f4"))}


def _packed_texts(values: list[Any]) -> dict[str, Any]:
    names = list(dict.fromkeys(str(value) for value in values if value is not None))
    code = {name: number for number, name in enumerate(names, start=1)}
    codes = np.array([0 if value is None else code[str(value)] for value in values], dtype="<u2")
    return {"kind": "text", "names": names, "data": _base64(codes)}


def _base64(values: np.ndarray) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode("ascii")


def packed_rows(rows: Iterable[int | None]) -> str:
    """Return rows as base 64 of 32-bit numbers, -1 where there is none."""
    return _base64(np.array([-1 if row is None else row for row in rows], dtype="<i4"))


def further_labels(dataset: Dataset, shown: Iterable[str]) -> dict[str, np.ndarray]:
    """Return the label columns of a set with one number or text a record, of which two differ, besides those shown."""
    table, known = dataset.labels(), set(shown)
    signals = {channel.column for channel in dataset.channels}
    found = {}
    for name, column in zip(table.column_names, table.columns, strict=True):
        if name in known | signals or pa.types.is_nested(column.type):
            continue
        differing = len(column.unique())
        if differing > 1 and (differing <= MOST_NAMES or not pa.types.is_string(column.type)):
            found[name] = np.array([_plain(value) for value in column.to_pylist()], dtype=object)
    return found


def _plain(value: Any) -> Any:
    return str(value).lower() if isinstance(value, bool) else value
