"""The detectors of a report's answer as a table: AUC, alarms by state, and the size that is found."""

from __future__ import annotations

import math

from diagnostics.page.explorer_link import linked_cell
from diagnostics.page.html import Cell, table
from diagnostics.page.tables import interval_cell
from diagnostics.page.wording import joined, rounded
from diagnostics.report.indicator_terms import in_a_sentence
from diagnostics.statistics.detector import Detector, FoundSize
from diagnostics.training.detectors import Detectors

CAPTION = (
    "Detectors that give one alarm for all damage. Indicator and classifiers are judged on all gearboxes, each fold by "
    "what was chosen or trained on the others; the network on the test gearboxes. Where folds differ in which of them "
    "is best, a row of its own has the choice that the other gearboxes make. Alarms: share of the records of "
    "a state above the threshold that 5 % of the healthy records exceed. Last columns: damaged area from which 90 % "
    "give an alarm. Limits of 95 % come from resampled gearboxes."
)


def detector_table(found: Detectors, explorer: str = "") -> str:
    """Return all detectors, those beside a healthy record below those without; nothing without any.

    AUC and alarms of a state lead to its records on the page to explore.
    """
    every = list({id(one): one for side in (found.alone, found.referenced) for one in side.values()}.values())
    if not every:
        return ""
    states = list(dict.fromkeys(name for detector in every for name in detector.states))
    kinds = list(dict.fromkeys(state.kind for detector in every for state in detector.states.values()))
    head = [
        *("Detector", "Gearboxes", "AUC, all damage"),
        *(f"AUC, {name}" for name in states),
        *(f"Alarms, {name} [%]" for name in states),
        *(f"Nine of ten, {kind} [mm²]" for kind in kinds),
    ]
    return table(head, [_row(detector, states, kinds, explorer) for detector in every], caption=CAPTION, sortable=True)


def _row(detector: Detector, states: list[str], kinds: list[str], explorer: str) -> list[Cell]:
    beside = "beside a healthy record" if detector.referenced else ""
    basis = in_a_sentence(detector.basis) if detector.basis else picked(detector.picks)
    small = ", ".join(part for part in (basis, beside) if part)
    none = Cell("–", value=math.nan)
    shown = {"indicator": detector.basis} if detector.basis else {}

    def behind(cell: Cell, state: str) -> Cell:
        return linked_cell(cell, explorer, state=state, **shown)

    return [
        Cell(detector.title, small),
        Cell(str(detector.specimens), value=float(detector.specimens)),
        interval_cell(detector.every),
        *(
            behind(interval_cell(detector.states[name].auc), name) if name in detector.states else none
            for name in states
        ),
        *(behind(_alarms(detector, name), name) for name in states),
        *(_size_cell(detector.sizes.get(kind)) for kind in kinds),
    ]


def picked(picks: tuple[tuple[str, int], ...]) -> str:
    """Return what was chosen for how many groups of gearboxes, the most frequent first; nothing without a choice."""
    groups = sum(count for _, count in picks)
    said = [
        f"{name} for {count}{f' of {groups} groups' if not place else ''}" for place, (name, count) in enumerate(picks)
    ]
    return joined(said) if said else ""


def _alarms(detector: Detector, name: str) -> Cell:
    found = detector.states[name].share if name in detector.states else None
    if found is None:
        return Cell("–", value=math.nan)
    limits = "" if math.isnan(found.low) else f"{100 * found.low:.0f} … {100 * found.high:.0f}"
    return Cell(f"{100 * found.value:.0f}", limits, 100.0 * found.value)


def _size_cell(found: FoundSize | None) -> Cell:
    if found is None:
        return Cell("–", value=math.nan)
    if not found.reached:
        return Cell("not found", f"up to {rounded(found.largest_mm2)}", 1e9)
    high = rounded(found.area_mm2.high) if math.isfinite(found.area_mm2.high) else "∞"
    bound = "≤ " if found.is_bound else ""
    return Cell(
        f"{bound}{rounded(found.area_mm2.value)}", f"{rounded(found.area_mm2.low)} … {high}", found.area_mm2.value
    )
