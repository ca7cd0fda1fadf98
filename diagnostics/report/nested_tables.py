"""What nested folds say on a report: scores over all gearboxes, what is taken for what, and classes never shown."""

from __future__ import annotations

from diagnostics.judging.nested_folds import KNOWN_ACCEPTED, Nested, Stranger
from diagnostics.page.html import Cell, paragraph, table
from diagnostics.page.wording import counted, decimal, joined
from diagnostics.records.record_classes import STATE
from diagnostics.report.confusion import confusion_table

MOST_NAMES = 3
"""Names shown of what a class that training lacked is called."""


def nested_blocks(found: Nested | None, kind: str = STATE) -> list[str]:
    """Return the blocks; nothing where the set has too few gearboxes for folds."""
    if found is None:
        return []
    area, scores = found.scores.macro_auroc, found.scores
    sentence = (
        f"Judged on all {counted(scores.specimens, 'gearbox')} by {found.folds} nested folds, logistic "
        f"regression on indicators reaches a macro-AUROC of {decimal(area.value)} ({decimal(area.low)} to "
        f"{decimal(area.high)})."
    )
    matrix = confusion_table(scores, "Nested folds over all gearboxes", "records of all gearboxes", kind=kind)
    return [paragraph(sentence), matrix, *([_strangers(found.strangers)] if found.strangers else [])]


def _strangers(found: tuple[Stranger, ...]) -> str:
    rows = [
        [
            Cell(one.name),
            Cell(str(one.records), value=float(one.records)),
            Cell(f"{one.rejected:.0%}", value=one.rejected),
            Cell(joined([f"{name} {share:.0%}" for name, share in list(one.called.items())[:MOST_NAMES]]) or "–"),
        ]
        for one in found
    ]
    caption = (
        "Each class left out of training in turn, and its records judged. A record is something else where the largest "
        f"probability is below what {KNOWN_ACCEPTED:.0%} of known records exceed. The last column has the names most "
        "often given instead."
    )
    return table(["Class that training lacks", "Records", "Called something else", "Called"], rows, caption=caption)
