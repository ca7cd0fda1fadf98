"""Scores of the user's own predictions in the report, beside those of the classifiers that were trained."""

from __future__ import annotations

from diagnostics.judging.judgement import TITLES
from diagnostics.page.html import Cell, paragraph, table
from diagnostics.page.tables import interval_cell
from diagnostics.page.wording import capitalised, counted
from diagnostics.scoring.score import Scores


def your_scores(scores: Scores | None) -> list[str]:
    """Return a sentence and the table; nothing without predictions."""
    if scores is None:
        return []
    first = scores.rows[0].name
    rows = [
        [
            Cell(f"{row.task}: {row.measure}"),
            Cell(row.records),
            Cell(TITLES.get(row.name, row.name)),
            interval_cell(row.score),
            Cell(f"{row.chance:.2f}", value=row.chance),
            interval_cell(row.difference, sign=True) if row.difference else Cell("\N{EN DASH}"),
            Cell("less" if row.falls else "more"),
        ]
        for row in scores.rows
    ]
    head = ["Task", "Records", "Whose", "Score", "Chance", f"{capitalised(first)} minus this", "Better"]
    text = (
        f"Your predictions were judged on {counted(scores.records, 'record')} of "
        f"{counted(scores.gearboxes, 'gearbox')} of the split {scores.split}, beside the classifiers of this "
        "report. Differences are paired on the same resampled gearboxes, with 95 % limits."
    )
    return [
        paragraph(text),
        table(head, rows, caption="Scores of the tasks that the predictions answer.", sortable=True),
    ]
