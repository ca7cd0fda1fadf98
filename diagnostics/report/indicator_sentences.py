"""What the evaluation of indicators says, in sentences a reader can quote."""

from __future__ import annotations

import math
from collections.abc import Sequence

from diagnostics.assessment.indicator_result import IndicatorResult
from diagnostics.assessment.multiple_tests import smallest_paired_p
from diagnostics.report.indicator_tables import size_limits

SIGNIFICANT = 0.05
WITH_HISTORY = ("na4_", "nb4_")


def indicator_findings(found: Sequence[IndicatorResult], states: tuple[str, ...], specimens: int) -> list[str]:
    """Return the findings: best in each design, how many survive the correction, smallest size, what limits it all."""
    if not states:
        return ["The set has no damaged state: indicators stand in the tables, and nothing can be told apart."]
    if specimens < 2:
        return ["With a single specimen the numbers below describe that specimen; they say nothing about others."]
    sentences = [*_best(found), *_per_state(found, states), *_survivors(found, states, specimens), *_smallest(found)]
    if any(result.indicator.startswith(WITH_HISTORY) for result in found):
        sentences.append(
            "NA4, NA4* and NB4 compare each record with the healthy and milder ones of its own specimen, in the true "
            "order of severity; among other specimens they therefore know more than the indicators of single records."
        )
    return sentences


def _best(found: Sequence[IndicatorResult]) -> list[str]:
    single = [r for r in found if math.isfinite(r.score_others.value) and not r.indicator.startswith(WITH_HISTORY)]
    if not single:
        return []
    other = max(single, key=lambda r: r.score_others.value)
    same = max(single, key=lambda r: r.score_same.value if math.isfinite(r.score_same.value) else -1.0)
    text = (
        f"Between other specimens {other.column} separates best among the indicators of single records: mean AUC over "
        f"the states {_limits(other)}."
    )
    if math.isfinite(same.score_same.value):
        text += (
            f" On the same specimen before and after it is {same.column}, which moves its way in "
            f"{same.score_same.value:.0%} of the pairs."
        )
    return [text]


def _limits(result: IndicatorResult) -> str:
    score = result.score_others
    return f"{score.value:.2f} ({score.low:.2f} to {score.high:.2f})"


def _per_state(found: Sequence[IndicatorResult], states: tuple[str, ...]) -> list[str]:
    parts = []
    for state in states:
        turned = [
            (0.5 + r.direction * (r.others[state].separation.value - 0.5), r.column)
            for r in found
            if math.isfinite(r.others[state].separation.value) and not r.indicator.startswith(WITH_HISTORY)
        ]
        if turned:
            value, column = max(turned)
            parts.append(f"{state} {value:.2f} ({column})")
    return [f"Best AUC of a single record's indicator by state: {'; '.join(parts)}. The best of many is optimistic."]


def _survivors(found: Sequence[IndicatorResult], states: tuple[str, ...], specimens: int) -> list[str]:
    count = len(found) * len(states)
    others, same = (
        sum(r.holm < SIGNIFICANT for entry in found for r in getattr(entry, design).values())
        for design in ("others", "same")
    )
    mild = sum(r.false_discovery < SIGNIFICANT for entry in found for r in entry.same.values())
    text = (
        f"Of {count} comparisons (indicator, channel, state), {others} between other specimens and {same} on the same "
        f"specimen survive Holm's correction at {SIGNIFICANT:g}; {mild} on the same specimen stay below a false "
        "discovery rate of 5 %."
    )
    if smallest_paired_p(specimens) * count > SIGNIFICANT:
        needed = math.ceil(1.0 + math.log2(count / SIGNIFICANT))
        least = f"{smallest_paired_p(specimens):.2g}"
        text += (
            f" With {specimens} specimens the paired test cannot give less than p = {least}, so Holm's correction of "
            f"{count} comparisons needs at least {needed} specimens to let any pass."
        )
    return [text]


def _smallest(found: Sequence[IndicatorResult]) -> list[str]:
    name = "others_area_mm2_a90"
    reached = [r for r in found if name in r.detectable and math.isfinite(r.detectable[name].value)]
    reached = [r for r in reached if not r.indicator.startswith(WITH_HISTORY)]
    if not reached:
        return ["No single indicator finds 90 % of any size of damage at this rate of false alarms."]
    best = min(reached, key=lambda r: (r.detectable[name].value, -r.score_others.value))
    size = best.detectable[name]
    at_most = "at most " if size.value <= best.smallest_size["others_area_mm2"] * (1 + 1e-9) else ""
    return [
        f"The smallest damaged area that is found with 90 % probability is {at_most}{size.value:.3g} mm² "
        f"({size_limits(size)}), by {best.column}."
    ]
