"""Confusion matrices as tables: counts of records, shaded by their share of the true state."""

from __future__ import annotations

import numpy as np

from diagnostics.page.html import Cell, table
from diagnostics.page.tables import records_link
from diagnostics.page.wording import capitalised
from diagnostics.records.record_classes import STATE
from diagnostics.statistics.scores import IntervalScores


def confusion_table(
    scores: IntervalScores, title: str, records: str = "test records", kind: str = STATE, *, linked: bool = False
) -> str:
    """Return the confusion matrix of one classifier.

    Parameters
    ----------
    scores : Scores
    title : str
        Of the classifier.
    records : str
        Which records are counted.
    kind : str
        What a class is: `state` or `fault`.
    linked : bool
        Whether the page shows the predictions of this classifier, so that a count leads to its records.
    """
    classes, counts = scores.classes, scores.confusion
    share = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
    rows = [
        [
            Cell(true),
            *(_count(true, classes[k], int(counts[row, k]), share[row, k], linked=linked) for k in range(len(classes))),
        ]
        for row, true in enumerate(classes)
    ]
    caption = (
        f"{capitalised(title)}: true {kind} in rows, named {kind} in columns; {records}, and their "
        f"share of the true {kind}.{' A count leads to its records.' if linked else ''}"
    )
    return table([f"True {kind}", *classes], rows, caption=caption)


def _count(true: str, named: str, count: int, share: float, *, linked: bool) -> Cell:
    link = records_link(split="test", **{"class": true}, predicted=named) if count and linked else ""
    hint = f"records of {true} that are named {named}" if link else ""
    return Cell(str(count), f"{share:.0%}" if count else "", float(count), link, hint, float(share))
