"""The answer of a report in three sentences: which damage from which size on, by what, and how sure that is."""

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


def answer_sentences(found: Detectors, *, error_free: bool = False) -> list[tuple[str, str]]:
    """Return three answers, each with its question in two or three words.

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
    sure = [*([ERROR_FREE] if error_free else []), certainty_sentence(best), reference_sentence(found)]
    return [
        ("From which size", size_sentence(best)),
        ("By what", detector_sentence(found, best)),
        ("How sure", " ".join(sure)),
    ]


def size_sentence(best: Detector) -> str:
    """Say of every kind of damage from which area on nine of ten records give an alarm, or how many do."""
    if not best.sizes:
        return (
            f"No size can be named: {counted(best.healthy, 'healthy record')} set no threshold with 5{SPACE}% false "
            f"alarms. {_easiest(best)}"
        )
    kinds = list(dict.fromkeys(state.kind for state in best.states.values()))
    return " ".join(_kind_sentence(best, kind, best.sizes.get(kind), kind_name(kind, kinds)) for kind in kinds)


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
        return f"{capitalised(name)} of {_area(found.area_mm2)} gives an alarm in {_share(found)}."
    if size.is_bound:
        return (
            f"{capitalised(name)} is found in nine of ten records from {_area(size.smallest_mm2)} on, the smallest of "
            f"the set ({smallest}: {_share(states[smallest])})."
        )
    if size.reached:
        return f"{capitalised(name)} is found in nine of ten records from {_area_limits(size)}."
    return (
        f"{capitalised(name)} of up to {_area(size.largest_mm2)} is found in fewer than nine of ten records "
        f"({largest}: {_share(states[largest])})."
    )


def _area_limits(size: FoundSize) -> str:
    """Return the area from which on damage is found, with its limits."""
    high = _area(size.area_mm2.high) if math.isfinite(size.area_mm2.high) else "beyond the largest"
    return f"{_area(size.area_mm2.value)} on ({_area(size.area_mm2.low)} to {high})"


def _area(area_mm2: float) -> str:
    return f"{rounded(area_mm2)}{SPACE}mm²"


def _share(state: StateFound) -> str:
    if state.share is None:
        return "an unknown share"
    return f"{percent(state.share.value)} of records, {percent_limits(state.share)}"


def detector_sentence(found: Detectors, best: Detector) -> str:
    """Name the strongest detector and the others beside it, with their AUC."""
    area = f"AUC {decimal(best.every.value)} ({limits(best.every)})"
    gearboxes = f"all {counted(best.specimens, 'gearbox')}"
    first = f"All damage together, the strongest on {gearboxes} is the {_title(best)}: {area}."
    if best.picks:
        first = (
            f"All damage together, the strongest is {picked(best.picks)}, each chosen on the other groups: "
            f"{area} on {gearboxes}."
        )
    others = []
    for family in (BOOSTED, CLASSIFIER, INDICATOR, NETWORKS):
        detector = found.alone.get(family)
        if detector is None or detector is best:
            continue
        where = f" on {counted(detector.specimens, 'test gearbox')}" if family == NETWORKS else ""
        value = f"{decimal(detector.every.value)} ({limits(detector.every)})"
        others.append(f"The {_title(detector)} has {value}{where}.")
    if NETWORKS not in found.alone:
        others.append("No network was trained.")
    return " ".join([first, *others])


def _title(detector: Detector) -> str:
    if not detector.basis:
        return detector.title
    return f"{detector.title} ({in_a_sentence(detector.basis)})"


def certainty_sentence(best: Detector) -> str:
    """Say on what the numbers rest."""
    return (
        f"Judged on {counted(best.records, 'record')} of {counted(best.specimens, 'gearbox')}, each unseen by what "
        f"judges it, at 5{SPACE}% false alarms. In brackets: 95{SPACE}% limits over gearboxes."
    )


def reference_sentence(found: Detectors) -> str:
    """Say what a healthy record of the same gearbox is worth, or why that is not known."""
    beside = found.strongest_referenced
    if beside is None:
        return (
            "What a healthy record of the same gearbox is worth is not known: the set has one per gearbox (`repeats: "
            "2` gives more)."
        )
    kinds = list(dict.fromkeys(state.kind for state in beside.states.values()))
    reached = [
        f"{kind_name(kind, kinds)} from {_area_limits(size)}" for kind, size in beside.sizes.items() if size.reached
    ]
    sizes = f" Nine of ten records are then found of {joined(reached)}." if reached else ""
    return (
        f"Beside a healthy record of the same gearbox: AUC {decimal(beside.every.value)} ({limits(beside.every)}) by "
        f"{picked(beside.picks) or f'the {beside.title}'}.{sizes}"
    )
