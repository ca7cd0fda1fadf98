"""What a report shows of classifiers: damaged or not, what is taken for what, differences, nested folds.

Damaged or not is the table that is asked for first, with what the classes are and what guessing gives. The detectors of
the answer have AUC, alarms by state, and the size that is found.
"""

from __future__ import annotations

import math
import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.judging.alarms import Detectors, FoundSize, JudgedDetector
from diagnostics.judging.judgement import BOOSTING, RMS_ALONE, TITLES, Judged
from diagnostics.judging.nested_folds import KNOWN_ACCEPTED, Nested, Stranger
from diagnostics.judging.of_split import Referenced, Training
from diagnostics.page.blocks import Block, Cell, Paragraph, TableBlock
from diagnostics.page.style import new_figure
from diagnostics.page.tables import UNDEFINED, cell, linked_cell, records_link, table
from diagnostics.page.wording import (
    capitalised,
    counted,
    joined,
    rounded,
)
from diagnostics.records.record_classes import STATE
from diagnostics.report.indicators import in_a_sentence
from diagnostics.report.sentences import CLASSIFIERS
from diagnostics.scoring.score import Scores
from diagnostics.statistics.evaluation import FEWEST_THAT_AGREE, Interval, IntervalScores

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def confusion_table(
    scores: IntervalScores, title: str, records: str = "test records", kind: str = STATE, *, linked: bool = False
) -> TableBlock:
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
            true,
            *(_count(true, classes[k], int(counts[row, k]), share[row, k], linked=linked) for k in range(len(classes))),
        ]
        for row, true in enumerate(classes)
    ]
    return table([f"True {kind}", *classes], rows, CLASSIFIERS.confusion(title, kind, records, linked))


def _count(true: str, named: str, count: int, share: float, *, linked: bool) -> Cell:
    link = records_link(split="test", **{"class": true}, predicted=named) if count and linked else ""
    hint = f"records of {true} that are named {named}" if link else ""
    return Cell(str(count), f"{share:.0%}" if count else "", float(count), link, hint, float(share))


ACCURACY_COLOUR, AREA_COLOUR, CHANCE_COLOUR = "#1f6f8b", "#b01e3c", "#8a97a3"


def score_figure(training: Training) -> Figure:
    """Return accuracy and macro-AUROC of every classifier with intervals; dashed lines are chance."""
    figure, axes = new_figure(1, 2, height_in=0.95 + 0.5 * len(training.judged), sharey=True)
    chance = training.judged[0].scores.guess
    panels = (("Accuracy [-]", ACCURACY_COLOUR, chance), ("Macro-AUROC [-]", AREA_COLOUR, 0.5))
    for axis, (title, colour, level) in zip(axes[0], panels, strict=True):
        axis.axvline(level, color=CHANCE_COLOUR, linestyle="--", linewidth=1.0)
        for row, judged in enumerate(training.judged):
            interval = judged.scores.accuracy if axis is axes[0, 0] else judged.scores.macro_auroc
            axis.plot(
                [interval.low, interval.high], [row, row], color=colour, linewidth=2.5, alpha=0.5, solid_capstyle="butt"
            )
            axis.plot(interval.value, row, marker="o", markersize=6, color=colour)
        axis.set_xlim(0.0, 1.03)
        axis.set_xlabel(title)
    axes[0, 0].set_yticks(range(len(training.judged)), [_name(judged) for judged in training.judged], fontsize=9)
    axes[0, 0].set_ylim(len(training.judged) - 0.5, -0.5)
    return figure


def _name(judged: Judged) -> str:
    return "\n".join(textwrap.wrap(TITLES[judged.name], 18))


def permutation_figure(training: Training) -> Figure:
    """Return macro-AUROC after training on permuted labels (dots) beside the true one (diamond)."""
    shown = [judged for judged in training.judged if np.isfinite(judged.permuted_auroc).any()]
    figure, axes = new_figure(height_in=1.2 + 0.55 * len(shown))
    axis = axes[0, 0]
    axis.axvline(0.5, color=CHANCE_COLOUR, linestyle="--", linewidth=1.0, label="chance")
    for row, judged in enumerate(shown):
        areas = judged.permuted_auroc
        spread = 0.35 * (np.arange(areas.size) / max(areas.size - 1, 1) - 0.5) if areas.size > 1 else np.zeros(1)
        label = ("permuted labels", "true labels") if row == 0 else (None, None)
        axis.plot(areas, row + spread, linestyle="none", marker="o", markersize=4, color=CHANCE_COLOUR, label=label[0])
        value = judged.scores.macro_auroc.value
        axis.plot(value, row, linestyle="none", marker="D", markersize=7, color=AREA_COLOUR, label=label[1])
    axis.set_xlim(0.0, 1.03)
    axis.set_ylim(len(shown) - 0.5, -0.5)
    axis.set_yticks(range(len(shown)), [_name(judged) for judged in shown], fontsize=9)
    axis.set_xlabel("Macro-AUROC on test specimens [-]")
    figure.legend(loc="outside upper center", ncols=3, fontsize=9)
    return figure


MOST_NAMES = 3
"""Names shown of what a class that training lacked is called."""


def nested_blocks(nested: Nested | None, kind: str = STATE) -> list[Block]:
    """Return the blocks; nothing where the set has too few gearboxes for folds."""
    if nested is None:
        return []
    matrix = confusion_table(nested.scores, "Nested folds over all gearboxes", "records of all gearboxes", kind=kind)
    return [Paragraph(CLASSIFIERS.nested(nested)), matrix, _strangers(nested.strangers)]


def _strangers(strangers: tuple[Stranger, ...]) -> TableBlock:
    rows = [
        (
            *(stranger.name, stranger.records, cell(stranger.rejected, ".0%")),
            joined([f"{name} {share:.0%}" for name, share in list(stranger.called.items())[:MOST_NAMES]]) or None,
        )
        for stranger in strangers
    ]
    head = ["Class that training lacks", "Records", "Called something else", "Called"]
    return table(head, rows, CLASSIFIERS.strangers(KNOWN_ACCEPTED))


def your_scores(scores: Scores | None) -> list[Block]:
    """Return a sentence and the table; nothing without predictions."""
    if scores is None:
        return []
    first = scores.rows[0].name
    rows = [
        (
            *(f"{row.task}: {row.measure}", row.records, TITLES.get(row.name, row.name), row.score, row.chance),
            *(cell(row.difference, "+.2f"), "less" if row.falls else "more"),
        )
        for row in scores.rows
    ]
    head = ["Task", "Records", "Whose", "Score", "Chance", f"{capitalised(first)} minus this", "Better"]
    shown = table(head, rows, "Scores of the tasks that the predictions answer.", sortable=True)
    return [Paragraph(CLASSIFIERS.yours(scores)), shown]


def detection_blocks(training: Training) -> list[Block]:
    """Return the tables of detection, on the test specimens and on another set, with what they mean."""
    merged = {name: states for name, states in training.split.members.items() if len(states) > 1}
    texts = [CLASSIFIERS.merged(name, states) for name, states in merged.items()]
    texts += [] if training.judged[0].scores.balanced else [CLASSIFIERS.unequal(training)]
    blocks: list[Block] = [Paragraph(text) for text in texts]
    shown = tuple(judged for judged in training.judged if judged.detection)
    if not shown:
        return blocks
    blocks += [Paragraph(text) for text in gain_sentences(training)]
    blocks.append(detection_table(shown, CLASSIFIERS.damaged_or_not(training.split.healthy)))
    other = tuple(judged for judged in training.other if judged.detection)
    if other:
        blocks.append(
            detection_table(
                other, f"Damaged or not on the other set {training.other_name}. Read it like the table before."
            )
        )
    return blocks


def gain_sentences(training: Training) -> list[str]:
    """Say what the best detector gains over the level alone, paired; nothing where there is no interval."""
    pairs = [(pair, pair.detection) for pair in training.comparisons if pair.second == RMS_ALONE and pair.detection]
    defined = [(pair, gain) for pair, gain in pairs if math.isfinite(gain.low)]
    if not defined:
        return []
    best, gain = max(defined, key=lambda entry: entry[1].value)
    return [CLASSIFIERS.detection_gain(best.first, gain)]


def detection_table(shown: tuple[Judged, ...], caption: str) -> TableBlock:
    """Return AUROC of healthy against all damaged records, and against every state, by classifier."""
    states = list(dict.fromkeys(name for judged in shown if judged.detection for name in judged.detection.by_class))
    rows = [
        (TITLES[judged.name], judged.detection.every, *(judged.detection.by_class[state] for state in states))
        for judged in shown
        if judged.detection
    ]
    return table(["Classifier", "all damage", *states], rows, caption, sortable=True)


def detector_table(detectors: Detectors) -> TableBlock:
    """Return all detectors, those beside a healthy record below those without; nothing without any.

    AUC and alarms of a state lead to its records.
    """
    every = list({id(one): one for side in (detectors.alone, detectors.referenced) for one in side.values()}.values())
    states = list(dict.fromkeys(name for detector in every for name in detector.states))
    kinds = list(dict.fromkeys(state.kind for detector in every for state in detector.states.values()))
    shams = any(one.sham for one in every)
    head = [
        *("Detector", "Gearboxes"),
        *(["AUC, sham"] if shams else []),
        "AUC, all damage",
        *(f"AUC, {name}" for name in states),
        *(f"Alarms, {name} [%]" for name in states),
        *(f"Nine of ten, {kind} [mm²]" for kind in kinds),
    ]
    rows = [_row(detector, states, kinds, shams=shams) for detector in every]
    return table(head, rows, CLASSIFIERS.detectors(shams), sortable=True)


def _row(detector: JudgedDetector, states: list[str], kinds: list[str], *, shams: bool) -> list[object]:
    beside = "beside a healthy record" if detector.referenced and "beside" not in detector.title else ""
    basis = in_a_sentence(detector.basis, detector.gears) if detector.basis else CLASSIFIERS.picked(detector.picks)
    small = ", ".join(part for part in (basis, beside) if part)
    shown = {"indicator": detector.basis} if detector.basis else {}
    judged = detector.states
    return [
        *(Cell(detector.title, small), detector.specimens, *([detector.sham] if shams else []), detector.every),
        *(linked_cell(cell(judged[name].auc), state=name, **shown) if name in judged else None for name in states),
        *(linked_cell(_alarms(detector, name), state=name, **shown) for name in states),
        *(_size_cell(detector.sizes.get(kind)) for kind in kinds),
    ]


def _alarms(detector: JudgedDetector, name: str) -> Cell:
    share = detector.states[name].share if name in detector.states else None
    if share is None:
        return cell(None)
    limits = "" if math.isnan(share.low) else f"{100 * share.low:.0f} … {100 * share.high:.0f}"
    return Cell(f"{100 * share.value:.0f}", limits, 100.0 * share.value)


def _size_cell(size: FoundSize | None) -> Cell:
    if size is None:
        return cell(None)
    if not size.reached:
        return Cell("not found", f"up to {rounded(size.largest_mm2)}", 1e9)
    high = rounded(size.area_mm2.high) if math.isfinite(size.area_mm2.high) else "∞"
    bound = "≤ " if size.is_bound else ""
    return Cell(f"{bound}{rounded(size.area_mm2.value)}", f"{rounded(size.area_mm2.low)} … {high}", size.area_mm2.value)


def comparison_table(training: Training) -> TableBlock:
    """Return the paired differences of classifiers, and whether the interval of each, by itself, excludes zero."""
    specimens = training.judged[0].scores.specimens
    rows = [
        (f"{TITLES[pair.first]} − {TITLES[pair.second]}", *(area, pair.accuracy), verdict(area, specimens))
        for pair in training.comparisons
        for area in (pair.macro_auroc,)
    ]
    head = ["Paired difference", "Macro-AUROC", "Accuracy", "Interval excludes 0"]
    return table(head, rows, CLASSIFIERS.differences(FEWEST_THAT_AGREE), "+.2f", sortable=True)


def verdict(difference: Interval, specimens: int) -> str:
    """Return whether a paired interval excludes zero; resampling a few specimens makes intervals too narrow to say."""
    if specimens < FEWEST_THAT_AGREE or not math.isfinite(difference.low):
        return "too few gearboxes"
    return "yes" if difference.low > 0.0 or difference.high < 0.0 else "no"


def other_set_table(training: Training) -> TableBlock:
    """Return the scores on another set beside those on the own test specimens."""
    here = {judged.name: judged for judged in training.judged}
    rows = [
        (
            *(TITLES[there.name], there.scores.macro_auroc, here[there.name].scores.macro_auroc),
            *(there.scores.accuracy, here[there.name].scores.accuracy, there.calibration.after),
        )
        for there in training.other
    ]
    head = ["Classifier", "Macro-AUROC there", "Macro-AUROC here", "Accuracy there", "Accuracy here"]
    caption = CLASSIFIERS.other_set(training.other_name, training.other[0].scores)
    return table([*head, "Calibration error there"], rows, caption, sortable=True)


def referenced_table(referenced: Referenced) -> TableBlock:
    """Return what classifiers reach alone and beside a healthy record of the same gearbox, on the same records."""
    rows = [
        (
            TITLES[one.name],
            one.scores.macro_auroc,
            one.scores.accuracy,
            one.detection.every if one.detection else UNDEFINED,
        )
        for one in referenced.judged
    ]
    head = ["Classifier", "Macro-AUROC [-]", "Accuracy [-]", "Damaged or not, AUROC [-]"]
    return table(head, rows, CLASSIFIERS.referenced(referenced.judged[0].scores.records), sortable=True)


def referenced_pairs_table(referenced: Referenced) -> TableBlock:
    """Return the paired differences that a healthy record makes."""
    specimens = referenced.judged[0].scores.specimens
    rows = [
        (
            f"{TITLES[pair.first]} − {TITLES[pair.second]}",
            *(pair.macro_auroc, pair.detection or UNDEFINED, verdict(pair.macro_auroc, specimens)),
        )
        for pair in referenced.comparisons
    ]
    head = ["Paired difference", "Macro-AUROC", "Damaged or not", "Interval excludes 0"]
    return table(head, rows, CLASSIFIERS.reference_worth(), "+.2f", sortable=True)


def score_blocks(training: Training) -> list[Block]:
    """Return what the section of scores holds below its first table."""
    blocks: list[Block] = [comparison_table(training)]
    if training.referenced:
        blocks += [referenced_table(training.referenced), referenced_pairs_table(training.referenced)]
    return [*blocks, other_set_table(training)] if training.other else blocks


def score_table(training: Training) -> TableBlock:
    """Return accuracy and macro-AUROC of every classifier with intervals, and its permutation control."""
    rows = [
        (
            Cell(TITLES[judged.name], _details(judged.name, judged.details)),
            *(judged.scores.accuracy, judged.scores.macro_auroc),
            judged.permuted_auroc.mean() if judged.permuted_auroc.size else None,
        )
        for judged in training.judged
    ]
    head = ["Classifier", "Accuracy [-]", "Macro-AUROC [-]", "Permuted labels [-]"]
    return table(head, rows, CLASSIFIERS.score_table(training.judged[0].scores.specimens), sortable=True)


def calibration_table(training: Training) -> TableBlock:
    """Return what the probabilities of every classifier are worth without and with its temperature."""
    rows = [
        (TITLES[judged.name], one.temperature, one.brier_before, one.brier, one.before, one.after, one.honest)
        for judged in training.judged
        for one in (judged.calibration,)
    ]
    scores = ("Brier score", "Calibration error")
    head = [
        *("Classifier", "T [-]"),
        *(f"{score}, {which} T [-]" for score in scores for which in ("without", "with")),
        "Calibration error if true [-]",
    ]
    return table(head, rows, CLASSIFIERS.calibration(len(training.judged[0].scores.classes)), sortable=True)


def _details(name: str, details: dict[str, Any]) -> str:
    if "strength" in details:
        return f"{counted(details['features'], 'feature')}, {strength_text(name, details['strength'])}"
    return f"averaged revolutions, epoch {details['best_epoch']} of {details['epochs']}"


def strength_text(name: str, strength: float) -> str:
    """Return what was chosen on validation specimens."""
    return f"{strength:g} rounds" if name == BOOSTING else f"C = {strength:g}"
