"""The summary of a report: what its scores mean, what classifiers reach, and what single indicators tell."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from diagnostics.judging.judgement import NETWORK, RMS_ALONE, SATURATED, TITLES, VALIDATION_AUROC
from diagnostics.judging.of_split import Training
from diagnostics.page.sentences import Sentences
from diagnostics.records.record_classes import FAULT, STATE
from diagnostics.report.indicators import FINDINGS
from diagnostics.statistics.evaluation import Interval
from diagnostics.statistics.indicator_statistics import Separability

CHANCE_MARGIN = 0.1
"""A mean macro-AUROC under permuted labels that is farther from 0.5 than this is called suspicious."""

CLASSIFIERS = Sentences(
    Path(__file__).with_name("templates") / "classifiers.txt", titles=TITLES, saturated=SATURATED, quantile=np.quantile
)


def scores_sentence(training: Training) -> str:
    """Say how often each classifier named the right state."""
    whole = all(len(states) == 1 for states in training.split.members.values())
    return CLASSIFIERS.scores(training, FAULT if training.split.kind == FAULT else STATE if whole else "class")


def comparison_sentence(training: Training) -> str:
    """Say what the classifier that validation specimens choose gains over RMS alone, and what the level alone finds.

    Choosing it by its test score would make that score optimistic; without validation scores all gains are told.
    """
    gains = {
        pair.first: pair.macro_auroc
        for pair in training.comparisons
        if pair.second == RMS_ALONE and math.isfinite(pair.macro_auroc.value)
    }
    validated = {judged.name: judged.details.get(VALIDATION_AUROC, math.nan) for judged in training.judged}
    known = gains and all(math.isfinite(validated[name]) for name in gains)
    best = max(gains, key=lambda name: validated[name]) if known else None
    others = [name for name in gains if name != NETWORK]
    rival = between = None
    if best and others and NETWORK in gains:  # whether the network and the best classifier on indicators differ
        rival = max(others, key=lambda name: validated[name]) if best == NETWORK else NETWORK
        between = _difference(training, rival, best)
    return CLASSIFIERS.comparison(gains, best, rival if between else None, between, training.rms_severe)


def _difference(training: Training, first: str, second: str) -> Interval | None:
    """Return the macro-AUROC of the first less that of the second; None without limits."""
    for pair in training.comparisons:
        area = pair.macro_auroc
        if {pair.first, pair.second} == {first, second} and math.isfinite(area.low):
            return area if pair.first == first else Interval(-area.value, -area.high, -area.low)
    return None


def trust_sentence(training: Training) -> str:
    """Say how certain the scores are and what permuted labels give."""
    return f"{CLASSIFIERS.certainty(training.judged[0].scores.specimens)} {control_sentence(training)}".rstrip()


def control_sentence(training: Training) -> str:
    """Say what training on permuted labels gave, and whether that is chance; nothing where it was not run."""
    areas = {TITLES[one.name]: one.permuted_auroc[np.isfinite(one.permuted_auroc)] for one in training.judged}
    permuted = {title: area for title, area in areas.items() if area.size}
    runs = {TITLES[one.name]: one.permuted_auroc.size for one in training.judged}
    off = {title for title, area in permuted.items() if abs(area.mean() - 0.5) > CHANCE_MARGIN}
    return CLASSIFIERS.control(permuted, [title for title in permuted if title in off and runs[title] > 1])


def area_sentence(separabilities: list[Separability]) -> str:
    """Say which single indicator follows the damaged area best; nothing where none is defined."""
    followed = [entry for entry in separabilities if math.isfinite(entry.spearman.value)]
    best = max(followed, key=lambda entry: abs(entry.spearman.value), default=None)
    return FINDINGS.follows_area(best) if best else ""
