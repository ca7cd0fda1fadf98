"""The summary says nothing that its numbers cannot carry."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from diagnostics.comparison import Comparison
from diagnostics.evaluation import Interval
from diagnostics.report.sentences import area_sentence, comparison_sentence, indicator_sentences
from diagnostics.separability import Separability


def indicator(low: float, high: float) -> Separability:
    return Separability("fm4__a", {"slight": Interval(0.9, low, high)}, Interval(0.5, low, high), 1.0)


def test_one_specimen_makes_no_statement_about_others() -> None:
    sentences = indicator_sentences([indicator(math.nan, math.nan)])
    assert len(sentences) == 1
    assert "nothing about others" in sentences[0]
    assert "nan" not in sentences[0]


def test_several_specimens_name_the_hardest_state_with_its_interval() -> None:
    (first,) = indicator_sentences([indicator(0.8, 0.95)])
    (second,) = area_sentence([indicator(0.8, 0.95)])
    assert "0.90 (0.80 to 0.95" in first
    assert "+0.50" in second


def training(severe: float, network: tuple[float, float, float]) -> Any:
    """A training in which boosting is ahead of RMS, and the network differs from boosting as given."""

    def pair(first: str, second: str, *gain: float) -> Comparison:
        return Comparison(first, second, Interval(*gain), Interval(*gain))

    pairs = (
        pair("boosting", "network", *network),
        pair("boosting", "rms", 0.3, 0.2, 0.4),
        pair("network", "rms", 0.2, 0.1, 0.3),
    )
    return SimpleNamespace(comparisons=pairs, rms_severe=Interval(severe, severe, severe))


@pytest.mark.parametrize(("severe", "text"), [(0.97, "already tells"), (0.95, "AUC of 0.95 only"), (0.5, "0.50 only")])
def test_a_level_that_finds_severe_damage_by_itself_is_said(severe: float, text: str) -> None:
    sentence = comparison_sentence(training(severe, (0.1, -0.05, 0.2)))
    assert text in sentence
    assert "gradient boosting on indicators gains +0.30 of macro-AUROC (+0.20 to +0.40, paired)" in sentence


def test_the_network_is_ahead_or_behind_only_where_the_paired_interval_says_so() -> None:
    assert "cannot be told apart" in comparison_sentence(training(0.5, (0.1, -0.05, 0.2)))
    assert "1-D network being -0.10 from it (-0.15 to -0.05)" in comparison_sentence(training(0.5, (0.1, 0.05, 0.15)))
