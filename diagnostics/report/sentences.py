"""The summary of a report in five sentences, written from its numbers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from diagnostics.page.wording import counted, decimal, joined, limits, percent, percent_limits, signed, signed_limits
from diagnostics.statistics.comparison import SATURATED, Comparison
from diagnostics.statistics.evaluation import Interval, error_share_limit
from diagnostics.statistics.judgement import NETWORK, PLAIN_NETWORK, RMS_ALONE, TITLES, VALIDATION_AUROC, Judged
from diagnostics.statistics.separability import Separability, best_by_state
from diagnostics.training.realism import meaning_of_scores
from diagnostics.training.training import Training

CHANCE_MARGIN = 0.1
"""A mean macro-AUROC under permuted labels that is farther from 0.5 than this is called suspicious."""

WEAK = 0.75
"""An AUC of the level below this is called weak."""

MANY_SPECIMENS = 20


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


def scores_sentence(training: Training) -> str:
    """Say how often each classifier named the right state; the network without augmentation is for the tables."""
    first = training.judged[0].scores
    parts = [
        f"{TITLES[judged.name]} {percent(judged.scores.accuracy.value)} ({percent_limits(judged.scores.accuracy)}, "
        f"macro-AUROC {decimal(judged.scores.macro_auroc.value)})"
        for judged in training.judged
        if judged.name != PLAIN_NETWORK
    ]
    return (
        f"On {counted(first.records, 'record')} of {counted(first.specimens, 'test specimen')} the right one of "
        f"{counted(len(first.classes), _told_apart(training))} was named by {joined(parts)}, where guessing gives "
        f"{percent(first.guess)}."
    )


def _told_apart(training: Training) -> str:
    return "state" if all(len(states) == 1 for states in training.split.members.values()) else "class"


def comparison_sentence(training: Training) -> str:
    """Say what the classifier that validation specimens choose gains over RMS alone, and what the level alone finds.

    Choosing it by its test score would make that score optimistic; without validation scores all gains are told.
    """
    gains = {
        pair.first: pair.macro_auroc
        for pair in training.comparisons
        if pair.second == RMS_ALONE and pair.first != PLAIN_NETWORK and math.isfinite(pair.macro_auroc.value)
    }
    if not gains:
        return "Whether anything beats RMS alone is not known, since macro-AUROC is undefined on these test specimens."
    validated = {judged.name: judged.details.get(VALIDATION_AUROC, math.nan) for judged in training.judged}
    if all(math.isfinite(validated[name]) for name in gains):
        best = max(gains, key=lambda name: validated[name])
        text = f"{_gain(TITLES[best], gains[best], len(gains))}{_between(training, best, gains, validated)}"
    else:
        told = [f"{TITLES[name]} {signed(gain.value)} ({signed_limits(gain)})" for name, gain in gains.items()]
        text = f"Differences of macro-AUROC from RMS alone, paired: {joined(told)}"
    severe = training.rms_severe
    if severe is None or math.isnan(severe.value):
        return f"{text}."
    if severe.value > SATURATED:
        return (
            f"{text}; yet RMS alone already tells the most severe state from healthy with an AUC of "
            f"{severe.value:.2f}, so its scores say little about finer methods."
        )
    only = " only" if severe.value < WEAK else ""
    return f"{text}; RMS alone tells the most severe state from healthy with an AUC of {severe.value:.2f}{only}."


def _gain(title: str, gain: Interval, count: int) -> str:
    spread = signed_limits(gain) if math.isnan(gain.low) else f"{signed_limits(gain)}, paired"
    chosen = ", the best on validation specimens" if count > 1 else ""
    if gain.value <= 0.0:
        return f"RMS alone is not beaten by {title}{chosen}: {signed(gain.value)} of macro-AUROC ({spread})"
    doubt = ", not told apart from none" if gain.low <= 0.0 else ""
    chosen = f"{chosen}," if chosen else ""
    return f"Over RMS alone, {title}{chosen} gains {signed(gain.value)} of macro-AUROC ({spread}{doubt})"


def _between(training: Training, best: str, gains: dict[str, Interval], validated: dict[str, float]) -> str:
    """Say whether the network and the best classifier on indicators differ, where there are both."""
    if NETWORK not in gains or len(gains) == 1:
        return ""
    others = {name: gain for name, gain in gains.items() if name != NETWORK}
    rival = max(others, key=lambda name: validated[name]) if best == NETWORK else NETWORK
    pair = next((p for p in training.comparisons if {p.first, p.second} == {best, rival}), None)
    if pair is None or math.isnan(pair.macro_auroc.low):
        return ""
    found = _turned(pair, rival)
    if found.low <= 0.0 <= found.high:
        return f", from which the {_short(rival)} cannot be told apart"
    return f", the {_short(rival)} being {signed(found.value)} from it ({signed_limits(found)})"


def _turned(pair: Comparison, first: str) -> Interval:
    """Return the difference of macro-AUROC of `first` and the other one of the pair."""
    area = pair.macro_auroc
    return area if pair.first == first else Interval(-area.value, -area.high, -area.low)


def _short(name: str) -> str:
    return TITLES[name] if name == NETWORK else f"best of the others, {TITLES[name]},"


def trust_sentence(training: Training) -> str:
    """Say how certain the scores are and what permuted labels give, in one sentence."""
    certainty, control = certainty_sentence(training), control_sentence(training)
    return f"{certainty[:-1]}; {control[0].lower()}{control[1:]}" if control else certainty


def certainty_sentence(training: Training) -> str:
    """Say how far few specimens limit what the scores can tell."""
    specimens = training.judged[0].scores.specimens
    perfect = [TITLES[judged.name] for judged in training.judged if judged.scores.accuracy.value == 1.0]
    if specimens == 1:
        return "From a single test specimen there are no intervals, and nothing is known about other gearboxes."
    if perfect:
        return (
            f"Without a single error on {specimens} specimens the interval of {joined(perfect)} has no width, yet up "
            f"to {percent(error_share_limit(specimens))} of specimens with errors remain compatible with that "
            "(95\N{NO-BREAK SPACE}%, binomial)."
        )
    verdict = "rough" if specimens < MANY_SPECIMENS else "meaningful"
    return (
        f"Intervals are 95\N{NO-BREAK SPACE}% and come from resampling the {specimens} test specimens; with so "
        f"{'few' if specimens < MANY_SPECIMENS else 'many'} they are {verdict}."
    )


def control_sentence(training: Training) -> str:
    """Say what training on permuted labels gave, and whether that is chance; nothing where it was not run."""
    shown = [judged for judged in training.judged if np.isfinite(judged.permuted_auroc).any()]
    if not shown:
        return ""
    suspicious = [
        TITLES[judged.name]
        for judged in shown
        if judged.permuted_auroc.size > 1 and abs(np.nanmean(judged.permuted_auroc) - 0.5) > CHANCE_MARGIN
    ]
    verdict = (
        f"that is off chance (0.5) for {joined(suspicious)}, so the scoring is biased and its scores not to be trusted"
        if suspicious
        else "chance is 0.5, so the scoring itself has no bias; against leakage no gearbox is in two splits"
    )
    return f"Trained on permuted labels the macro-AUROC is {joined([_control(judged) for judged in shown])}; {verdict}."


def _control(judged: Judged) -> str:
    areas = judged.permuted_auroc[np.isfinite(judged.permuted_auroc)]
    if areas.size == 1:
        return f"{areas[0]:.2f} in a single short run for {TITLES[judged.name]}"
    low, high = np.quantile(areas, [0.05, 0.95])
    spread = f"{areas.size} runs, 90\N{NO-BREAK SPACE}% within {low:.2f} to {high:.2f}"
    return f"{areas.mean():.2f} on average for {TITLES[judged.name]} ({spread})"


def indicator_sentences(found: list[Separability]) -> list[str]:
    """Say which state is hardest, and which single indicator does best there."""
    hardest = hardest_state(found)
    if hardest is None:
        return ["No single indicator can be judged, since the set lacks healthy or damaged records."]
    state, entry = hardest
    area = entry.auc[state]
    if math.isnan(area.low):
        return ["With a single specimen the indicators below describe that specimen; they say nothing about others."]
    turned = entry.turned(state)
    falls = turned is not area
    states = {name for other in found for name in other.auc}
    which = f"The state hardest to tell from healthy is {state}" if len(states) > 1 else f"The damaged state is {state}"
    return [
        f"{which}: the best of {counted(len(found), 'single indicator')}, {entry.feature}, which "
        f"{'falls' if falls else 'rises'} with damage, reaches an AUC of {turned.value:.2f} ({limits(turned)}; chosen "
        "on the same specimens, therefore optimistic)."
    ]


def area_sentence(found: list[Separability]) -> list[str]:
    """Say which single indicator follows the damaged area best; nothing where none is defined."""
    followed = [entry for entry in found if math.isfinite(entry.spearman.value)]
    if not followed:
        return []
    best = max(followed, key=lambda entry: abs(entry.spearman.value))
    return [
        f"The damaged area is followed best by {best.feature} (rank correlation {signed(best.spearman.value)}, "
        f"{signed_limits(best.spearman)})."
    ]


def hardest_state(found: list[Separability]) -> tuple[str, Separability] | None:
    """Return the state whose best single indicator is weakest, and that indicator."""
    best = best_by_state(found)
    if not best:
        return None
    state = min(best, key=lambda name: best[name].turned(name).value)
    return state, best[state]
