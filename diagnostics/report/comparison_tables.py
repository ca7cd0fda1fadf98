"""Tables of a report beside the scores: paired differences, another set."""

from __future__ import annotations

import math

from diagnostics.judging.judgement import TITLES, Judged
from diagnostics.judging.of_split import Referenced, Training
from diagnostics.page.html import Cell, table
from diagnostics.page.tables import interval_cell
from diagnostics.page.wording import counted
from diagnostics.statistics.evaluation import Interval

UNDEFINED = Interval(math.nan, math.nan, math.nan)

FEWEST_SPECIMENS = 6
"""Test specimens from which an interval may decide: with five even a sign test cannot fall below 0.05 (2/32)."""


def comparison_table(training: Training) -> str:
    """Return the paired differences of classifiers, and whether the interval of each, by itself, excludes zero."""
    specimens = training.judged[0].scores.specimens
    rows = [
        [
            Cell(f"{TITLES[pair.first]} − {TITLES[pair.second]}"),
            interval_cell(pair.macro_auroc, sign=True),
            interval_cell(pair.accuracy, sign=True),
            Cell(verdict(pair.macro_auroc, specimens)),
        ]
        for pair in training.comparisons
    ]
    head = ["Paired difference", "Macro-AUROC", "Accuracy", "Interval excludes 0"]
    caption = (
        "Paired differences on the same resampled specimens, with 95 % limits. Where the limits of macro-AUROC include "
        "0, the set does not show which classifier is better. There is no correction for many pairs: about one pair in "
        f"twenty excludes 0 even where no pair differs. The last column needs {FEWEST_SPECIMENS} test gearboxes."
    )
    return table(head, rows, caption=caption, sortable=True)


def verdict(difference: Interval, specimens: int) -> str:
    """Return whether a paired interval excludes zero; resampling a few specimens makes intervals too narrow to say."""
    if specimens < FEWEST_SPECIMENS or not math.isfinite(difference.low):
        return "too few gearboxes"
    return "yes" if difference.low > 0.0 or difference.high < 0.0 else "no"


def other_set_table(training: Training) -> str:
    """Return the scores on another set beside those on the own test specimens."""
    own = {found.name: found for found in training.judged}
    rows = [_other_row(found, own[found.name]) for found in training.other]
    head = ["Classifier", "Macro-AUROC there", "Macro-AUROC here", "Accuracy there", "Accuracy here"]
    there = training.other[0].scores
    caption = (
        f"Scores on the other set, {training.other_name}: {counted(there.records, 'record')} of "
        f"{counted(there.specimens, 'specimen')}. No classifier was trained on it."
    )
    return table([*head, "Calibration error there"], rows, caption=caption, sortable=True)


def referenced_table(found: Referenced) -> str:
    """Return what classifiers reach alone and beside a healthy record of the same gearbox, on the same records."""
    rows = [
        [
            Cell(TITLES[judged.name]),
            interval_cell(judged.scores.macro_auroc),
            interval_cell(judged.scores.accuracy),
            interval_cell(judged.detection.every if judged.detection else UNDEFINED),
        ]
        for judged in found.judged
    ]
    caption = (
        "Alone and beside a healthy record of the same gearbox, on the "
        f"{counted(found.judged[0].scores.records, 'test record')} that have one, with 95 % limits. "
        "A healthy record is never its own reference."
    )
    head = ["Classifier", "Macro-AUROC [-]", "Accuracy [-]", "Damaged or not, AUROC [-]"]
    return table(head, rows, caption=caption, sortable=True)


def referenced_pairs_table(found: Referenced) -> str:
    """Return the paired differences that a healthy record makes."""
    specimens = found.judged[0].scores.specimens
    rows = [
        [
            Cell(f"{TITLES[pair.first]} − {TITLES[pair.second]}"),
            interval_cell(pair.macro_auroc, sign=True),
            interval_cell(pair.detection or UNDEFINED, sign=True),
            Cell(verdict(pair.macro_auroc, specimens)),
        ]
        for pair in found.comparisons
    ]
    head = ["Paired difference", "Macro-AUROC", "Damaged or not", "Interval excludes 0"]
    caption = (
        "What a healthy record of the same gearbox is worth: paired differences on the same resampled specimens, with "
        "95 % limits. The last column is of macro-AUROC."
    )
    return table(head, rows, caption=caption, sortable=True)


def _other_row(there: Judged, here: Judged) -> list[Cell]:
    scores = [there.scores.macro_auroc, here.scores.macro_auroc, there.scores.accuracy, here.scores.accuracy]
    return [Cell(TITLES[there.name]), *(interval_cell(s) for s in scores), interval_cell(there.calibration.after)]


def score_blocks(training: Training) -> list[str]:
    """Return what the section of scores holds below its first table."""
    blocks = [comparison_table(training)]
    if training.referenced:
        blocks += [referenced_table(training.referenced), referenced_pairs_table(training.referenced)]
    return [*blocks, other_set_table(training)] if training.other else blocks
