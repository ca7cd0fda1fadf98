"""The answer of a report in a few sentences: which damage from which size on, by what, and how sure that is.

The one figure that opens a report: AUC over the size of the damage, and from which size on nine of ten are found.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.judging.alarms import (
    BOOSTED,
    CHOSEN,
    CLASSIFIER,
    FEWEST_SPECIMENS,
    INDICATOR,
    NETWORKS,
    Detectors,
    FoundSize,
    JudgedDetector,
    StateFound,
)
from diagnostics.page.style import WIDTH_IN, styled
from diagnostics.page.wording import capitalised, counted, decimal, joined, limits, percent, percent_limits, rounded
from diagnostics.records.state_classes import kind_name
from diagnostics.report.detector_table import picked
from diagnostics.report.indicator_figures import in_a_sentence

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LOOKS = {
    CHOSEN: ("chosen", "#111820", "o"),
    INDICATOR: ("indicator", "#1f6f8b", "s"),
    CLASSIFIER: ("logistic", "#b01e3c", "v"),
    BOOSTED: ("boosting", "#8e44ad", "D"),
    NETWORKS: ("network", "#e3a21a", "^"),
}
"""Name in the legend, colour and marker of each family; the answer itself in black."""

DASHES = ("-", "--", ":", "-.")
"""By kind of damage."""

SIDEWAYS = (1.0, 0.92, 0.96, 1.04, 1.08)
"""Families stand beside each other at one size, so that all can be seen."""

MOST_NAMES = 4
LEAST_RATIO = 1.7
"""Of neighbouring sizes whose names do not touch."""

SPACE = "\N{NO-BREAK SPACE}"
ERROR_FREE = (
    "The gears have no manufacturing errors, so any damage above the noise is trivial to separate: this says nothing "
    "about a real machine."
)
FOUND_MEANS = f"Found: the record gives an alarm, as 5{SPACE}% of healthy records do."
ON_ALL = " on all indicators"


def answer_figure(found: Detectors) -> Figure | None:
    """Return AUC by state over its damaged area above, sizes found in nine of ten below; None without any detector."""
    from matplotlib.figure import Figure

    sides = [("On an unseen gearbox", found.alone), ("With its healthy record", found.referenced)]
    panels = [(title, {family: side[family] for family in LOOKS if family in side}) for title, side in sides if side]
    if not panels:
        return None
    with styled():
        kinds = list(dict.fromkeys(s.kind for _, side in panels for one in side.values() for s in one.states.values()))
        figure = Figure(figsize=(WIDTH_IN, 3.3 + 0.4 * (len(kinds) - 1)), layout="constrained")
        heights = {"height_ratios": [3.4, 0.6 + 0.65 * len(kinds)]}
        axes = figure.subplots(2, len(panels), squeeze=False, sharex=True, sharey="row", gridspec_kw=heights)
        for column, (title, detectors) in enumerate(panels):
            _draw_areas(axes[0, column], detectors, kinds)
            _draw_sizes(axes[1, column], detectors, kinds)
            _name_states(axes[0, column], detectors)
            axes[0, column].set_title(title, loc="left", fontweight="bold")
        _scale(axes[1, 0], [detector for _, detectors in panels for detector in detectors.values()])
        axes[0, 0].set_ylabel("AUC against\nhealthy [-]")
        figure.supxlabel("Damaged area [mm²]", fontsize=10)
        _show_dashes(axes[1, 0], kinds, 0.15 * len(panels))
        shown = [family for family in LOOKS if any(family in detectors for _, detectors in panels)]
        figure.legend(
            *_legend(shown), loc="outside upper left", ncols=5, fontsize=9, handletextpad=0.3, columnspacing=1.2
        )
    return figure


def _draw_areas(axis: Any, detectors: dict[str, JudgedDetector], kinds: Sequence[str]) -> None:
    axis.axhline(0.5, color="#8a97a3", linewidth=0.9)
    for family, detector in detectors.items():
        place = list(LOOKS).index(family)
        _, colour, marker = LOOKS[family]
        answer = family == CHOSEN
        for number, kind in enumerate(kinds):
            shown = sorted(
                (s for s in detector.states.values() if s.kind == kind and math.isfinite(s.auc.value)),
                key=lambda state: state.area_mm2,
            )
            size = SIDEWAYS[place] * np.array([state.area_mm2 for state in shown])
            axis.plot(
                size,
                [state.auc.value for state in shown],
                DASHES[number % len(DASHES)],
                color=colour,
                marker=marker,
                markersize=5.5 if answer else 3.5,
                linewidth=1.8 if answer else 0.8,
                zorder=3 if answer else 2,
            )
            if answer:
                axis.vlines(size, *_limits(shown), color=colour, linewidth=1.2, zorder=3)
    axis.set_ylim(0.0, 1.04)
    axis.set_yticks([0.0, 0.25, 0.5, 0.75, 1.0], ["0", "", "0.5", "", "1"])


def _name_states(axis: Any, detectors: dict[str, JudgedDetector]) -> None:
    """Write the names of the states over their sizes, where they are few enough to stand beside each other."""
    states = next(iter(detectors.values())).states
    sizes = np.sort([state.area_mm2 for state in states.values()])
    if len(states) > MOST_NAMES or (sizes[1:] < LEAST_RATIO * sizes[:-1]).any():
        return
    for name, state in states.items():
        axis.text(state.area_mm2, 0.03, name, ha="center", va="bottom", fontsize=9, color="#566573")


def _limits(states: Sequence[Any]) -> tuple[list[float], list[float]]:
    return [state.auc.low for state in states], [state.auc.high for state in states]


def _draw_sizes(axis: Any, detectors: dict[str, JudgedDetector], kinds: Sequence[str]) -> None:
    """Draw from which size on nine of ten are found; every kind of damage has a row of its own for every family."""
    families = [family for family in LOOKS if family in detectors and detectors[family].sizes]
    for group, kind in enumerate(kinds):
        for place, family in enumerate(families):
            if kind in detectors[family].sizes:
                row = group + 0.8 * ((place + 0.5) / len(families) - 0.5)
                _draw_size(axis, detectors[family].sizes[kind], row, family)
        if not any(kind in detectors[family].sizes for family in families):
            areas = [
                state.area_mm2 for one in detectors.values() for state in one.states.values() if state.kind == kind
            ]
            said = "too few sizes" if any(areas) else "no area on a flank"
            axis.text(0.03, group, said, transform=axis.get_yaxis_transform(), va="center", fontsize=8)
    axis.set_ylim(len(kinds) - 0.5, -0.5)
    if len(kinds) == 1:
        axis.set_yticks([0.0], ["nine of\nten found"])
    else:
        names = [textwrap.fill(kind_name(kind, kinds), 17) for kind in kinds]
        axis.set_yticks(range(len(kinds)), names, fontsize=7.5)
        axis.set_title("nine of ten found", loc="left", fontsize=9)
    axis.tick_params(axis="y", length=0)
    axis.grid(visible=False, axis="y")


def _draw_size(axis: Any, size: FoundSize, row: float, family: str) -> None:
    """Draw a point with limits, and broadly what lies above it; a cross at the largest where it is not found."""
    _, colour, marker = LOOKS[family]
    answer = family == CHOSEN
    if not size.reached:
        axis.plot(size.largest_mm2, row, marker="x", color=colour, markersize=6, markeredgewidth=2.2 if answer else 1.4)
        return
    found = size.area_mm2
    axis.plot([found.value, size.largest_mm2], [row, row], color=colour, linewidth=4.5, alpha=0.35)
    high = found.high if math.isfinite(found.high) else size.largest_mm2
    axis.plot([found.low, high], [row, row], color=colour, linewidth=1.1)
    axis.plot(found.value, row, marker=marker, color=colour, markersize=5.5 if answer else 4)


def _scale(axis: Any, detectors: Sequence[JudgedDetector]) -> None:
    """Scale sizes logarithmically, with a few round numbers below them."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    sizes = [state.area_mm2 for detector in detectors for state in detector.states.values() if state.area_mm2 > 0.0]
    sizes += [end for one in detectors for size in one.sizes.values() for end in (size.smallest_mm2, size.largest_mm2)]
    if not sizes:
        return
    axis.set_xscale("log")
    low, high = min(sizes) / 1.3, max(sizes) * 1.3
    axis.set_xlim(low, high)
    axis.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 300.0 * low else (1.0,), numticks=99))
    axis.xaxis.set_major_formatter(FuncFormatter(lambda size, _: f"{size:g}"))
    axis.xaxis.set_minor_formatter(NullFormatter())


def _show_dashes(axis: Any, kinds: Sequence[str], length: float) -> None:
    """Underline the name of every kind of damage with the dashes that its line has in the figure above."""
    from matplotlib.transforms import blended_transform_factory

    if len(kinds) == 1:
        return
    place = blended_transform_factory(axis.transAxes, axis.transData)
    for group in range(len(kinds)):
        dashes = DASHES[group % len(DASHES)]
        ends, height = [-0.03 - length, -0.03], [group + 0.42] * 2
        axis.plot(ends, height, dashes, color="#111820", linewidth=1.6, transform=place, clip_on=False)


def _legend(families: Sequence[str]) -> tuple[list[Any], list[str]]:
    from matplotlib.lines import Line2D

    looks = [LOOKS[family] for family in families]
    lines = [Line2D([], [], color=colour, marker=marker, markersize=5) for _, colour, marker in looks]
    return lines, [name for name, _, _ in looks]


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
        *([("On a sham", sham)] if (sham := sham_sentence(found)) else []),
        ("From which size", size_sentence(best)),
        ("By what", detector_sentence(found, best)),
        ("With a healthy record of the same gearbox", reference_sentence(found)),
        ("How sure", " ".join([*([ERROR_FREE] if error_free else []), certainty_sentence(best)])),
    ]


def sham_sentence(found: Detectors) -> str:
    """Say what detectors reach on damage without effect, and which states they find no better; empty without one."""
    sides = {"alone": found.strongest, "beside a healthy record": found.strongest_referenced}
    asked = {side: (one, one.sham) for side, one in sides.items() if one is not None and one.sham is not None}
    if not asked:
        return ""
    reached = joined([f"{decimal(sham.value)} ({limits(sham)}) {side}" for side, (_, sham) in asked.items()])
    said = f"Damage without any effect is told from healthy records with an AUC of {reached}; 0.5 is chance."
    for side, (one, sham) in asked.items():
        if lost := [name for name, state in one.states.items() if not state.auc.value > sham.high]:
            said += f" What is told of {joined(lost)} {side} is within these limits, so it counts as not told."
    return said


def size_sentence(best: JudgedDetector) -> str:
    """Say of every kind of damage from which area on nine of ten records are found, or how many of its largest are."""
    if not best.sizes:
        return (
            f"No size can be named: {counted(best.healthy, 'healthy record')} set no threshold with 5{SPACE}% false "
            f"alarms. {_easiest(best)}"
        )
    kinds = list(dict.fromkeys(state.kind for state in best.states.values()))
    said = [_kind_sentence(best, kind, best.sizes.get(kind), kind_name(kind, kinds)) for kind in kinds]
    return " ".join([*said, FOUND_MEANS])


def _easiest(best: JudgedDetector) -> str:
    name = max(best.states, key=lambda state: best.states[state].auc.value)
    return f"The state {name} has the largest AUC: {decimal(best.states[name].auc.value)}."


def _kind_sentence(best: JudgedDetector, kind: str, size: FoundSize | None, name: str) -> str:
    """Say what is found of one kind; where the smallest or none is, the share of its records says how sure that is."""
    states = {state: found for state, found in best.states.items() if found.kind == kind}
    smallest = min(states, key=lambda state: states[state].area_mm2)
    largest = max(states, key=lambda state: states[state].area_mm2)
    if not any(map(best.tells, states)):
        return f"{capitalised(name)} is not told from healthy records: {_areas_under(states)}."
    if size is None:
        found = states[largest]
        of = f" of {_area(found.area_mm2)}" if found.area_mm2 > 0.0 else ""  # what shows on no flank has no area
        return f"{capitalised(name)}{of} is found in {_share(found)}."
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


def _areas_under(states: Mapping[str, StateFound]) -> str:
    parts = [f"{state} {decimal(found.auc.value)} ({limits(found.auc)})" for state, found in states.items()]
    return f"AUC of {joined(parts)}, chance is 0.5"


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


def detector_sentence(found: Detectors, best: JudgedDetector) -> str:
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


def _other(family: str, detector: JudgedDetector) -> str:
    where = f" on {counted(detector.specimens, 'test gearbox')} alone" if family == NETWORKS else ""
    return f"{_title(detector).removesuffix(ON_ALL)} {decimal(detector.every.value)} ({limits(detector.every)}){where}"


def _title(detector: JudgedDetector) -> str:
    if not detector.basis:
        return detector.title
    return f"{detector.title} ({in_a_sentence(detector.basis, detector.gears)})"


def certainty_sentence(best: JudgedDetector) -> str:
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
