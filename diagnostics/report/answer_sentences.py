"""The answer of a report in a few sentences: which damage from which size on, by what, and how sure that is."""

from __future__ import annotations

import math

from diagnostics.page.wording import capitalised, counted, decimal, joined, limits, percent, percent_limits, rounded
from diagnostics.records.damage_kind import kind_name
from diagnostics.report.detector_table import picked
from diagnostics.report.indicator_terms import in_a_sentence
from diagnostics.statistics.detector import Detector, FoundSize, StateFound
from diagnostics.training.detectors import BOOSTED, CLASSIFIER, FEWEST_SPECIMENS, INDICATOR, NETWORKS, Detectors

SPACE = "\N{NO-BREAK SPACE}"
ERROR_FREE = (
    "The gears have no manufacturing errors, so any damage above the noise is trivial to separate: this says nothing "
    "about a real machine."
)
FOUND_MEANS = f"Found: the record gives an alarm, as 5{SPACE}% of healthy records do."
ON_ALL = " on all indicators"


def answer_sentences(found: Detectors, *, error_free: bool = False) -> list[tuple[str, str]]:
    """Return the answers, each with its question in a few words.

    Parameters
    ----------
    found : Detectors
    error_free : bool
        Whether the gears have no manufacturing errors, so that any damage above the noise is separated.
    """
    best = found.strongest
    if best is None:
        return [
            (
                "No answer",
                "This set cannot say which damage is found. That needs healthy and damaged records of "
                f"{FEWEST_SPECIMENS} gearboxes or more.",
            )
        ]
    return [
        ("From which size", size_sentence(best)),
        ("By what", detector_sentence(found, best)),
        ("With a healthy record of the same gearbox", reference_sentence(found)),
        ("How sure", " ".join([*([ERROR_FREE] if error_free else []), certainty_sentence(best)])),
    ]


def size_sentence(best: Detector) -> str:
    """Say of every kind of damage from which area on nine of ten records are found, or how many of its largest are."""
    if not best.sizes:
        return (
            f"No size can be named: {counted(best.healthy, 'healthy record')} set no threshold with 5{SPACE}% false "
            f"alarms. {_easiest(best)}"
        )
    kinds = list(dict.fromkeys(state.kind for state in best.states.values()))
    said = [_kind_sentence(best, kind, best.sizes.get(kind), kind_name(kind, kinds)) for kind in kinds]
    return " ".join([*said, FOUND_MEANS])


def _easiest(best: Detector) -> str:
    name = max(best.states, key=lambda state: best.states[state].auc.value)
    return f"The state {name} has the largest AUC: {decimal(best.states[name].auc.value)}."


def _kind_sentence(best: Detector, kind: str, size: FoundSize | None, name: str) -> str:
    """Say what is found of one kind; where the smallest or none is, the share of its records says how sure that is."""
    states = {state: found for state, found in best.states.items() if found.kind == kind}
    smallest = min(states, key=lambda state: states[state].area_mm2)
    largest = max(states, key=lambda state: states[state].area_mm2)
    if size is None:
        found = states[largest]
        return f"{capitalised(name)} of {_area(found.area_mm2)} is found in {_share(found)}."
    if size.is_bound:
        return (
            f"{capitalised(name)} is found in nine of ten records from {_area(size.smallest_mm2)} on, the smallest of "
            f"the set ({smallest}: {_share(states[smallest])})."
        )
    if size.reached:
        return f"{capitalised(name)} is found in nine of ten records from {_area_limits(size)}."
    return (
        f"{capitalised(name)}: nine of ten records are found at no size of the set. Of the largest ({largest}, up to "
        f"{_area(size.largest_mm2)}) it is {_share(states[largest])}."
    )


def _area_limits(size: FoundSize) -> str:
    """Return the area from which on damage is found, with its limits."""
    high = _area(size.area_mm2.high) if math.isfinite(size.area_mm2.high) else "beyond the largest of the set"
    return f"{_area(size.area_mm2.value)} on ({_area(size.area_mm2.low)} to {high})"


def _area(area_mm2: float) -> str:
    return f"{rounded(area_mm2)}{SPACE}mm²"


def _share(state: StateFound) -> str:
    if state.share is None:
        return "an unknown share"
    return f"{percent(state.share.value)} of records ({percent_limits(state.share)})"


def detector_sentence(found: Detectors, best: Detector) -> str:
    """Say what was chosen without a look at what it judges, and what each detector reaches by itself."""
    taken = picked(best.picks) if best.picks else f"always the {_title(best)}"
    first = (
        "Each group of gearboxes is judged by the detector that is best on the others (nested cross-validation): "
        f"{taken}. AUC {decimal(best.every.value)} ({limits(best.every)}) for all damage together; 0.5 is chance."
    )
    others = [
        _other(family, detector)
        for family in (BOOSTED, CLASSIFIER, INDICATOR, NETWORKS)
        if (detector := found.alone.get(family)) is not None and detector is not best
    ]
    said = [f"Each alone: {', '.join(others)}."] if others else []
    rivals = [found.alone[name].every.value for name in (BOOSTED, CLASSIFIER, INDICATOR) if name in found.alone]
    if max(rivals, default=0.0) > best.every.value:
        said.append("To pick the largest of these would use the answer.")
    if NETWORKS not in found.alone:
        said.append("No network was trained.")
    return " ".join([first, *said])


def _other(family: str, detector: Detector) -> str:
    where = f" on {counted(detector.specimens, 'test gearbox')} alone" if family == NETWORKS else ""
    return f"{_title(detector).removesuffix(ON_ALL)} {decimal(detector.every.value)} ({limits(detector.every)}){where}"


def _title(detector: Detector) -> str:
    if not detector.basis:
        return detector.title
    return f"{detector.title} ({in_a_sentence(detector.basis)})"


def certainty_sentence(best: Detector) -> str:
    """Say on what the numbers rest."""
    return (
        f"Judged on {counted(best.records, 'record')} of {counted(best.specimens, 'gearbox')}, each unseen by what "
        f"judges it. In brackets: 95{SPACE}% limits over gearboxes."
    )


def reference_sentence(found: Detectors) -> str:
    """Say what a healthy record of the same gearbox is worth, or why that is not known."""
    beside = found.strongest_referenced
    if beside is None:
        return "Not known: the set has one healthy record per gearbox (`repeats: 2` gives more)."
    kinds = list(dict.fromkeys(state.kind for state in beside.states.values()))
    reached = [
        f"{kind_name(kind, kinds)} from {_area_limits(size)}" for kind, size in beside.sizes.items() if size.reached
    ]
    sizes = f" Nine of ten records are then found of {joined(reached)}." if reached else ""
    by = picked(beside.picks) or f"the {beside.title}"
    return f"AUC {decimal(beside.every.value)} ({limits(beside.every)}) by {by}.{sizes}"
