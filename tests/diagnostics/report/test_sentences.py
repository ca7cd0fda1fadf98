"""The summary says nothing that its numbers cannot carry, and reads well with few of everything."""

from __future__ import annotations

import math
import re
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnostics.judging.judgement import VALIDATION_AUROC, Comparison
from diagnostics.page.wording import counted, joined, percent, signed
from diagnostics.report.sentences import (
    CLASSIFIERS,
    area_sentence,
    comparison_sentence,
    control_sentence,
    scores_sentence,
    trust_sentence,
)
from diagnostics.statistics.evaluation import Interval
from diagnostics.statistics.indicator_statistics import Separability

NAN = math.nan
UNDEFINED = Interval(NAN, NAN, NAN)
ASKED = {"rms": 0.5, "fm4": -0.8}


def test_the_indicator_that_follows_the_damaged_area_best_is_named_and_none_where_none_is_defined() -> None:
    found = [Separability(f"{name}__a", {}, Interval(at, at - 0.1, at + 0.1), 1.0) for name, at in ASKED.items()]
    assert area_sentence(found).startswith(
        "The indicator fm4 at a follows the damaged area best (rank correlation \u2212"
    )
    assert area_sentence([Separability("rms__a", {}, UNDEFINED, 1.0)]) == ""


def classifier(
    name: str, accuracy: Interval, area: float, specimens: int, permuted: list[float], validated: float
) -> Any:
    scores = SimpleNamespace(
        accuracy=accuracy,
        macro_auroc=Interval(area, NAN, NAN),
        records=specimens,
        specimens=specimens,
        classes=("h", "s"),
        guess=0.5,
    )
    details = {VALIDATION_AUROC: validated} if math.isfinite(validated) else {}
    return SimpleNamespace(name=name, scores=scores, permuted_auroc=np.array(permuted), details=details)


def training(
    severe: float = 0.5,
    network: tuple[float, float, float] | None = (0.1, -0.05, 0.2),
    gains: tuple[float, float] = (0.3, 0.2),
    specimens: int = 5,
    share: float = 0.6,
    validated: tuple[float, float] = (0.8, 0.7),
) -> Any:
    """A training in which boosting and the network gain over RMS as given, and boosting differs from the network."""

    def pair(first: str, second: str, *gain: float) -> Comparison:
        return Comparison(first, second, Interval(*gain), Interval(*gain))

    def around(value: float) -> tuple[float, float, float]:
        return (value, value - 0.1, value + 0.1) if specimens > 1 else (value, NAN, NAN)

    limits = Interval(share, share - 0.1, share + 0.1) if specimens > 1 else Interval(share, NAN, NAN)
    pairs = [pair("boosting", "rms", *around(gains[0]))]
    if network:
        pairs += [pair("boosting", "network", *network), pair("network", "rms", *around(gains[1]))]
    names = ("boosting", "rms", *(("network",) if network else ()))
    areas = {"boosting": validated[0], "network": validated[1], "rms": 0.5}
    control = {"boosting": [0.49, 0.52]}
    judged = [classifier(name, limits, 0.8, specimens, control.get(name, []), areas[name]) for name in names]
    split = SimpleNamespace(members={"h": ("h",), "s": ("s",)}, kind="state")
    return SimpleNamespace(comparisons=pairs, rms_severe=Interval(severe, severe, severe), judged=judged, split=split)


@pytest.mark.parametrize(
    ("severe", "text"),
    [
        (0.97, "already separates"),
        (0.95, "with an AUC of 0.95."),
        (0.5, "with only an AUC of 0.50."),
        (NAN, "distinguished from it."),
    ],
)
def test_a_level_that_finds_severe_damage_by_itself_is_said(severe: float, text: str) -> None:
    sentence = comparison_sentence(training(severe))
    assert text in sentence
    gain = "Gradient boosting on indicators gains +0.30 of macro-AUROC over RMS alone (+0.20 to +0.40, paired)."
    assert sentence.startswith(f"{gain} It is the best classifier on the validation specimens.")


def test_the_network_is_ahead_or_behind_only_where_the_paired_interval_says_so() -> None:
    assert "The 1-D network cannot be distinguished from it." in comparison_sentence(training())
    sentence = comparison_sentence(training(network=(0.1, 0.05, 0.15))).replace("\N{MINUS SIGN}", "-")
    assert "The 1-D network differs from it by -0.10 (-0.15 to -0.05)." in sentence


def test_a_network_that_is_best_is_compared_with_the_best_of_the_others() -> None:
    ahead = training(network=(-0.1, -0.15, -0.05), gains=(0.2, 0.3), validated=(0.7, 0.8))
    sentence = comparison_sentence(ahead).replace("\N{MINUS SIGN}", "-")
    assert sentence.startswith("1-D network gains +0.30 of macro-AUROC over RMS alone")
    assert "It is the best classifier on the validation specimens." in sentence
    assert "best of the others, gradient boosting on indicators, differs from it by -0.10 (-0.15 to -0.05)" in sentence
    alike = comparison_sentence(training(network=(-0.1, -0.15, 0.05), gains=(0.2, 0.3), validated=(0.7, 0.8)))
    assert "The best of the others, gradient boosting on indicators, cannot be distinguished from it." in alike


def test_a_gain_that_may_be_none_is_not_sold_as_one() -> None:
    doubtful = comparison_sentence(training(gains=(0.05, 0.0))).replace("\N{MINUS SIGN}", "-")
    assert "gains +0.05 of macro-AUROC over RMS alone (-0.05 to +0.15, paired)" in doubtful
    assert "This gain cannot be distinguished from zero." in doubtful
    behind = comparison_sentence(training(gains=(-0.05, -0.1))).replace("\N{MINUS SIGN}", "-")
    name = "Gradient boosting on indicators"
    assert behind.startswith(f"{name} does not beat RMS alone: its macro-AUROC differs by -0.05 (")


def test_the_classifier_that_is_compared_is_the_best_on_validation_not_on_test() -> None:
    sentence = comparison_sentence(training(gains=(0.2, 0.4), validated=(0.8, 0.7)))
    assert sentence.startswith("Gradient boosting on indicators gains +0.20")
    assert "It is the best classifier on the validation specimens." in sentence


def test_without_validation_scores_no_classifier_is_called_the_best() -> None:
    sentence = comparison_sentence(training(validated=(NAN, NAN)))
    assert "gradient boosting on indicators +0.30 (+0.20 to +0.40) and 1-D network +0.20" in sentence
    assert "best" not in sentence


def test_a_set_without_network_has_no_word_about_it() -> None:
    alone = training(network=None)
    text = " ".join([scores_sentence(alone), comparison_sentence(alone), trust_sentence(alone)])
    assert "network" not in text
    first = "Gradient boosting on indicators names the right state in 60\xa0% of records"
    assert text.startswith(f"{first} (50\xa0% to 70\xa0%, macro-AUROC 0.80). RMS alone does so in 60\xa0% (")


def test_one_test_specimen_has_no_interval_and_no_plural() -> None:
    single = training(specimens=1, network=(0.1, NAN, NAN))
    text = " ".join([scores_sentence(single), comparison_sentence(single), trust_sentence(single)])
    assert "The test has 1\xa0record of 1\xa0specimen." in text
    assert "no interval from so few gearboxes" in text
    assert "A single test specimen gives no intervals" in text
    assert not re.search(r"\bnan\b|\b1\s\w+s\b", text)


def test_undefined_scores_are_called_undefined() -> None:
    lost = training()
    lost.comparisons = [Comparison("boosting", "rms", UNDEFINED, UNDEFINED)]
    for found in lost.judged:
        found.scores.macro_auroc = UNDEFINED
    assert "macro-AUROC undefined" in scores_sentence(lost)
    assert "macro-AUROC is undefined" in comparison_sentence(lost)
    assert "nan" not in scores_sentence(lost) + comparison_sentence(lost)


@pytest.mark.parametrize(("specimens", "is_wide"), [(5, True), (40, False)])
def test_limits_of_few_specimens_are_said_to_be_wide(specimens: int, is_wide: bool) -> None:
    sentence = CLASSIFIERS.certainty(specimens)
    assert f"hold for the {specimens} test specimens" in sentence
    assert ("They are wide, because there are few." in sentence) == is_wide


def test_a_control_off_chance_takes_the_scores_back_and_none_says_nothing() -> None:
    off = training()
    assert "the control shows no bias of the scoring. No gearbox is in two splits" in control_sentence(off)
    off.judged[0].permuted_auroc = np.array([0.7, 0.75, NAN])
    assert "too far from chance (0.5) for gradient boosting on indicators: the scoring is biased" in control_sentence(
        off
    )
    assert "2 runs" in control_sentence(off)
    for found in off.judged:
        found.permuted_auroc = np.array([])
    assert control_sentence(off) == ""
    assert "permuted" not in trust_sentence(off)


def test_sentences_are_short_and_hold_one_thought() -> None:
    for sentence in (scores_sentence(training()), comparison_sentence(training()), trust_sentence(training())):
        assert sentence.endswith(".")
        # none has a semicolon or more than 40 words
        assert ";" not in sentence
        assert max(len(part.split()) for part in re.split(r"(?<=[.]) (?=[A-Z1])", sentence)) <= 40


def test_words_for_numbers() -> None:
    assert [counted(k, "gearbox") for k in (0, 1, 2)] == ["0\xa0gearboxes", "1\xa0gearbox", "2\xa0gearboxes"]
    assert [counted(2, noun) for noun in ("class", "piece")] == ["2\xa0classes", "2\xa0pieces"]
    assert [joined(parts) for parts in (["a"], ["a", "b"], ["a", "b", "c"])] == ["a", "a and b", "a, b and c"]
    assert [signed(value) for value in (0.1, -0.1, 0.001, -0.001)] == ["+0.10", "\N{MINUS SIGN}0.10", "0.00", "0.00"]
    assert percent(NAN) == "undefined"
