"""The summary of a report in five findings, written from its numbers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from diagnostics.judging.judgement import NETWORK, RMS_ALONE, SATURATED, TITLES, VALIDATION_AUROC, Comparison, Judged
from diagnostics.judging.of_split import Training
from diagnostics.page.wording import (
    capitalised,
    counted,
    decimal,
    joined,
    limits,
    percent,
    percent_limits,
    signed,
    signed_limits,
)
from diagnostics.records.record_classes import FAULT, STATE
from diagnostics.report.indicators import in_a_sentence
from diagnostics.statistics.evaluation import Interval
from diagnostics.statistics.indicator_statistics import Separability, best_by_state
from diagnostics.training.realism import meaning_of_scores

CHANCE_MARGIN = 0.1
"""A mean macro-AUROC under permuted labels that is farther from 0.5 than this is called suspicious."""

WEAK = 0.75
"""An AUC of the level below this is called weak."""

MANY_SPECIMENS = 20


def summary(config: dict[str, Any], training: Training | None, found: list[Separability]) -> list[str]:
    """Return the findings of the summary; the first says what scores on this set mean.

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
    """Say how often each classifier named the right state."""
    first = training.judged[0].scores
    noun = _noun(training)
    name = training.judged[0].name
    parts = [
        f"{capitalised(TITLES[judged.name])} "
        f"{f'names the right {noun}' if judged.name == name else 'does so'} in {percent(judged.scores.accuracy.value)}"
        f"{' of records' if judged.name == name else ''} ({percent_limits(judged.scores.accuracy)}, "
        f"macro-AUROC {decimal(judged.scores.macro_auroc.value)})."
        for judged in training.judged
    ]
    return (
        f"{' '.join(parts)} There are {counted(len(first.classes), noun)}. Always naming the most frequent one gives "
        f"{percent(first.guess)}. The test has {counted(first.records, 'record')} of "
        f"{counted(first.specimens, 'specimen')}."
    )


def _noun(training: Training) -> str:
    if training.split.kind == FAULT:
        return FAULT
    return STATE if all(len(states) == 1 for states in training.split.members.values()) else "class"


def comparison_sentence(training: Training) -> str:
    """Say what the classifier that validation specimens choose gains over RMS alone, and what the level alone finds.

    Choosing it by its test score would make that score optimistic; without validation scores all gains are told.
    """
    gains = {
        pair.first: pair.macro_auroc
        for pair in training.comparisons
        if pair.second == RMS_ALONE and math.isfinite(pair.macro_auroc.value)
    }
    if not gains:
        return "Nothing can be compared with RMS alone: macro-AUROC is undefined on these test specimens."
    validated = {judged.name: judged.details.get(VALIDATION_AUROC, math.nan) for judged in training.judged}
    if all(math.isfinite(validated[name]) for name in gains):
        best = max(gains, key=lambda name: validated[name])
        text = f"{_gain(TITLES[best], gains[best], len(gains))}{_between(training, best, gains, validated)}"
    else:
        told = [f"{TITLES[name]} {signed(gain.value)} ({signed_limits(gain)})" for name, gain in gains.items()]
        text = f"The paired differences of macro-AUROC from RMS alone are: {joined(told)}."
    severe = training.rms_severe
    if severe is None or math.isnan(severe.value):
        return text
    if severe.value > SATURATED:
        return (
            f"{text} RMS alone already separates the most severe state from healthy with an AUC of "
            f"{severe.value:.2f}. Scores on this set therefore say little about finer methods."
        )
    only = " only" if severe.value < WEAK else ""
    return f"{text} RMS alone separates the most severe state from healthy with{only} an AUC of {severe.value:.2f}."


def _gain(title: str, gain: Interval, count: int) -> str:
    spread = signed_limits(gain) if math.isnan(gain.low) else f"{signed_limits(gain)}, paired"
    chosen = " It is the best classifier on the validation specimens." if count > 1 else ""
    if gain.value <= 0.0:
        lost = f"its macro-AUROC differs by {signed(gain.value)} ({spread})"
        return f"{capitalised(title)} does not beat RMS alone: {lost}.{chosen}"
    doubt = " This gain cannot be distinguished from zero." if gain.low <= 0.0 else ""
    return f"{capitalised(title)} gains {signed(gain.value)} of macro-AUROC over RMS alone ({spread}).{doubt}{chosen}"


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
        return f" The {_short(rival)} cannot be distinguished from it."
    return f" The {_short(rival)} differs from it by {signed(found.value)} ({signed_limits(found)})."


def _turned(pair: Comparison, first: str) -> Interval:
    """Return the difference of macro-AUROC of `first` and the other one of the pair."""
    area = pair.macro_auroc
    return area if pair.first == first else Interval(-area.value, -area.high, -area.low)


def _short(name: str) -> str:
    return TITLES[name] if name == NETWORK else f"best of the others, {TITLES[name]},"


def trust_sentence(training: Training) -> str:
    """Say how certain the scores are and what permuted labels give."""
    return f"{certainty_sentence(training)} {control_sentence(training)}".rstrip()


def certainty_sentence(training: Training) -> str:
    """Say how far few specimens limit what the scores can tell."""
    specimens = training.judged[0].scores.specimens
    if specimens == 1:
        return "A single test specimen gives no intervals. Nothing is known about other gearboxes."
    few = " They are wide, because there are few." if specimens < MANY_SPECIMENS else ""
    return (
        f"The 95\N{NO-BREAK SPACE}% limits hold for the {specimens} test specimens: records of one specimen do not "
        f"count as several.{few}"
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
        f"This is too far from chance (0.5) for {joined(suspicious)}: the scoring is biased. Do not trust these scores."
        if suspicious
        else "Chance is 0.5: the control shows no bias of the scoring. No gearbox is in two splits (no leakage)."
    )
    given = joined([_control(judged) for judged in shown])
    return f"Training on permuted labels gives a macro-AUROC of {given}. {verdict}"


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
        return ["No single indicator can be judged: the set lacks healthy or damaged records."]
    state, entry = hardest
    area = entry.auc[state]
    if math.isnan(area.low):
        return ["The indicators below describe too few gearboxes to say anything about others."]
    turned = entry.turned(state)
    falls = turned is not area
    states = {name for other in found for name in other.auc}
    which = f"The state {state} is the hardest to find" if len(states) > 1 else f"The damaged state is {state}"
    return [
        f"{which}. The best of {counted(len(found), 'single indicator')} is "
        f"{in_a_sentence(entry.feature, entry.gears)}, which "
        f"{'falls' if falls else 'rises'} with damage. It separates {state} from healthy with an AUC of "
        f"{turned.value:.2f} ({limits(turned)}). This value is optimistic: the indicator was chosen on the same "
        "specimens."
    ]


def area_sentence(found: list[Separability]) -> list[str]:
    """Say which single indicator follows the damaged area best; nothing where none is defined."""
    followed = [entry for entry in found if math.isfinite(entry.spearman.value)]
    if not followed:
        return []
    best = max(followed, key=lambda entry: abs(entry.spearman.value))
    return [
        f"The indicator {in_a_sentence(best.feature, best.gears)} follows the damaged area best (rank correlation "
        f"{signed(best.spearman.value)}, {signed_limits(best.spearman)})."
    ]


def hardest_state(found: list[Separability]) -> tuple[str, Separability] | None:
    """Return the state whose best single indicator is weakest, and that indicator."""
    best = best_by_state(found)
    if not best:
        return None
    state = min(best, key=lambda name: best[name].turned(name).value)
    return state, best[state]
