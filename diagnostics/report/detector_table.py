"""The detectors of a report's answer as a table: AUC, alarms by state, and the size that is found.

Damaged or not: the table that is asked for first, with what the classes are and what guessing gives.
"""

from __future__ import annotations

import math

from diagnostics.judging.alarms import Detectors, FoundSize, JudgedDetector
from diagnostics.judging.judgement import RMS_ALONE, TITLES, Judged
from diagnostics.judging.of_split import Training
from diagnostics.page.html import Cell, paragraph, table
from diagnostics.page.tables import interval_cell, linked_cell
from diagnostics.page.wording import capitalised, joined, percent, percent_limits, rounded, signed, signed_limits
from diagnostics.report.indicator_figures import in_a_sentence

CAPTION = (
    "Detectors that give one alarm for all damage. Indicator and classifiers are judged on all gearboxes, each fold by "
    "what was chosen or trained on the others; the network on the test gearboxes. Where folds differ in which of them "
    "is best, a row of its own has the choice that the other gearboxes make. Alarms: share of the records of "
    "a state above the threshold that 5 % of the healthy records exceed. Last columns: damaged area from which 90 % "
    "give an alarm. Limits of 95 % come from resampled gearboxes."
)
SHAM_CAPTION = " Sham: healthy records whose damage was drawn with nothing removed; an AUC above chance is a leak."


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


def detector_table(found: Detectors) -> str:
    """Return all detectors, those beside a healthy record below those without; nothing without any.

    AUC and alarms of a state lead to its records.
    """
    every = list({id(one): one for side in (found.alone, found.referenced) for one in side.values()}.values())
    if not every:
        return ""
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
    return table(head, rows, caption=CAPTION + (SHAM_CAPTION if shams else ""), sortable=True)


def _row(detector: JudgedDetector, states: list[str], kinds: list[str], *, shams: bool) -> list[Cell]:
    beside = "beside a healthy record" if detector.referenced and "beside" not in detector.title else ""
    basis = in_a_sentence(detector.basis, detector.gears) if detector.basis else picked(detector.picks)
    small = ", ".join(part for part in (basis, beside) if part)
    none = Cell("–", value=math.nan)
    shown = {"indicator": detector.basis} if detector.basis else {}

    def behind(cell: Cell, state: str) -> Cell:
        return linked_cell(cell, state=state, **shown)

    return [
        Cell(detector.title, small),
        Cell(str(detector.specimens), value=float(detector.specimens)),
        *([interval_cell(detector.sham) if detector.sham else none] if shams else []),
        interval_cell(detector.every),
        *(
            behind(interval_cell(detector.states[name].auc), name) if name in detector.states else none
            for name in states
        ),
        *(behind(_alarms(detector, name), name) for name in states),
        *(_size_cell(detector.sizes.get(kind)) for kind in kinds),
    ]


def picked(picks: tuple[tuple[str, int], ...]) -> str:
    """Return what was chosen for how many groups of gearboxes, the most frequent first; nothing without a choice."""
    groups = sum(count for _, count in picks)
    said = [
        f"{name} for {count}{f' of {groups} groups' if not place else ''}" for place, (name, count) in enumerate(picks)
    ]
    return joined(said) if said else ""


def _alarms(detector: JudgedDetector, name: str) -> Cell:
    found = detector.states[name].share if name in detector.states else None
    if found is None:
        return Cell("–", value=math.nan)
    limits = "" if math.isnan(found.low) else f"{100 * found.low:.0f} … {100 * found.high:.0f}"
    return Cell(f"{100 * found.value:.0f}", limits, 100.0 * found.value)


def _size_cell(found: FoundSize | None) -> Cell:
    if found is None:
        return Cell("–", value=math.nan)
    if not found.reached:
        return Cell("not found", f"up to {rounded(found.largest_mm2)}", 1e9)
    high = rounded(found.area_mm2.high) if math.isfinite(found.area_mm2.high) else "∞"
    bound = "≤ " if found.is_bound else ""
    return Cell(
        f"{bound}{rounded(found.area_mm2.value)}", f"{rounded(found.area_mm2.low)} … {high}", found.area_mm2.value
    )
