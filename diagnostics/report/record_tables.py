"""What classifiers say of test records: confusion matrices, and records named wrongly, with links to the explorer."""

from __future__ import annotations

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.page.explorer_link import explorer_link
from diagnostics.page.html import Cell, table
from diagnostics.page.wording import capitalised, counted
from diagnostics.records.state_classes import CLASS
from diagnostics.statistics.judgement import TITLES, Judged
from diagnostics.training.training import Training

MOST_RECORDS = 100
"""Rows of the table of wrongly named records."""


def confusion_table(judged: Judged, explorer: str = "") -> str:
    """Return the confusion matrix of one classifier: counts of the test records, shaded by share of the true state.

    Parameters
    ----------
    judged : Judged
    explorer : str
        Page to explore with the predictions of this classifier; its records are behind every count.
    """
    classes, counts = judged.scores.classes, judged.scores.confusion
    share = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
    rows = [
        [
            Cell(true),
            *(_count(explorer, true, classes[k], int(counts[row, k]), share[row, k]) for k in range(len(classes))),
        ]
        for row, true in enumerate(classes)
    ]
    caption = (
        f"{capitalised(TITLES[judged.name])}: true state in rows, named state in columns; test records, and their "
        f"share of the true state.{' A count leads to its records.' if explorer else ''}"
    )
    return table(["True state", *classes], rows, caption=caption)


def _count(explorer: str, true: str, named: str, count: int, share: float) -> Cell:
    link = explorer_link(explorer, split="test", **{"class": true}, predicted=named) if count else ""
    hint = f"records of {true} that are named {named}" if link else ""
    return Cell(str(count), f"{share:.0%}" if count else "", float(count), link, hint, float(share))


def wrong_records_table(training: Training, matrix: FeatureMatrix, explorer: str = "") -> str:
    """Return the test records that some classifier names wrongly, with what each says; nothing where none does."""
    labels = matrix.rows(training.split.test).labels
    said = {found.name: np.array(found.predictions.classes)[found.predictions.predicted] for found in training.judged}
    wrong = np.stack([names != labels[CLASS] for names in said.values()])
    rows = np.flatnonzero(wrong.any(axis=0))
    if not rows.size:
        return ""
    order = rows[np.argsort(-wrong[:, rows].sum(axis=0), kind="stable")][:MOST_RECORDS]
    head = ["Record", "Gearbox", "Area [mm²]", "True state", *(capitalised(TITLES[name]) for name in said)]
    left = f" The first {MOST_RECORDS} are shown." if rows.size > MOST_RECORDS else ""
    caption = (
        f"{counted(int(rows.size), 'test record')} of {labels[CLASS].size} that some classifier names wrongly "
        f"(shaded), those that most name wrongly first.{left}"
    )
    return table(
        head, [_record(labels, row, said, explorer) for row in order], caption=caption, sortable=True, tall=True
    )


def _record(labels: dict[str, np.ndarray], row: int, said: dict[str, np.ndarray], explorer: str) -> list[Cell]:
    number, area = int(labels["record_id"][row]), float(labels["damaged_area_mm2"][row])
    link = explorer_link(explorer, record=number)
    return [
        Cell(str(number), value=float(number), link=link, hint="open in the explorer" if link else ""),
        Cell(str(labels["specimen_id"][row]), value=float(labels["specimen_id"][row])),
        Cell(f"{area:.3g}", value=area),
        Cell(str(labels[CLASS][row])),
        *(Cell(str(names[row]), shade=0.3 if names[row] != labels[CLASS][row] else None) for names in said.values()),
    ]
