"""A task: which columns of predictions answer a question, of which records, by which measures, and what chance gives.

Each task is a small definition in a file of its own. Values and limits are those of report and `metrics.json`: the same
areas, resampled gearboxes and widened limits.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from operator import attrgetter

import numpy as np
import pyarrow as pa

from diagnostics.scoring.truth import Truth
from siggen.dataset.reading import Dataset

Columns = Mapping[str, np.ndarray]
Problem = tuple[str, np.ndarray, str]
"""What is wrong, in which records (n,) bool, and what is allowed."""


@dataclass(frozen=True, slots=True)
class Taken:
    """A column of predictions: numbers between two limits, or names that stand for positions.

    Attributes
    ----------
    name, allowed : str
        `allowed` is for messages.
    low, high : float
    whole : bool
        Whether numbers must be whole.
    places : mapping of str to int, optional
        Names and their positions, for a column of names.
    """

    name: str
    allowed: str = "finite numbers"
    low: float = -np.inf
    high: float = np.inf
    whole: bool = False
    places: Mapping[str, int] | None = None

    def read(self, column: pa.ChunkedArray) -> tuple[np.ndarray, list[tuple[str, np.ndarray]]]:
        """Return the values (n,), of names their positions, and what cannot be: in words, and in which records."""
        if self.places is not None:
            return self._positions(column.to_pylist(), self.places)
        rows = len(column)
        if pa.types.is_null(column.type):  # what a CSV file with no number in the column is read as
            return np.zeros(rows), [("is nan", np.ones(rows, dtype=bool))]
        if not (pa.types.is_integer(column.type) or pa.types.is_floating(column.type)):
            return np.zeros(rows), [(f"holds {column.type}", np.ones(rows, dtype=bool))]
        values = np.asarray(column.to_numpy(zero_copy_only=False), dtype=np.float64)
        bad = ~np.isfinite(values) | (values < self.low) | (values > self.high)
        if self.whole:
            bad |= values != np.rint(values)
        return values, [(f"is {values[bad][0]:g}", bad)] if bad.any() else []

    @staticmethod
    def _positions(names: list[object], places: Mapping[str, int]) -> tuple[np.ndarray, list[tuple[str, np.ndarray]]]:
        found = np.array([places.get(str(name), -1) for name in names], dtype=np.int64)
        if not (found < 0).any():
            return found, []
        first = next(name for name, number in zip(names, found.tolist(), strict=True) if number < 0)
        return found, [(f"is {str(first)[:60]!r}", found < 0)]


@dataclass(frozen=True, slots=True)
class Measure:
    """How answers become a score.

    Attributes
    ----------
    name : str
    samples : callable
        Answers of n records, their truth and weights (b, n); returns the score for every row of weights, (b,).
    chance : callable
        What an answer without knowledge reaches.
    gearboxes : callable
        How many gearboxes the limits count; all unless told.
    ranks : bool
        Whether it orders records by their numbers, which names of classes alone do not allow.
    is_share : bool
        Whether it is an area or a share, whose limits are widened at 0 and 1.
    falls : bool
        Whether less is better.
    """

    name: str
    samples: Callable[[np.ndarray, Truth, np.ndarray], np.ndarray]
    chance: Callable[[Truth], float]
    gearboxes: Callable[[Truth], int] = attrgetter("gearboxes")
    ranks: bool = False
    is_share: bool = True
    falls: bool = False


@dataclass(frozen=True, slots=True)
class Task:
    """One question to predictions.

    Attributes
    ----------
    name : str
    takes : str
        The columns that answer it, for messages.
    columns : callable
        These columns for a set.
    answers : callable
        Columns of n records and their truth; returns (n,) or (n, k), None where no column answers.
    parts : callable
        Which records are judged, (n,) bool by what they are called; the first are all. None where a set cannot ask.
    measures : tuple of Measure
    facts : callable
        What is true of n records that the task asks for, (n,) by name.
    problems : callable
        What is wrong with columns together.
    """

    name: str
    takes: str
    columns: Callable[[Truth], tuple[Taken, ...]]
    answers: Callable[[Columns, Truth], np.ndarray | None]
    parts: Callable[[Truth], dict[str, np.ndarray]]
    measures: tuple[Measure, ...]
    facts: Callable[[Dataset, Truth], dict[str, np.ndarray]] = lambda _dataset, _truth: {}
    problems: Callable[[Columns, Truth], Iterator[Problem]] = lambda _columns, _truth: iter(())


def weighted_mean(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the mean of values (n,) for every row of weights (b, n), (b,); NaN without any weight."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(weights @ values / weights.sum(axis=1))


def every_record(truth: Truth) -> dict[str, np.ndarray]:
    """Return all records as the part `all`; none where they are of one class."""
    return {"all": np.ones(truth.label.size, dtype=bool)} if np.unique(truth.label).size > 1 else {}


def error_of_one_number(values: np.ndarray) -> float:
    """Return the mean error of the one number that is best for all values (n,): their median."""
    return float(np.abs(values - np.median(values)).mean())


def by_record(table: pa.Table, name: str, truth: Truth) -> np.ndarray:
    """Return a column of a table by the numbers of records, (n,) float64; NaN where it says nothing of one."""
    of_record = dict(zip(*(table.column(one).to_pylist() for one in ("record_id", name)), strict=True))
    found = (of_record.get(record) for record in truth.record_id.tolist())
    return np.array([np.nan if one is None else one for one in found], dtype=np.float64)
