"""The findings of the page of indicators, with few states, few specimens and nothing defined."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import pytest

from diagnostics.page.blocks import Page
from diagnostics.page.template import page_html
from diagnostics.records.gear_train import PAIR
from diagnostics.report.indicators import best_by_state, indicator_findings, own_ranks, undefined_table
from diagnostics.statistics.evaluation import UNDEFINED, Interval
from diagnostics.statistics.indicator_statistics import IndicatorResult, StateResult

NAN = math.nan


def state(value: float, p_value: float = 0.001, holm: float = 0.01) -> StateResult:
    found = Interval(value, value - 0.1, value + 0.1)
    return StateResult(found, found, p_value, holm, holm)


def result(
    name: str, others: dict[str, StateResult], size: Interval = UNDEFINED, direction: int = 1
) -> IndicatorResult:
    values = [r.separation.value for r in others.values()]
    score = Interval(0.5 + direction * (sum(values) / len(values) - 0.5), 0.6, 0.9) if values else UNDEFINED
    found = IndicatorResult(
        f"{name}__x", name, "x", direction, others, others, score, score, UNDEFINED, UNDEFINED, UNDEFINED, 0.9, PAIR
    )
    found.detectable, found.smallest_size = {"others_area_mm2_a90": size}, {"others_area_mm2": 2.0}
    return found


def test_two_states_give_four_sentences_that_name_hardest_and_easiest() -> None:
    falls = result("fm4", {"slight": state(0.4), "severe": state(0.05)}, Interval(8.0, 6.0, math.inf), direction=-1)
    rises = result("rms", {"slight": state(0.55), "severe": state(0.8)})
    found = indicator_findings([falls, rises], ("slight", "severe"), 24)
    assert len(found) == 4
    assert "fm4 at x separates best" in found[0]
    assert "It is also the best on the same specimen" in found[0]
    assert "slight is the hardest to find: its best single indicator, fm4 at x, reaches an AUC of 0.60." in found[1]
    assert "severe is the easiest: fm4 at x reaches 0.95." in found[1]
    assert "optimistic" in found[1]
    assert "correction at 0.05, 4 of 4\xa0comparisons between different specimens are significant" in found[2]
    assert "The indicator fm4 at x finds the smallest damaged area: 8\xa0mm² (6 to ∞) with 90\xa0%" in found[3]


def test_one_state_and_one_survivor_are_in_the_singular() -> None:
    found = indicator_findings([result("rms", {"slight": state(0.9)}, Interval(2.0, 2.0, 2.0))], ("slight",), 24)
    text = " ".join(found)
    assert "with an AUC of 0.90" in found[0]
    assert "1 of 1\xa0comparison between different specimens is significant" in text
    assert "On the same specimen, 1 is below" in text
    assert "at most 2\xa0mm²" in text
    assert "hardest" not in text


def test_few_specimens_are_told_how_many_a_correction_takes() -> None:
    (text,) = [t for t in indicator_findings([result("rms", {"slight": state(0.9)})], ("slight",), 4) if "Holm" in t]
    # 2^(1 - n) below 0.05 for one comparison: n = 6
    assert "At least 6 specimens are needed before any of 1\xa0comparison can pass" in text


def test_an_own_indicator_is_told_its_rank_by_its_best_channel_and_none_without_damage() -> None:
    rises, mine = result("rms", {"slight": state(0.8)}), result("crest", {"slight": state(0.7)})
    worse = replace(mine, column="crest__y", channel="y")
    found = SimpleNamespace(results=[rises, mine, worse], records=SimpleNamespace(states=("slight",)))
    (said,) = own_ranks(found)
    assert said.startswith("Your indicator crest at x has rank 2 of 3 columns")
    assert "AUC over the states 0.70 (0.60 to 0.90), 0.5 is chance." in said
    assert own_ranks(SimpleNamespace(results=[mine], records=SimpleNamespace(states=()))) == []
    mine.score_others = UNDEFINED
    (said,) = own_ranks(SimpleNamespace(results=[mine], records=SimpleNamespace(states=("slight",))))
    assert "has no rank" in said
    assert "nan" not in said


def test_nothing_defined_is_said_and_no_number_is_made_up() -> None:
    lost = result("rms", {"slight": StateResult(UNDEFINED, UNDEFINED, NAN)})
    lost.score_others = lost.score_same = UNDEFINED
    text = " ".join(indicator_findings([lost], ("slight",), 5))
    for part in ("No indicator can be judged", "No difference could be tested", "too few healthy or damaged records"):
        assert part in text
    assert "nan" not in text
    assert "inf" not in text
    assert best_by_state([lost], ("slight",)) == {}


@pytest.mark.parametrize(
    ("states", "specimens", "text"),
    [
        ((), 24, "no damaged state"),
        (("slight",), 1, "the set has a single specimen"),
        (("slight",), 2, "the set has 2 specimens"),
    ],
)
def test_sets_that_allow_no_finding(states: tuple[str, ...], specimens: int, text: str) -> None:
    (sentence,) = indicator_findings([result("rms", {"slight": state(0.9)})], states, specimens)
    assert text in sentence
    assert "rms" not in sentence


def test_indicators_that_lack_only_records_that_were_left_out_are_not_called_undefined() -> None:
    found = [result("rms", {"slight": state(0.9)}), result("fm4", {"slight": state(0.9)})]
    found[1].defined_share = 0.7
    page = page_html(Page("x", [undefined_table(found, {"x": 0.1})]))  # both lack a tenth; fm4 lacks two more
    assert "rms__x" not in page
    assert "<td>20.0</td>" in page
    assert not undefined_table(found[:1], {"x": 0.1})
