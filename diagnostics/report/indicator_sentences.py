"""What the evaluation of indicators says, in sentences a reader can quote."""

from __future__ import annotations

import math
from collections.abc import Sequence

from diagnostics.page.wording import counted, limits, percent
from diagnostics.report.indicator_figures import in_a_sentence
from diagnostics.statistics.indicator_result import IndicatorResult
from diagnostics.statistics.multiple_tests import smallest_paired_p

SIGNIFICANT = 0.05
FEWEST_SPECIMENS = 3
"""Of which a summary speaks: fewer give no test, and an interval of two points."""

WITH_HISTORY = ("na4_", "nb4_")


def indicator_findings(found: Sequence[IndicatorResult], states: tuple[str, ...], specimens: int) -> list[str]:
    """Return four findings: best in each design, hardest and easiest state, what survives, the smallest size found."""
    if not states:
        return ["The set has no damaged state, so no separation can be judged. The tables give the indicators."]
    if specimens < FEWEST_SPECIMENS:
        whose, those = ("a single specimen", "it") if specimens == 1 else (f"{specimens} specimens", "them")
        return [
            f"No best indicator is named, because the set has {whose}. The numbers below describe {those} and say "
            f"nothing about others. At least {FEWEST_SPECIMENS} specimens are needed."
        ]
    return [*_best(found, states), *_by_state(found, states), *_survivors(found, specimens), *_smallest(found)]


def single_records(found: Sequence[IndicatorResult]) -> list[IndicatorResult]:
    """Return the indicators that know nothing but their own record."""
    return [result for result in found if not result.indicator.startswith(WITH_HISTORY)]


def _best(found: Sequence[IndicatorResult], states: tuple[str, ...]) -> list[str]:
    single = [r for r in single_records(found) if math.isfinite(r.score_others.value)]
    if not single:
        return ["No indicator can be judged between specimens: values or healthy records are missing."]
    other = max(single, key=lambda r: r.score_others.value)
    what = "AUC" if len(states) == 1 else "mean AUC over the states"
    text = (
        f"The indicator {in_a_sentence(other.column, other.gears)} separates best between different specimens, with "
        f"{'an' if len(states) == 1 else 'a'} {what} of {other.score_others.value:.2f} ({limits(other.score_others)}). "
        "Only indicators of single records are compared here."
    )
    paired = [r for r in single if math.isfinite(r.score_same.value)]
    if not paired:
        return [text]
    same = max(paired, key=lambda r: r.score_same.value)
    who = "It is also" if same is other else f"The indicator {in_a_sentence(same.column, same.gears)} is"
    return [
        f"{text} {who} the best on the same specimen before and after damage: it moves in its "
        f"direction in {percent(same.score_same.value)} of the pairs."
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
    said = {state: in_a_sentence(best[state][1], found[0].gears) for state in (hardest, easiest)}
    return [
        f"The state {hardest} is the hardest to find: its best single indicator, {said[hardest]}, "
        f"reaches an AUC of {best[hardest][0]:.2f}. The state {easiest} is the easiest: "
        f"{said[easiest]} reaches {best[easiest][0]:.2f}. These values are "
        f"optimistic, because each is the best of many."
    ]


def _survivors(found: Sequence[IndicatorResult], specimens: int) -> list[str]:
    others, same = ([r for entry in found for r in getattr(entry, design).values()] for design in ("others", "same"))
    tested = [sum(math.isfinite(r.p_value) for r in results) for results in (others, same)]
    if not any(tested):
        return ["No difference could be tested: a test needs three specimens with healthy and damaged records."]
    kept = [sum(r.holm < SIGNIFICANT for r in results) for results in (others, same)]
    mild = sum(r.false_discovery < SIGNIFICANT for r in same)
    text = (
        f"After Holm's correction at {SIGNIFICANT:g}, {kept[0]} of {counted(tested[0], 'comparison')} between "
        f"different specimens {_is(kept[0])} significant, and {kept[1]} of {tested[1]} on the same specimen. A "
        f"comparison is one indicator, channel and state. On the same specimen, {mild} {_is(mild)} below a false "
        "discovery rate of 5\N{NO-BREAK SPACE}%."
    )
    if smallest_paired_p(specimens) * tested[1] <= SIGNIFICANT:
        return [text]
    needed = math.ceil(1.0 + math.log2(tested[1] / SIGNIFICANT))
    least = f"{smallest_paired_p(specimens):.2g}"
    return [
        f"{text} With {counted(specimens, 'specimen')} the paired test cannot give less than p = {least}. "
        f"At least {needed} specimens are needed before any of {counted(tested[1], 'comparison')} can pass Holm's "
        "correction."
    ]


def _is(number: int) -> str:
    return "is" if number == 1 else "are"


def _smallest(found: Sequence[IndicatorResult]) -> list[str]:
    name = "others_area_mm2_a90"
    judged = [r for r in single_records(found) if name in r.detectable and not math.isnan(r.detectable[name].value)]
    reached = [r for r in judged if math.isfinite(r.detectable[name].value)]
    if not judged:
        return ["The smallest damage that is found is not known: there are too few healthy or damaged records."]
    if not reached:
        return [
            "No single indicator finds 90\N{NO-BREAK SPACE}% of the damage of any size. This is between different "
            "specimens, at the chosen rate of false alarms."
        ]
    best = min(reached, key=lambda r: (r.detectable[name].value, -r.score_others.value))
    size = best.detectable[name]
    at_most = "at most " if size.value <= best.smallest_size["others_area_mm2"] * (1 + 1e-9) else ""
    return [
        f"The indicator {in_a_sentence(best.column, best.gears)} finds the smallest damaged area: "
        f"{at_most}{size.value:.3g}\N{NO-BREAK SPACE}mm² ({size_text(size.low)} to {size_text(size.high)}) "
        f"with 90\N{NO-BREAK SPACE}% probability."
    ]


def size_text(size: float) -> str:
    """Return a size, or the sign for one that is not reached."""
    return f"{size:.3g}" if math.isfinite(size) else "∞"
