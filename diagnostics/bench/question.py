"""What a benchmark asks, and what follows from it: what parts show, which tables go along, by what entries are ranked.

Making, digest, seals and scores know no question. A further one is a further `Question`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pyarrow as pa

from diagnostics.scoring.benchmark import Benchmark
from diagnostics.scoring.task import Measure, Task
from siggen.dataset.reading import Dataset


@dataclass(frozen=True, slots=True)
class PublishedRecords:
    """Which records of a simulated part are published, by their number there.

    Attributes
    ----------
    state_id : mapping of int to int
        What is published as the state's number of each; other records are not published.
    told : frozenset of int
        Records that are told to be healthy.
    asked : frozenset of int
        Those of the split test.
    """

    state_id: Mapping[int, int]
    told: frozenset[int]
    asked: frozenset[int]


@dataclass(frozen=True, slots=True)
class Renumbered:
    """New numbers of the published records of a part.

    Attributes
    ----------
    record, gearbox : mapping of int to int
        Number in the simulated set -> number in the part.
    shown : Shown
    """

    record: Mapping[int, int]
    gearbox: Mapping[int, int]
    shown: PublishedRecords

    def split(self, record: int) -> str:
        """Return the split of a record, by its number in the simulated set."""
        return "test" if record in self.shown.asked else "train"


@dataclass(frozen=True, slots=True)
class Ranking:
    """By what entries are ranked: the first measure of a task.

    Attributes
    ----------
    task : Task
    records : str
        Which of the task's parts ranks.
    leak : str or None
        Which of them nobody should tell, so that its AUC holds 0.5; None where there is none.
    name, key : str
        What the score is called on the page, and in JSON.
    said : str
        What the page says that scores are.
    tracks : mapping of bool to str
        Headings of the tables of entries, by whether they used a reference.
    """

    task: Task
    records: str
    leak: str | None
    name: str
    key: str
    said: str
    tracks: Mapping[bool, str]

    @property
    def measure(self) -> Measure:
        """The measure that ranks."""
        return self.task.measures[0]


@dataclass(frozen=True, slots=True)
class Words:
    """What cards say: subject, rules, what the split train of a test part is called, and the card of a test part."""

    subject: str
    rules: str
    train: str
    part: Callable[[str, str, Sequence[Mapping[str, Any]]], str]


@dataclass(frozen=True, slots=True)
class Question:
    """What a benchmark asks.

    Attributes
    ----------
    title : str
    conditions : mapping
        Name of a condition -> what differs from the configuration to learn from.
    parts : callable
        Conditions; returns the same by test part.
    words : Words
    ranking : Ranking
    shown : callable
        Simulated set of a part, secret, name of the part; returns what is published.
    tables : callable
        Simulated set and new numbers; returns the tables of `life/` to publish, and those to seal.
    predictions : callable
        Benchmark, seed, processes; yields what the baselines say of the records asked about.
    """

    title: str
    conditions: Mapping[str, Mapping[str, Any]]
    parts: Callable[[Mapping[str, Mapping[str, Any]]], Mapping[str, Mapping[str, Any]]]
    words: Words
    ranking: Ranking
    shown: Callable[[Dataset, bytes, str], PublishedRecords]
    tables: Callable[[Dataset, Renumbered], tuple[dict[str, pa.Table], dict[str, pa.Table]]]
    predictions: Callable[[Benchmark, int, int], Iterator[pa.Table]]
