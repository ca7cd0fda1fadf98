"""The answer that opens a report, and all detectors behind it: which damage is found, how sure that is."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.alarms import (
    BOOSTED,
    CHOSEN,
    CLASSIFIER,
    FEWEST_SPECIMENS,
    FOUND,
    INDICATOR,
    NETWORKS,
    PRETRAINED,
    Detectors,
    FoundSize,
    JudgedDetector,
)
from diagnostics.page.sentences import Sentences
from diagnostics.page.style import (
    BEHIND_COLOUR,
    WIDTH_IN,
    draw_mesh_line,
    frame_mesh_lines,
    mark_handles,
    order_words,
    state_colours,
    styled,
)
from diagnostics.page.wording import capitalised
from diagnostics.records.state_classes import HEALTHY, kind_name
from diagnostics.report.drawing import Example, ExampleSet, strongest
from diagnostics.report.indicators import in_a_sentence
from diagnostics.report.sentences import CLASSIFIERS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_SIZES = 4
"""Rows of the figure; more do not fit the first screen."""

SIZE_IN = 5.6, 1.0, 1.0
"""Width, and height of the frame and of a row [in]."""
TITLE_SIGNS = 56
"""Of a line above a row: longer ones are cut at the edge of the figure."""


def first_figure(
    examples: ExampleSet, matrix: FeatureMatrix, classes: tuple[str, ...], best: JudgedDetector | None
) -> Figure | None:
    """Return the order spectrum of one gearbox with every size of damage, over its healthy one; None without spectra.

    Parameters
    ----------
    examples : ExampleSet
        One record of each state.
    matrix : FeatureMatrix
        With the labels of all records.
    classes : tuple of str
        States in their order, which gives them their colours.
    best : JudgedDetector, optional
        Says in which share of the records each state is found.
    """
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    areas = dict(zip(matrix.labels["record_id"].tolist(), matrix.labels["damaged_area_mm2"].tolist(), strict=True))
    shown = _by_size([one for one in examples.examples if one.fault != HEALTHY and one.spectrum], areas)
    if not shown:
        return None
    harmonic = strongest(next(one.spectrum for one in examples.examples if one.spectrum), examples.mesh)
    healthy = {one.state for one in examples.examples if one.fault == HEALTHY}
    colours = state_colours(classes, healthy)
    width, frame, row = SIZE_IN
    with styled():
        figure = Figure(figsize=(width, frame + row * len(shown)), layout="constrained")
        axes = figure.subplots(len(shown), 1, squeeze=False, sharex=True, sharey=True)[:, 0]
        behind, top = examples.healthy.spectrum if examples.healthy else None, 0.0
        for axis, one in zip(axes, shown, strict=True):
            assert one.spectrum is not None
            drawn = draw_mesh_line(axis, one.spectrum, examples.mesh, harmonic, colours[one.state], behind)
            top = max(top, drawn)
            title = textwrap.fill(ANSWERS.row(one.state, areas[one.record_id], best), TITLE_SIGNS)
            axis.set_title(title, loc="left", fontweight="bold", color=colours[one.state])
        frame_mesh_lines(axes[0], top)
        mesh_hz = harmonic * examples.teeth[0] * examples.turns_hz
        axes[-1].set_xlabel(f"Distance from mesh harmonic {harmonic} ({mesh_hz:.0f} Hz) [{order_words(examples.mesh)}]")
        figure.supylabel(f"Amplitude [{examples.unit}]", fontsize=10)
        grey = Line2D([], [], color=BEHIND_COLOUR, linewidth=6, label="the same gearbox healthy")
        figure.legend(handles=[grey, *mark_handles(examples.mesh)], loc="outside upper left", ncols=4, fontsize=9)
    return figure


def _by_size(examples: list[Example], areas: dict[int, float]) -> list[Example]:
    """Return a few examples from the smallest to the largest damage."""
    ordered = sorted(examples, key=lambda one: areas[one.record_id])
    places = np.linspace(0, len(ordered) - 1, min(len(ordered), MOST_SIZES)).round().astype(int)
    return [ordered[place] for place in places]


@dataclass(frozen=True, slots=True)
class KindFound:
    """What is found of one kind of damage.

    Attributes
    ----------
    name : str
        What a reader calls it.
    members, whole, partly, lost : list of str
        Its states in their order; from the largest, those found in nine of ten records, told only, and not told.
    size : FoundSize, optional
        From which its records are found.
    told : bool
        Whether any of its states is.
    smallest, largest : str
        Of its states.
    """

    name: str
    members: list[str]
    whole: list[str]
    partly: list[str]
    lost: list[str]
    size: FoundSize | None
    told: bool
    smallest: str
    largest: str

    @property
    def reached(self) -> bool:
        """Whether nine of ten records are found of any size."""
        return self.told and self.size is not None and self.size.reached


def kinds_of(best: JudgedDetector, *, ordered: bool = True) -> list[KindFound]:
    """Return all kinds of damage; ordered: what is found comes first, what is told next."""
    kinds = [_kind(best, kind, members) for kind, members in best.kinds.items()]
    return sorted(kinds, key=lambda kind: (not kind.reached, not kind.told)) if ordered else kinds


def _kind(best: JudgedDetector, kind: str, members: list[str]) -> KindFound:
    falling = sorted(members, key=lambda state: -best.states[state].area_mm2)
    shares = {name: one.share.value for name in falling if (one := best.states[name]).share and best.tells(name)}
    return KindFound(
        name=kind_name(kind, best.kinds),
        members=members,
        whole=[state for state, share in shares.items() if share >= FOUND],
        partly=[state for state, share in shares.items() if not share >= FOUND],
        lost=[state for state in falling if best.loses(state)],
        size=best.sizes.get(kind),
        told=any(map(best.tells, members)),
        smallest=min(members, key=lambda state: best.states[state].area_mm2),
        largest=falling[0],
    )


ANSWERS = Sentences(
    Path(__file__).with_name("templates") / "answer.txt",
    easiest=lambda best: max(best.states, key=lambda state: np.nan_to_num(best.states[state].auc.value)),
    fewest=FEWEST_SPECIMENS,
    has_sham=lambda side: side[1] is not None and side[1].sham is not None,
    in_a_sentence=in_a_sentence,
    kinds_of=kinds_of,
    picked=CLASSIFIERS.picked,
)


LOOKS = {
    CHOSEN: ("chosen", "#111820", "o"),
    INDICATOR: ("indicator", "#1f6f8b", "s"),
    CLASSIFIER: ("logistic", "#b01e3c", "v"),
    BOOSTED: ("boosting", "#8e44ad", "D"),
    NETWORKS: ("network", "#e3a21a", "^"),
    PRETRAINED: ("many gearboxes", "#2e8b57", "P"),
}
"""Name in the legend, colour and marker of each family; the answer itself in black."""

FAMILIES = (BOOSTED, CLASSIFIER, INDICATOR, NETWORKS, PRETRAINED)
"""Those that the strongest is compared with."""

DASHES = ("-", "--", ":", "-.")
"""By kind of damage."""

SIDEWAYS = (1.0, 0.92, 0.96, 1.04, 1.08, 1.12)
"""Families stand beside each other at one size, so that all can be seen."""

MOST_NAMES = 4
LEAST_RATIO = 1.7
"""Of neighbouring sizes whose names do not touch."""


def answer_figure(detectors: Detectors) -> Figure | None:
    """Return AUC by state over its damaged area above, sizes found in nine of ten below; None without any detector."""
    from matplotlib.figure import Figure

    sides = [("On an unseen gearbox", detectors.alone), ("With its healthy record", detectors.referenced)]
    panels = [(title, {family: side[family] for family in LOOKS if family in side}) for title, side in sides if side]
    if not panels:
        return None
    with styled():
        kinds = list(dict.fromkeys(s.kind for _, side in panels for one in side.values() for s in one.states.values()))
        figure = Figure(figsize=(WIDTH_IN, 3.3 + 0.4 * (len(kinds) - 1)), layout="constrained")
        heights = {"height_ratios": [3.4, 0.6 + 0.65 * len(kinds)]}
        axes = figure.subplots(2, len(panels), squeeze=False, sharex=True, sharey="row", gridspec_kw=heights)
        for column, (title, side) in enumerate(panels):
            _draw_areas(axes[0, column], side, kinds)
            _draw_sizes(axes[1, column], side, kinds)
            _name_states(axes[0, column], side)
            axes[0, column].set_title(title, loc="left", fontweight="bold")
        _scale(axes[1, 0], [detector for _, side in panels for detector in side.values()])
        axes[0, 0].set_ylabel("AUC against\nhealthy [-]")
        figure.supxlabel("Damaged area [mm²]", fontsize=10)
        _show_dashes(axes[1, 0], kinds, 0.15 * len(panels))
        shown = [family for family in LOOKS if any(family in side for _, side in panels)]
        figure.legend(
            *_legend(shown), loc="outside upper left", ncols=3, fontsize=9, handletextpad=0.3, columnspacing=1.2
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
    area = size.area_mm2
    axis.plot([area.value, size.largest_mm2], [row, row], color=colour, linewidth=4.5, alpha=0.35)
    high = area.high if math.isfinite(area.high) else size.largest_mm2
    axis.plot([area.low, high], [row, row], color=colour, linewidth=1.1)
    axis.plot(area.value, row, marker=marker, color=colour, markersize=5.5 if answer else 4)


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


def answer_sentences(detectors: Detectors, *, error_free: bool = False) -> list[tuple[str, str]]:
    """Return the answers, each with its question in a few words.

    Parameters
    ----------
    detectors : Detectors
    error_free : bool
        Whether the gears have no manufacturing errors, so that any damage above the noise is separated.
    """
    best, alone = detectors.strongest, detectors.alone
    if best is None:
        return [("No answer", capitalised(ANSWERS.lacking(detectors)))]
    rivals = {name: alone[name] for name in FAMILIES if name in alone}
    return [
        *([("On a sham", sham)] if (sham := ANSWERS.on_a_sham(detectors)) else []),
        ("From which size", ANSWERS.from_which_size(best)),
        ("By what", ANSWERS.by_what(detectors, rivals)),
        ("With a healthy record of the same gearbox", ANSWERS.beside_a_healthy_record(detectors)),
        ("How sure", ANSWERS.how_sure(best, error_free)),
    ]
