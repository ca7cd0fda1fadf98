"""Predictions judged on the test records of a set, with limits over gearboxes, beside the classifiers of a training.

Scores of predictions as rows: for reading, and as a table for further use.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa

from diagnostics.judging.judgement import TITLES
from diagnostics.records.record_classes import STATE, check_dataset
from diagnostics.scoring.prediction_file import (
    CLASSIFIER,
    baselines_beside,
    baselines_file,
    by_classifier,
    check_classes,
    check_identity,
    matched_columns,
    named_kind,
    prediction_table,
)
from diagnostics.scoring.score_rows import ScoreRow, score_figure
from diagnostics.scoring.task import Measure, Task
from diagnostics.scoring.tasks import TASKS, truth_of
from diagnostics.scoring.truth import Truth
from diagnostics.statistics.evaluation import (
    FEWEST_THAT_AGREE,
    RESAMPLES,
    UNDEFINED,
    area_interval,
    bootstrap_weights,
    interval,
)
from diagnostics.statistics.indicator_statistics import LARGEST_BLOCK
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError, counted
from siggen.plain_json import plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

YOURS, TEST = "yours", "test"
Answers = dict[str, np.ndarray]


@dataclass(frozen=True, slots=True)
class Scores:
    """Scores of predictions on a split; `print` shows a table.

    Attributes
    ----------
    set_name, identity, split : str
        Which records; scores of sets with different identities are not comparable.
    records, gearboxes : int
    rows : tuple of ScoreRow
    classes : str
        What a class is: `state` or `fault`; empty in sets of lives, which have none.
    simulation_version : int
        Of the set; 0 where it says none.
    """

    set_name: str
    identity: str
    split: str
    records: int
    gearboxes: int
    rows: tuple[ScoreRow, ...]
    classes: str = STATE
    simulation_version: int = 0

    def to_table(self) -> pa.Table:
        """Return one row per score: task, measure, records, name, score, low, high, chance, difference with limits."""
        return pa.Table.from_pylist([self._entry(row) for row in self.rows])

    def numbers(self) -> list[dict[str, object]]:
        """Return the same for JSON, undefined as None."""
        rows: list[dict[str, object]] = plain([self._entry(row) for row in self.rows])
        return rows

    def to_frame(self) -> Any:
        """Return the same as a pandas data frame.

        Raises
        ------
        UsageError
            If pandas is missing, which nothing else here needs.
        """
        if find_spec("pandas") is None:
            raise UsageError("to_frame needs pandas (pip install pandas); to_table has the same rows without it")
        return self.to_table().to_pandas()

    def plot(self) -> Figure:
        """Return a figure with every score, its limits and chance; needs matplotlib."""
        return score_figure(self.rows)

    def _entry(self, row: ScoreRow) -> dict[str, object]:
        apart = row.difference or UNDEFINED
        return {
            "set": self.set_name, "identity": self.identity, "simulation_version": self.simulation_version,
            "split": self.split, "classes": self.classes,
            "task": row.task, "measure": row.measure, "records": row.records, "name": row.name,
            "score": row.score.value, "low": row.score.low, "high": row.score.high, "chance": row.chance,
            "difference": apart.value, "difference_low": apart.low, "difference_high": apart.high,
        }  # fmt: skip

    def __str__(self) -> str:
        """Return the table as text, a block for every task, measure and part of the records."""
        head = (
            f"{self.set_name} ({self.identity[:12]}), {self.split}: {counted(self.records, 'record')} of "
            f"{counted(self.gearboxes, 'gearbox', 'gearboxes')}; "
            f"{f'classes are {self.classes}s; ' if self.classes else ''}limits of 95 % over gearboxes"
        )
        lines, block, first = [head], "", self.rows[0].name
        width = max(len(TITLES.get(row.name, row.name)) for row in self.rows)
        for row in self.rows:
            better = ", less is better" if row.falls else ""
            title = f"{row.task}: {row.measure}, {row.records} (chance {row.chance:.2f}{better})"
            if title != block:
                lines += ["", title]
                block = title
            difference = f"   {first} minus this {row.difference:+.3f}" if row.difference else ""
            lines.append(f"  {TITLES.get(row.name, row.name):{width}}  {row.score:.3f}{difference}")
        if self.gearboxes < FEWEST_THAT_AGREE:
            few = counted(self.gearboxes, "gearbox", "gearboxes")
            lines += ["", f"{few}: too few to tell classifiers apart; that takes {FEWEST_THAT_AGREE}"]
        return "\n".join([*lines, "", self.verdict])

    @property
    def verdict(self) -> str:
        """What the first score means in one line: against chance, and against the best other classifier."""
        own, *others = self.rows
        sign = -1.0 if own.falls else 1.0

        def side(low: float, high: float) -> str:
            """Return on which side of 0 both limits lie; undefined ones tell nothing, nor do those of few gearboxes."""
            if self.gearboxes < FEWEST_THAT_AGREE:
                return "not told from"
            low, high = sorted((sign * low, sign * high))
            return "better than" if low > 0.0 else "worse than" if high < 0.0 else "not told from"

        against = side(own.score.low - own.chance, own.score.high - own.chance)
        text = f"{own.name}: {own.measure} {own.score.value:.2f} ({own.records}) is {against} chance ({own.chance:.2f})"
        others = [row for row in others if (row.task, row.measure, row.records) == (own.task, own.measure, own.records)]
        if not others:
            return f"{text}."
        best = max(others, key=lambda row: sign * row.score.value)
        apart = best.difference or UNDEFINED
        beside = side(apart.low, apart.high)
        return f"{text}, and {beside} {TITLES.get(best.name, best.name)} ({best.score.value:.2f}), the best other."


def score(
    dataset: Dataset,
    predictions: Any,
    *,
    baselines: str | Path | None = None,
    split: str = TEST,
    seed: int = 0,
    classes: str | None = None,
) -> Scores:
    """Judge predictions for a split by every task that their columns answer.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    predictions : path, mapping of str to (n,), pyarrow table or data frame
        `record_id` and the columns of a task. `damage`: a number that rises with damage. `p_<class>` for every class:
        probabilities; `class`: its name. `gear` and `tooth`: where the damage is. `area_mm2`: how large it is.
        `rul_h`, `rul_q10_h`, `rul_q90_h`: remaining life. `confidence`: which records are answered first.
        A column `classifier` sets several apart. Records of other splits are left out.
    baselines : path, optional
        Folder that `siggen-diagnostics report` wrote for this set: its classifiers are judged on the same
        records, and the differences of the first predictions from each of them. Default: SET_report or SET_models
        beside the set, if there is one.
    split : str
        `test`, or `validation` to choose by.
    seed : int
        Of the resampled gearboxes; 0 gives the numbers of the report.
    classes : str, optional
        What a class is: `state`, or primary `fault`; healthy ones are one class. Default: what the columns name.

    Returns
    -------
    Scores
        Rows of value, 95 % limits over gearboxes, chance and paired difference; `print` shows them as a table.

    Raises
    ------
    UsageError
        If records are missing, come twice or are unknown, or values cannot be; all of it in one message.
    """
    check_dataset(dataset, "score")
    table, identity = prediction_table(predictions), str(dataset.manifest["identity"])
    truth = truth_of(dataset, split, classes or named_kind(table, dataset))
    where = predictions if isinstance(predictions, str | Path) else "predictions"
    columns = _by_classifier(table, truth, identity, where, YOURS)
    first = next(iter(columns))
    file = baselines_beside(dataset) if baselines is None else baselines_file(Path(baselines))
    if file is not None:
        others = _by_classifier(prediction_table(file), truth, identity, file, file.parent.name)
        columns |= {name: found for name, found in others.items() if name not in columns}
    return scores_of(dataset, truth, columns, first, seed)


def scores_of(dataset: Dataset, truth: Truth, columns: dict[str, Answers], first: str, seed: int) -> Scores:
    """Return the scores of checked columns by name, and the differences of the first from all others.

    Raises
    ------
    UsageError
        If the columns of the first answer no task.
    """
    resamples = min(RESAMPLES, max(50, LARGEST_BLOCK // truth.record_id.size))
    weights = bootstrap_weights(truth.specimen, seed, resamples)
    rows = tuple(row for task in TASKS for row in _task_rows(task, columns, first, truth, weights))
    if not rows:
        raise UsageError(
            f"{dataset.path}: the split {truth.split} has {counted(truth.record_id.size, 'record')} of "
            f"{counted(truth.gearboxes, 'gearbox', 'gearboxes')}, which these columns tell nothing apart in; needed "
            "are two gearboxes or more with damage, and as many without. Judge another split, or add "
            "gearboxes: the same `siggen generate` with `--set specimens=N`"
        )
    return Scores(
        set_name=dataset.path.name,
        identity=str(dataset.manifest["identity"]),
        split=truth.split,
        records=truth.record_id.size,
        gearboxes=truth.gearboxes,
        rows=rows,
        classes=truth.told.kind if truth.told else "",
        simulation_version=int(dataset.manifest.get("simulation_version", 0)),
    )


def _by_classifier(table: pa.Table, truth: Truth, identity: str, where: Any, name: str) -> dict[str, Answers]:
    """Return the checked columns of every classifier of a table; of the only one under the given name."""
    check_identity(table, identity, where)
    if truth.told:
        check_classes(table, truth.told.kind, where)
    said = f"{where}, {{}}" if CLASSIFIER in table.column_names else str(where)
    parts = by_classifier(table, name)
    return {own: matched_columns(part, truth, said.format(own)) for own, part in parts.items()}


def _task_rows(
    task: Task, columns: dict[str, Answers], first: str, truth: Truth, weights: np.ndarray
) -> Iterator[ScoreRow]:
    """Yield the rows of a task that the first predictions answer, by measure and part, beside all others."""
    answers = {name: task.answers(found, truth) for name, found in columns.items()}
    for part, chosen in task.parts(truth).items():
        rows, drawn = truth.rows(chosen), weights[:, chosen]
        for measure in task.measures:
            samples = {
                name: measure.samples(found[chosen], rows, drawn)
                for name, found in answers.items()
                if found is not None and not (measure.ranks and _names_alone(found))
            }
            samples = {name: found for name, found in samples.items() if np.isfinite(found[0])}
            if first not in samples:  # a question that the predictions do not answer
                continue
            for name, found in samples.items():
                own = samples.get(first) if name != first else None
                yield _row(task, measure, part, rows, name, found, own)


def _names_alone(answers: np.ndarray) -> bool:
    """Return whether answers are names of classes, 1 for one and 0 for all others."""
    return answers.ndim == 2 and bool(np.isin(answers, (0.0, 1.0)).all())


def _row(
    task: Task, measure: Measure, part: str, truth: Truth, name: str, samples: np.ndarray, own: np.ndarray | None
) -> ScoreRow:
    return ScoreRow(
        task=task.name,
        measure=measure.name,
        records=part,
        name=name,
        score=(area_interval if measure.is_share else interval)(samples, measure.gearboxes(truth)),
        chance=measure.chance(truth),
        difference=None if own is None else interval(own - samples, truth.gearboxes),
        falls=measure.falls,
    )
