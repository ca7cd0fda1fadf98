"""The summary says nothing that its numbers cannot carry."""

from __future__ import annotations

import math

from diagnostics.evaluation import Interval
from diagnostics.report.sentences import area_sentence, indicator_sentences
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
