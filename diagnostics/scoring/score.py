"""Predictions judged on the test records of a set, with limits over gearboxes, beside the classifiers of a training."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.scoring.matched_columns import matched_columns
from diagnostics.scoring.prediction_file import CLASSIFIER, baselines_file, check_identity, prediction_table
from diagnostics.scoring.score_table import Scored, ScoreRow
from diagnostics.scoring.tasks import TASKS, Measure, Task
from diagnostics.scoring.truth import Truth, truth_of
from diagnostics.statistics.area_interval import area_interval
from diagnostics.statistics.evaluation import RESAMPLES, bootstrap_weights, interval
from diagnostics.statistics.judged_records import LARGEST_BLOCK
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

YOURS, TEST = "yours", "test"
Answers = dict[str, np.ndarray]


def score(
    dataset: Dataset, predictions: Any, *, baselines: str | Path | None = None, split: str = TEST, seed: int = 0
) -> Scored:
    """Judge predictions for the records of a split by every task that their columns answer.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    predictions : path, mapping of str to (n,), pyarrow table or data frame
        `record_id` and the columns of a task. `damage`: a number that rises with damage. `p_<class>` for every class:
        probabilities; `class`: its name. A column `classifier` sets several apart. Records of other splits are left
        out.
    baselines : path, optional
        Folder that `siggen-diagnostics report` wrote for this set: its classifiers are judged on the same
        records, and the differences of the first predictions from each of them.
    split : str
        `test`, or `validation` to choose by.
    seed : int
        Of the resampled gearboxes; 0 gives the numbers of the report.

    Returns
    -------
    Scored
        Rows of value, 95 % limits over gearboxes, chance and paired difference; `print` shows them as a table.

    Raises
    ------
    UsageError
        If records are missing, come twice or are unknown, or values cannot be; all of it in one message.
    """
    truth, identity = truth_of(dataset, split), str(dataset.manifest["identity"])
    where = predictions if isinstance(predictions, str | Path) else "predictions"
    columns = _by_classifier(prediction_table(predictions), truth, identity, where, YOURS)
    first = next(iter(columns))
    if baselines is not None:
        file = baselines_file(Path(baselines))
        others = _by_classifier(prediction_table(file), truth, identity, file, file.parent.name)
        columns |= {name: found for name, found in others.items() if name not in columns}
    resamples = min(RESAMPLES, max(50, LARGEST_BLOCK // truth.record_id.size))
    weights = bootstrap_weights(truth.specimen, seed, resamples)
    rows = [row for task in TASKS for row in _task_rows(task, columns, first, truth, weights)]
    if not rows:
        raise UsageError(f"{dataset.path}: the split {split} has a single class, so there is nothing to tell apart")
    return Scored(dataset.path.name, identity, split, truth.record_id.size, truth.gearboxes, tuple(rows))


def _by_classifier(table: pa.Table, truth: Truth, identity: str, where: Any, name: str) -> dict[str, Answers]:
    """Return the checked columns of every classifier of a table; of the only one under the given name."""
    check_identity(table, identity, where)
    if CLASSIFIER not in table.column_names:
        return {name: matched_columns(table, truth, where)}
    names = [str(found) for found in pc.unique(table.column(CLASSIFIER)).to_pylist()]
    parts = {found: table.filter(pc.equal(table.column(CLASSIFIER), found)) for found in names}
    return {found: matched_columns(part, truth, f"{where}, {found}") for found, part in parts.items()}


def _task_rows(
    task: Task, columns: dict[str, Answers], first: str, truth: Truth, weights: np.ndarray
) -> Iterator[ScoreRow]:
    """Yield the rows of a task: by measure and part, first the predictions, then the others with their differences."""
    answers = {name: task.answers(found, truth) for name, found in columns.items()}
    for part, chosen in task.parts(truth).items():
        rows, drawn = truth.rows(chosen), weights[:, chosen]
        for measure in task.measures:
            samples = {
                name: measure.samples(found[chosen], rows, drawn)
                for name, found in answers.items()
                if found is not None and not (measure.ranks and _names_alone(found))
            }
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
        score=area_interval(samples, measure.gearboxes(truth)),
        chance=measure.chance(truth),
        difference=None if own is None else interval(own - samples, truth.gearboxes),
    )
