"""Numbers of label columns that hold texts or dates: length, beginning, and parts of the date.

A text that is another one in every record tells no state as a whole; its beginning or its day may. Source: derived.
"""

from __future__ import annotations

import re
from collections import Counter
from datetime import datetime

import numpy as np

MOST_BEGINNINGS, LONGEST_BEGINNING = 8, 4
"""Beginnings that are columns, the most frequent first, and characters that a beginning may have."""

PARTS = ("year", "month", "day", "hour", "minute", "second")
DATE = re.compile(r"\d{4}-\d{2}-\d{2}([T ]\d{2}:\d{2}(:\d{2})?)?")


def text_columns(name: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """Return the numbers of a column of texts, (records,) float64 each; none where all texts are one.

    Parameters
    ----------
    name : str
        What the column is called.
    values : (records,) array
        Texts, dates or times.
    """
    texts = [str(value) for value in values.tolist()]
    if len(set(texts)) < 2:
        return {}
    found = {f"length of {name}": np.array([len(text) for text in texts], dtype=np.float64)}
    for length in range(1, LONGEST_BEGINNING + 1):
        starts = [text[:length] for text in texts]
        for start, _ in Counter(starts).most_common(MOST_BEGINNINGS):
            found[f"{name} begins with {start!r}"] = np.array([own == start for own in starts], dtype=np.float64)
    found |= _date_columns(name, texts)
    return {column: numbers for column, numbers in found.items() if np.ptp(numbers[np.isfinite(numbers)]) > 0.0}


def _date_columns(name: str, texts: list[str]) -> dict[str, np.ndarray]:
    """Return the parts of dates that stand in the texts, NaN where there is none; nothing without any date."""
    dates = [_date(text) for text in texts]
    if not any(dates):
        return {}
    start = datetime(1970, 1, 1)
    found = {f"{part} of {name}": _numbers([getattr(date, part) if date else None for date in dates]) for part in PARTS}
    return found | {
        f"day of the week of {name}": _numbers([date.weekday() if date else None for date in dates]),
        f"time of {name}": _numbers([(date - start).total_seconds() if date else None for date in dates]),
    }


def _date(text: str) -> datetime | None:
    seen = DATE.search(text)
    try:
        return datetime.fromisoformat(seen.group()) if seen else None
    except ValueError:
        return None


def _numbers(values: list[float | None]) -> np.ndarray:
    return np.array([np.nan if value is None else value for value in values], dtype=np.float64)
