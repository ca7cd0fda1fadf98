"""What the evaluation of indicators says, in sentences a reader can quote."""

from __future__ import annotations

import math
from collections.abc import Sequence

from diagnostics.page.wording import counted, limits, percent
from diagnostics.report.indicator_tables import size_text
from diagnostics.statistics.indicator_result import IndicatorResult
from diagnostics.statistics.multiple_tests import smallest_paired_p

SIGNIFICANT = 0.05
FEWEST_SPECIMENS = 3
"""Of which a summary speaks: fewer give no test, and an interval of two points."""

WITH_HISTORY = ("na4_", "nb4_")


def indicator_findings(found: Sequence[IndicatorResult], states: tuple[str, ...], specimens: int) -> list[str]:
    """Return four findings: best in each design, hardest and easiest state, what survives, the smallest size found."""
    if not states:
        return ["The set has no damaged state: indicators stand in the tables, and nothing can be told apart."]
    if specimens < FEWEST_SPECIMENS:
        whose, those = ("a single specimen", "that specimen") if specimens == 1 else (f"{specimens} specimens", "those")
        return [
            f"With {whose} the numbers below describe {those} and name no best indicator: they say nothing about "
            f"others. It takes {FEWEST_SPECIMENS} specimens at least."
        ]
    return [*_best(found, states), *_by_state(found, states), *_survivors(found, specimens), *_smallest(found)]


def single_records(found: Sequence[IndicatorResult]) -> list[IndicatorResult]:
    """Return the indicators that know nothing but their own record."""
    return [result for result in found if not result.indicator.startswith(WITH_HISTORY)]


def _best(found: Sequence[IndicatorResult], states: tuple[str, ...]) -> list[str]:
    single = [r for r in single_records(found) if math.isfinite(r.score_others.value)]
    if not single:
        return ["No indicator can be judged between specimens: its values or the healthy records are missing."]
    other = max(single, key=lambda r: r.score_others.value)
    what = "AUC" if len(states) == 1 else "mean AUC over the states"
    text = (
        f"Between other specimens {other.column} separates best among the indicators of single records, with "
        f"{'an' if len(states) == 1 else 'a'} {what} of {other.score_others.value:.2f} ({limits(other.score_others)})"
    )
    paired = [r for r in single if math.isfinite(r.score_same.value)]
    if not paired:
        return [f"{text}."]
    same = max(paired, key=lambda r: r.score_same.value)
    return [
        f"{text}; on the same specimen before and after it is {'also ' if same is other else ''}{same.column}, which "
        f"moves its way in {percent(same.score_same.value)} of the pairs."
    ]


def best_by_state(found: Sequence[IndicatorResult], states: tuple[str, ...]) -> dict[str, tuple[float, str]]:
    """Return by state the best AUC between other specimens, turned by direction, and whose it is."""
    best = {}
    for state in states:
        turned = [
            (0.5 + r.direction * (r.others[state].separation.value - 0.5), r.column)
            for r in single_records(found)
            if math.isfinite(r.others[state].separation.value)
        ]
        if turned:
            best[state] = max(turned)
    return best


def _by_state(found: Sequence[IndicatorResult], states: tuple[str, ...]) -> list[str]:
    best = best_by_state(found, states)
    if not best:
        return []
    if len(best) == 1:
        return []  # the sentence before has said it
    hardest, easiest = (chosen(best, key=lambda state: best[state][0]) for chosen in (min, max))
    return [
        f"By state the best single indicator reaches an AUC from {best[hardest][0]:.2f} for {hardest} "
        f"({best[hardest][1]}) to {best[easiest][0]:.2f} for {easiest} ({best[easiest][1]}); the best of many is "
        "optimistic."
    ]


def _survivors(found: Sequence[IndicatorResult], specimens: int) -> list[str]:
    others, same = ([r for entry in found for r in getattr(entry, design).values()] for design in ("others", "same"))
    tested = [sum(math.isfinite(r.p_value) for r in results) for results in (others, same)]
    if not any(tested):
        return ["No difference could be tested: a test needs three specimens, healthy and damaged."]
    kept = [sum(r.holm < SIGNIFICANT for r in results) for results in (others, same)]
    mild = sum(r.false_discovery < SIGNIFICANT for r in same)
    text = (
        f"Of {counted(tested[0], 'comparison')} between other specimens (indicator, channel, state) {kept[0]} "
        f"{_verb('survive', kept[0])} Holm's correction at {SIGNIFICANT:g}, of {tested[1]} on the same specimen "
        f"{kept[1]}; {mild} of the latter {_verb('stay', mild)} below a false discovery rate of 5\N{NO-BREAK SPACE}%"
    )
    if smallest_paired_p(specimens) * tested[1] <= SIGNIFICANT:
        return [f"{text}."]
    needed = math.ceil(1.0 + math.log2(tested[1] / SIGNIFICANT))
    least = f"{smallest_paired_p(specimens):.2g}"
    return [
        f"{text}; with {counted(specimens, 'specimen')} the paired test cannot give less than p = {least}, so that "
        f"Holm's correction needs at least {needed} specimens to let any of {counted(tested[1], 'comparison')} pass."
    ]


def _verb(verb: str, number: int) -> str:
    return f"{verb}s" if number == 1 else verb


def _smallest(found: Sequence[IndicatorResult]) -> list[str]:
    name = "others_area_mm2_a90"
    judged = [r for r in single_records(found) if name in r.detectable and not math.isnan(r.detectable[name].value)]
    reached = [r for r in judged if math.isfinite(r.detectable[name].value)]
    if not judged:
        return ["From which size on damage is found cannot be said: there are too few records, healthy or damaged."]
    if not reached:
        return [
            "No single indicator finds 90\N{NO-BREAK SPACE}% of any size of damage at this rate of false alarms "
            "between other specimens."
        ]
    best = min(reached, key=lambda r: (r.detectable[name].value, -r.score_others.value))
    size = best.detectable[name]
    at_most = "at most " if size.value <= best.smallest_size["others_area_mm2"] * (1 + 1e-9) else ""
    return [
        f"The smallest damaged area that is found with 90\N{NO-BREAK SPACE}% probability is {at_most}"
        f"{size.value:.3g}\N{NO-BREAK SPACE}mm² ({size_text(size.low)} to {size_text(size.high)}), by {best.column}."
    ]
