"""Tables of a report beside the scores: paired differences, damaged area, another set, splits, learning curve."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.page.html import Cell, paragraph, table
from diagnostics.page.tables import interval_cell
from diagnostics.page.wording import counted
from diagnostics.statistics.evaluation import Interval
from diagnostics.statistics.judgement import TITLES, Judged
from diagnostics.training.referenced import Referenced
from diagnostics.training.split_study import SplitScore
from diagnostics.training.studies import CurvePoint, Studies
from diagnostics.training.training import Training

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


def severity_table(training: Training) -> str:
    """Return how well the damaged area is told as a number."""
    rows = [
        [Cell(row.title), interval_cell(row.error_mm2), interval_cell(row.spearman, sign=True)]
        for row in training.severity
    ]
    caption = (
        "The damaged area as a number, on the same test specimens. The median of training does not use the signal."
    )
    return table(
        ["Damaged area by", "Mean absolute error [mm²]", "Rank correlation [-]"], rows, caption=caption, sortable=True
    )


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


def split_table(rows: tuple[SplitScore, ...]) -> str:
    """Return what every way to split does to the score."""
    cells = [
        [
            Cell(row.title, "the same gearboxes on both sides" if row.leaky else ""),
            interval_cell(row.indicators.macro_auroc),
            interval_cell(row.rms.macro_auroc),
            interval_cell(row.indicators.accuracy),
            Cell(str(row.folds), value=float(row.folds)),
        ]
        for row in rows
    ]
    head = ["Held out", "Macro-AUROC, indicators", "Macro-AUROC, RMS", "Accuracy, indicators", "Folds"]
    caption = "Scores by the way windows are held out, with 95 % limits. Windows and logistic regression stay the same."
    return table(head, cells, caption=caption, sortable=True)


def curve_table(points: tuple[CurvePoint, ...]) -> str:
    """Return mean and range of macro-AUROC by number of training specimens."""
    rows = [
        [Cell(str(point.specimens), value=float(point.specimens)), _range(point.indicators), _range(point.rms)]
        for point in points
    ]
    head = ["Training specimens", "Macro-AUROC, indicators", "Macro-AUROC, RMS"]
    caption = (
        "Learning curve: macro-AUROC on the test specimens, mean and range of up to five draws. C is chosen on the "
        "validation specimens. The last point is therefore the classifier above."
    )
    return table(head, rows, caption=caption, sortable=True)


def _range(areas: np.ndarray) -> Cell:
    defined = areas[np.isfinite(areas)]
    if not defined.size:
        return Cell("undefined", value=math.nan)
    limits = "" if defined.size == 1 else f"{defined.min():.2f} … {defined.max():.2f}"
    return Cell(f"{defined.mean():.2f}", limits, float(defined.mean()))


def score_blocks(training: Training) -> list[str]:
    """Return what the section of scores holds below its first table."""
    blocks = [comparison_table(training), severity_table(training)]
    if training.referenced:
        blocks += [referenced_table(training.referenced), referenced_pairs_table(training.referenced)]
    return [*blocks, other_set_table(training)] if training.other else blocks


def study_blocks(studies: Studies | None) -> list[str]:
    """Return the section of studies, or how to have it."""
    if studies is None:
        return [paragraph("The studies were not run. Run them: `siggen-diagnostics report DIR --studies`.")]
    return [paragraph(split_sentence(studies.splits)), split_table(studies.splits), curve_table(studies.curve)]


def split_sentence(rows: tuple[SplitScore, ...]) -> str:
    """Say how much of the score by random windows is left where the gearbox is unseen."""
    by_title = {row.title: round(row.indicators.macro_auroc.value, 2) for row in rows}
    leaky, strict = by_title.get("random windows (leaky)", math.nan), by_title.get("specimens", math.nan)
    first = "The same windows of 8 pinion revolutions are split in different ways, for the same logistic regression."
    if not math.isfinite(strict - leaky):
        return first
    verdict = f"{leaky - strict:.2f} less" if strict < leaky else "nothing is lost"
    text = (
        f"Random windows give a macro-AUROC of {leaky:.2f}, windows held out by specimen give {strict:.2f} ({verdict})."
        f" {first} Random windows are a mistake: pieces of one record are on both sides."
    )
    if by_title.get("records", math.nan) < strict:
        text += (
            f" Windows held out by record score lower still ({by_title['records']:.2f}). Most training records of the "
            "same gearbox show its other states, so their resemblance leads to the wrong state."
        )
    return text
