"""The summary of a report, written from its numbers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from diagnostics.comparison import SATURATED
from diagnostics.evaluation import Interval, error_share_limit
from diagnostics.judgement import NETWORK, RMS_ALONE, TITLES, Judged
from diagnostics.realism import meaning_of_scores
from diagnostics.separability import Separability
from diagnostics.training import Training

CHANCE_MARGIN = 0.1
"""A mean macro-AUROC under permuted labels that is farther from 0.5 than this is called suspicious."""


def summary(config: dict[str, Any], training: Training | None, found: list[Separability]) -> list[str]:
    """Return the sentences of the summary; the first says what scores on this set mean.

    Parameters
    ----------
    config : dict
        Configuration of the set.
    training : Training, optional
        None where no classifier could be trained.
    found : list of Separability
        All features, strongest first.
    """
    sentences = [meaning_of_scores(config, scored=training is not None)]
    if training:
        sentences += [scores_sentence(training), comparison_sentence(training), trust_sentence(training)]
    return [*sentences, *indicator_sentences(found)]


def percent(value: float) -> str:
    """Return a share as whole percent."""
    return f"{100.0 * value:.0f}\u00a0%"


def _range(found: Interval) -> str:
    return (
        "no interval from one specimen" if math.isnan(found.low) else f"{percent(found.low)} to {percent(found.high)}"
    )


def scores_sentence(training: Training) -> str:
    """Say how often each classifier named the right state."""
    first = training.judged[0].scores
    parts = [
        f"{TITLES[judged.name]} {percent(judged.scores.accuracy.value)} ({_range(judged.scores.accuracy)}, "
        f"macro-AUROC {judged.scores.macro_auroc.value:.2f})"
        for judged in training.judged
    ]
    return (
        f"On {first.records} records of {first.specimens} test specimens the right one of "
        f"{len(first.classes)} {_told_apart(training)} was "
        f"named by {', '.join(parts[:-1])} and {parts[-1]}, where guessing gives {percent(first.guess)}."
    )


def _told_apart(training: Training) -> str:
    return "states" if all(len(states) == 1 for states in training.split.members.values()) else "classes"


def comparison_sentence(training: Training) -> str:
    """Say which classifier is ahead of RMS alone and by how much, and whether the level alone already finds damage."""
    pairs = [pair for pair in training.comparisons if pair.second == RMS_ALONE]
    best = max(pairs, key=lambda pair: pair.macro_auroc.value)
    limits = (
        "no interval from one specimen"
        if math.isnan(best.macro_auroc.low)
        else f"{best.macro_auroc.low:+.2f} to {best.macro_auroc.high:+.2f}, paired"
    )
    text = (
        f"Over RMS alone, {TITLES[best.first]} gains {best.macro_auroc.value:+.2f} of macro-AUROC ({limits})"
        f"{_between(training, best.first)}"
    )
    severe = training.rms_severe
    if severe is None or math.isnan(severe.value):
        return f"{text}."
    if severe.value > SATURATED:
        return (
            f"{text}; yet RMS alone already tells the most severe state from healthy with an AUC of "
            f"{severe.value:.2f}, so its scores say little about finer methods."
        )
    return f"{text}; RMS alone tells the most severe state from healthy with an AUC of {severe.value:.2f} only."


def _between(training: Training, best: str) -> str:
    """Say whether the network is behind or ahead of the best other one, where there is one."""
    pair = next(
        (p for p in training.comparisons if NETWORK in (p.first, p.second) and best in (p.first, p.second)), None
    )
    if pair is None or math.isnan(pair.macro_auroc.low):
        return ""
    sign = 1.0 if pair.first == NETWORK else -1.0
    low, high = sorted((sign * pair.macro_auroc.low, sign * pair.macro_auroc.high))
    if low <= 0.0 <= high:
        return ", from which the 1-D network cannot be told apart"
    return f", the 1-D network being {sign * pair.macro_auroc.value:+.2f} from it ({low:+.2f} to {high:+.2f})"


def trust_sentence(training: Training) -> str:
    """Say how certain the scores are and what permuted labels give, in one sentence."""
    certainty, control = certainty_sentence(training), control_sentence(training)
    return f"{certainty[:-1]}; {control[0].lower()}{control[1:]}"


def certainty_sentence(training: Training) -> str:
    """Say how far few specimens limit what the scores can tell."""
    specimens = training.judged[0].scores.specimens
    perfect = [judged for judged in training.judged if judged.scores.accuracy.value == 1.0]
    if perfect:
        return (
            f"Without a single error on {specimens} specimens the interval has no width, yet up to "
            f"{percent(error_share_limit(specimens))} of specimens with errors remain compatible with that "
            "(95\u00a0%, binomial)."
        )
    return f"Intervals are 95 % and come from resampling the {specimens} test specimens; with so many they are " + (
        "rough." if specimens < 20 else "meaningful."
    )


def control_sentence(training: Training) -> str:
    """Say what training on permuted labels gave, and whether that is chance."""
    shown = [judged for judged in training.judged if judged.permuted_auroc.size]
    parts = [_control(judged) for judged in shown]
    suspicious = [
        judged
        for judged in shown
        if judged.permuted_auroc.size > 1 and abs(judged.permuted_auroc.mean() - 0.5) > CHANCE_MARGIN
    ]
    verdict = (
        f"{' and '.join(judged.name for judged in suspicious)} stay off chance, so the scores above are not "
        "to be trusted"
        if suspicious
        else "chance is 0.5, so nothing but the labels carries the scores"
    )
    return f"Trained on permuted labels the macro-AUROC is {' and '.join(parts)}; {verdict}."


def _control(judged: Judged) -> str:
    areas = judged.permuted_auroc
    if areas.size == 1:
        return f"{areas[0]:.2f} in a single short run for {TITLES[judged.name]}"
    low, high = np.quantile(areas, [0.05, 0.95])
    spread = f"{areas.size} runs, 90\u00a0% within {low:.2f} to {high:.2f}"
    return f"{areas.mean():.2f} on average for {TITLES[judged.name]} ({spread})"


def indicator_sentences(found: list[Separability]) -> list[str]:
    """Say which state is hardest, and which single indicator does best there."""
    sentences = []
    hardest = hardest_state(found)
    if hardest and math.isnan(hardest[1].auc[hardest[0]].low):
        return ["With a single specimen the indicators below describe that specimen; they say nothing about others."]
    if hardest:
        state, entry = hardest
        area = entry.auc[state]
        sentences.append(
            f"The state hardest to tell from healthy is {state}: the best of {len(found)} single indicators, "
            f"{entry.feature}, reaches an AUC of {area.value:.2f} ({area.low:.2f} to {area.high:.2f}; chosen "
            "on the same "
            "specimens, therefore optimistic)."
        )
    return sentences


def area_sentence(found: list[Separability]) -> list[str]:
    """Say which single indicator follows the damaged area best; nothing where none is defined."""
    followed = [entry for entry in found if math.isfinite(entry.spearman.value)]
    if not followed:
        return []
    best = max(followed, key=lambda entry: abs(entry.spearman.value))
    return [
        f"The damaged area is followed best by {best.feature} (rank correlation {best.spearman.value:+.2f}, "
        f"{best.spearman.low:+.2f} to {best.spearman.high:+.2f})."
    ]


def hardest_state(found: list[Separability]) -> tuple[str, Separability] | None:
    """Return the state whose best single indicator is weakest, and that indicator."""
    best: dict[str, tuple[float, Separability]] = {}
    for entry in found:
        for state, area in entry.auc.items():
            distance = abs(area.value - 0.5)
            if math.isfinite(distance) and (state not in best or distance > best[state][0]):
                best[state] = (distance, entry)
    if not best:
        return None
    state = min(best, key=lambda name: best[name][0])
    return state, best[state][1]
