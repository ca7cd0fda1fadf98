"""Predictions judged on all test parts of a benchmark that they have rows for; everything wrong in one list."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.records.record_classes import set_classes
from diagnostics.records.state_classes import CLASS
from diagnostics.scoring.abstain import CONFIDENCE
from diagnostics.scoring.benchmark import BASELINES, PER_PART, Benchmark, SealedLabels, labelled, labels_of
from diagnostics.scoring.detect import DAMAGE
from diagnostics.scoring.grade import PROBABILITY
from diagnostics.scoring.prediction_file import (
    RECORD,
    baselines_file,
    by_classifier,
    check_identity,
    checked_columns,
    prediction_table,
    refusal,
)
from diagnostics.scoring.score import TEST, YOURS, Answers, Scores, scores_of
from diagnostics.scoring.tasks import truth_of
from diagnostics.scoring.truth import Truth, is_lives
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError


@dataclass(frozen=True, slots=True)
class JudgedPart:
    """A test part with its labels: the set, what is true of it, and the classes that can be learned."""

    name: str
    dataset: Dataset
    truth: Truth
    learned: tuple[str, ...]

    def rows(self, table: pa.Table, place: int) -> pa.Table:
        """Return the rows of predictions that are of this part, by the numbers of their records."""
        numbers = table.column(RECORD)
        first = (place + 1) * PER_PART
        inside = pc.and_(pc.greater_equal(numbers, first), pc.less(numbers, first + PER_PART))
        return self._asked(table.filter(inside))

    def _asked(self, table: pa.Table) -> pa.Table:
        """Return columns that the part asks for: of faults that nobody could learn, no probabilities of classes."""
        if set(self.truth.classes) == set(self.learned):
            return table
        healthy = f"{PROBABILITY}{self.truth.healthy}"
        if DAMAGE not in table.column_names and healthy in table.column_names:
            table = table.append_column(DAMAGE, pc.subtract(1.0, table.column(healthy)))
        left_out = (CLASS, CONFIDENCE, *(name for name in table.column_names if name.startswith(PROBABILITY)))
        return table.drop_columns([name for name in left_out if name in table.column_names])


@dataclass(frozen=True, slots=True)
class BenchmarkScores:
    """Scores by test part; `print` shows a table for each."""

    benchmark: Benchmark
    parts: tuple[Scores, ...]

    def to_table(self) -> pa.Table:
        """Return the rows of all parts, with the benchmark's digest."""
        table = pa.concat_tables([scores.to_table() for scores in self.parts])
        return table.append_column("digest", pa.array([self.benchmark.digest] * table.num_rows))

    def numbers(self) -> list[dict[str, object]]:
        """Return the same for JSON."""
        return [{**row, "digest": self.benchmark.digest} for scores in self.parts for row in scores.numbers()]

    def __str__(self) -> str:
        """Return the tables as text."""
        return "\n\n".join([str(self.benchmark), *map(str, self.parts)])


def judged_parts(benchmark: Benchmark, labels: SealedLabels) -> tuple[JudgedPart, ...]:
    """Return all test parts with their labels."""
    learn = benchmark.learn()
    learned = () if is_lives(learn) else set_classes(learn).names
    found = []
    for name in benchmark.parts:
        dataset = labelled(benchmark.part(name), labels, name)
        found.append(JudgedPart(name, dataset, truth_of(dataset, TEST), learned))
    return tuple(found)


def score_benchmark(
    benchmark: Benchmark,
    predictions: Any,
    *,
    labels: str | Path | None = None,
    baselines: str | Path | None = None,
    seed: int = 0,
) -> BenchmarkScores:
    """Judge predictions on every test part that they have rows for.

    Parameters
    ----------
    benchmark : Benchmark
        What `open_benchmark` returned.
    predictions : path, mapping of str to (n,), pyarrow table or data frame
        As of `diagnostics.score`, for the records of one or several parts.
    labels : path, optional
        Sealed labels; by default those revealed, else those of the maker beside it.
    baselines : path, optional
        Folder with predictions to be judged beside them; default that of the benchmark, if it has one.
    seed : int
        Of the resampled gearboxes.

    Raises
    ------
    UsageError
        If there are no labels, predictions are of another benchmark, or anything is wrong with them; all in one list.
    """
    parts = judged_parts(benchmark, labels_of(benchmark, Path(labels) if labels else None))
    where = predictions if isinstance(predictions, str | Path) else "predictions"
    columns = part_columns(benchmark, parts, prediction_table(predictions), where, YOURS)
    folder = Path(baselines) if baselines else benchmark.path / BASELINES
    file = baselines_file(folder) if baselines or folder.is_dir() else None
    beside = part_columns(benchmark, parts, prediction_table(file), file, folder.name) if file else {}
    first = next(iter(next(iter(columns.values()))))
    scored = [
        scores_of(part.dataset, part.truth, {**columns[part.name], **beside.get(part.name, {})}, first, seed)
        for part in parts
        if part.name in columns
    ]
    return BenchmarkScores(benchmark, tuple(scored))


def part_columns(
    benchmark: Benchmark, parts: Sequence[JudgedPart], table: pa.Table, where: Any, name: str
) -> dict[str, dict[str, Answers]]:
    """Return the checked columns of every classifier, by part; parts without a row are left out.

    Raises
    ------
    UsageError
        As of `score_benchmark`.
    """
    check_identity(table, benchmark.digest, where)
    problems, found = _strangers(table, parts), dict[str, dict[str, Answers]]()
    for own, rows in {} if problems else by_classifier(table, name).items():
        for place, part in enumerate(parts):
            asked = part.rows(rows, place)
            if asked.num_rows:
                columns, wrong = checked_columns(asked, part.truth)
                problems += [f"{part.name}: {problem}" for problem in wrong]
                found.setdefault(part.name, {})[own] = columns
    if problems:
        raise UsageError(refusal(where, problems, parts[0].truth))
    return found


def _strangers(table: pa.Table, parts: Sequence[JudgedPart]) -> list[str]:
    """Return what is wrong with numbers of records before they are told apart by part."""
    if RECORD not in table.column_names:
        return [f"no column {RECORD}; received {', '.join(table.column_names) or 'no columns'}"]
    column = table.column(RECORD)
    if not pa.types.is_integer(column.type) or column.null_count:
        return [f"{RECORD} holds {column.type}; allowed: integers without gaps"]
    place = column.to_numpy(zero_copy_only=False) // PER_PART
    outside = (place < 1) | (place > len(parts))
    names = ", ".join(f"{part.name} from {(k + 1) * PER_PART}" for k, part in enumerate(parts))
    if not outside.any() and place.size:
        return []
    first = column.to_numpy(zero_copy_only=False)[outside][:5].tolist()
    return [f"{int(np.count_nonzero(outside))} records of no test part: {RECORD} {first}; numbers begin: {names}"]
