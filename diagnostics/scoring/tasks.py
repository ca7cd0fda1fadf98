"""The tasks that predictions can be judged by, and what is true of records for all of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnostics.records.record_classes import STATE
from diagnostics.scoring.abstain import ABSTAIN
from diagnostics.scoring.detect import DETECT
from diagnostics.scoring.grade import GRADE
from diagnostics.scoring.locate import LOCATE
from diagnostics.scoring.remaining_life import REMAINING_LIFE, RUL
from diagnostics.scoring.size import SIZE
from diagnostics.scoring.task import Task
from diagnostics.scoring.truth import Truth, judged_records
from siggen.dataset.reading import Dataset

TASKS: tuple[Task, ...] = (DETECT, GRADE, LOCATE, SIZE, REMAINING_LIFE, ABSTAIN)


def truth_of(dataset: Dataset, split: str, kind: str = STATE) -> Truth:
    """Return what is true of the records of a split; `kind` says what a class is, `state` or `fault`.

    Of a set of lives these are the inspections whose remaining life is known.

    Raises
    ------
    UsageError
        If the split has no records, or the kind is unknown.
    """
    found = judged_records(dataset, split, kind)
    gears = dataset.columns_of("teeth")
    table = dataset.labels(split, list(gears.values()))
    found = replace(found, gears={gear: np.asarray(table.column(name).to_pylist()) for gear, name in gears.items()})
    facts = {name: values for task in TASKS for name, values in task.facts(dataset, found).items()}
    found = replace(found, facts=facts)
    if RUL not in facts:
        return found
    known = np.isfinite(facts[RUL])
    return replace(found.rows(known), elsewhere=np.concatenate([found.elsewhere, found.record_id[~known]]))
