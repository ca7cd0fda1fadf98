"""Damaged or not: the table that is asked for first, with what the classes are and what guessing gives."""

from __future__ import annotations

import math

from diagnostics.page.html import Cell, paragraph, table
from diagnostics.page.tables import interval_cell
from diagnostics.page.wording import capitalised, joined, percent, percent_limits, signed, signed_limits
from diagnostics.statistics.judgement import RMS_ALONE, TITLES, Judged
from diagnostics.training.training import Training


def detection_blocks(training: Training) -> list[str]:
    """Return the tables of detection, on the test specimens and on another set, with what they mean."""
    blocks = [paragraph(text) for text in (*class_sentences(training), *balance_sentences(training))]
    shown = tuple(found for found in training.judged if found.detection)
    if not shown:
        return blocks
    blocks += [paragraph(text) for text in gain_sentences(training)]
    blocks.append(detection_table(shown, f"Damaged or not: {reading(training)}"))
    other = tuple(found for found in training.other if found.detection)
    if other:
        blocks.append(
            detection_table(
                other, f"Damaged or not on the other set {training.other_name}. Read it like the table before."
            )
        )
    return blocks


def class_sentences(training: Training) -> list[str]:
    """Say which states are one class; nothing where every state is a class of its own."""
    merged = {name: states for name, states in training.split.members.items() if len(states) > 1}
    return [
        f"The class {name} holds the records of {', '.join(states)}. No damage distinguishes these states, so no "
        "classifier has to."
        for name, states in merged.items()
    ]


def balance_sentences(training: Training) -> list[str]:
    """Give balanced accuracies where classes are unequal; nothing where they are equal."""
    first = training.judged[0].scores
    if first.balanced:
        return []
    parts = [
        f"{TITLES[found.name]} {percent(found.scores.balanced_accuracy.value)} "
        f"({percent_limits(found.scores.balanced_accuracy)})"
        for found in training.judged
    ]
    return [
        f"The classes have unequal numbers of records. Always naming the most frequent class gives an accuracy of "
        f"{percent(first.guess)}. The balanced accuracy, a mean over the classes, is: {joined(parts)}. Guessing gives "
        f"{percent(1 / len(first.classes))} of it."
    ]


def reading(training: Training) -> str:
    """Say how the table is to be read."""
    return (
        f"AUROC of 1 − p({training.split.healthy}) on the test specimens. One alarm covers all kinds of damage. "
        "Chance is 0.5. The 95 % limits come from resampled specimens."
    )


def gain_sentences(training: Training) -> list[str]:
    """Say what the best detector gains over the level alone, paired; nothing where there is no interval."""
    pairs = [(pair, pair.detection) for pair in training.comparisons if pair.second == RMS_ALONE and pair.detection]
    defined = [(pair, gain) for pair, gain in pairs if math.isfinite(gain.low)]
    if not defined:
        return []
    best, gain = max(defined, key=lambda entry: entry[1].value)
    return [
        f"{capitalised(TITLES[best.first])} has the largest gain in detection over RMS alone: {signed(gain.value)} of "
        f"AUROC ({signed_limits(gain)}, paired over the specimens)."
    ]


def detection_table(found: tuple[Judged, ...], caption: str) -> str:
    """Return AUROC of healthy against all damaged records, and against every state, by classifier."""
    states = list(dict.fromkeys(name for judged in found if judged.detection for name in judged.detection.by_class))
    rows = [
        [
            Cell(TITLES[judged.name]),
            interval_cell(judged.detection.every),
            *(interval_cell(judged.detection.by_class[state]) for state in states),
        ]
        for judged in found
        if judged.detection
    ]
    return table(["Classifier", "all damage", *states], rows, caption=caption, sortable=True)
