"""The answer that opens a report, and all detectors behind it: which damage is found, how sure that is."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.alarms import (
    BOOSTED,
    CHANCE,
    CHOSEN,
    CLASSIFIER,
    FALSE_ALARMS,
    FEWEST_SPECIMENS,
    FOUND,
    INDICATOR,
    NETWORKS,
    Detectors,
    FoundSize,
    JudgedDetector,
    StateFound,
)
from diagnostics.page.style import WIDTH_IN, mark_handles, order_words, state_colours, styled
from diagnostics.page.wording import capitalised, counted, decimal, joined, limits, percent, percent_limits, rounded
from diagnostics.records.state_classes import HEALTHY, kind_name
from diagnostics.report.classifier_tables import picked
from diagnostics.report.drawing import (
    BEHIND_COLOUR,
    DECADES_SHOWN,
    Example,
    ExampleSet,
    around,
    draw_spectrum,
    strongest,
)
from diagnostics.report.indicators import in_a_sentence

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_SIZES, MOST_KINDS = 4, 3
"""Rows of the figure, and kinds of damage in the sentence; more do not fit the first screen."""

TRAP_WORD, TRAP = "trap", "something other than damage that tells the labels"
SPACE = "\N{NO-BREAK SPACE}"
SIZE_IN, ORDERS = (5.6, 1.0, 1.0), 4.6
"""Width, and height of the frame and of a row [in]; how far from the mesh line spectra are shown."""
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
    spectra = [one.spectrum for one in examples.examples if one.spectrum]
    harmonic = strongest(spectra[0], examples.mesh)
    healthy = {one.state for one in examples.examples if one.fault == HEALTHY}
    colours = state_colours(classes, healthy)
    width, frame, row = SIZE_IN
    with styled():
        figure = Figure(figsize=(width, frame + row * len(shown)), layout="constrained")
        axes = figure.subplots(len(shown), 1, squeeze=False, sharex=True, sharey=True)[:, 0]
        for axis, one in zip(axes, shown, strict=True):
            draw_spectrum(axis, one, examples, harmonic, colours[one.state])
            title = textwrap.fill(_row_title(one, areas, best), TITLE_SIGNS)
            axis.set_title(title, loc="left", fontweight="bold", color=colours[one.state])
        top = max(around(one, examples, harmonic)[1].max() for one in spectra)
        axes[0].set_ylim(2.0 * top / 10**DECADES_SHOWN, 4.0 * top)
        axes[0].set_xlim(-ORDERS, ORDERS)
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


def _row_title(example: Example, areas: dict[int, float], best: JudgedDetector | None) -> str:
    area = areas[example.record_id]
    size = f", {rounded(area)} mm²" if area > 0.0 else ""
    found = best.states.get(example.state) if best else None
    if found is None or found.share is None:
        return f"{example.state}{size}"
    spread = f" ({percent_limits(found.share)})" if math.isfinite(found.share.low) else ""
    alarms = f"{example.state}{size}: {percent(found.share.value)} of records alarm{spread}"
    return alarms if best and best.tells(example.state) else f"{alarms}, not told from healthy"


def first_caption(examples: ExampleSet) -> str:
    """Return what the figure shows, for a reader who has never seen one."""
    return (
        f"Order spectra of one gearbox with damage (colour), by its size, and healthy (grey): specimen "
        f"{examples.specimen_id}, {examples.channel}, {examples.speed_hz:.3g}{SPACE}Hz, "
        f"{examples.torque_nm:.3g}{SPACE}N{SPACE}m. Marked: where sidebands of the tooth mesh lie. Sizes are damaged "
        f"areas of this gearbox, shares those of all, with 95{SPACE}% limits."
    )


def first_answer(found: Detectors) -> str:
    """Say which damage is found from which size on, which states are told, or that none is; `**` marks what matters."""
    best = found.strongest
    if best is None:
        return f"**No answer**: {lacking_words(found)}"
    if not best.told:
        said = [_nothing_words(best)]
    elif best.sizes:
        said = _kinds_words(best)
    else:
        said = [f"Told from healthy: **{_sizes(best, best.told[::-1])}**.", _lost_words(best)]
        said.append(f"{counted(best.healthy, 'healthy record')} are too few to name a size.")
    said += [_unjudged_words(best), _below_chance(best), f"Detector: **{detector_words(best)}**.", _next_step(found)]
    return " ".join(part for part in said if part)


def lacking_words(found: Detectors) -> str:
    """Say which records a set lacks to be judged, and how to go on."""
    healthy, damaged = found.gearboxes
    if not healthy:
        on = "Add a healthy state under `states` (`healthy: {}`), and generate into a new folder"
    elif not damaged:
        on = "Add a state with `damage` under `states`, and generate into a new folder"
    else:
        on = "The same `siggen generate` with more gearboxes goes on with this set (`--set specimens=N`)"
    return (
        f"the set has healthy records of {counted(healthy, 'gearbox')} and damaged records of "
        f"{counted(damaged, 'gearbox')}; needed are {FEWEST_SPECIMENS} or more of each. {on}."
    )


def _unjudged_words(best: JudgedDetector) -> str:
    """Name the states of one gearbox alone, which have no score; empty without one."""
    unjudged = [state for state, found in best.states.items() if not math.isfinite(found.auc.value)]
    if not unjudged:
        return ""
    return f"No score for **{_sizes(best, unjudged)}**: records of a single gearbox; two or more are needed."


def _nothing_words(best: JudgedDetector) -> str:
    """Say that nothing is found, and what chance gives."""
    alarms = ""
    if best.share is not None:
        alarms = f"; {percent(best.share.value)} of damaged and {percent(FALSE_ALARMS)} of healthy records alarm"
    said = f"**Nothing was found**: AUC **{decimal(best.every.value)}** ({limits(best.every)}), chance is 0.5{alarms}."
    if best.sham is not None and any(state.auc.low > CHANCE for state in best.states.values()):
        said += f" What is told is no more than on damage without effect (AUC up to {decimal(best.sham.high)})."
    return said


def _kinds_words(best: JudgedDetector) -> list[str]:
    """Say of every kind of damage what is found, what is told alone, and what is not; what is found comes first."""
    kinds = list(dict.fromkeys(state.kind for state in best.states.values()))
    members = {kind: [state for state, found in best.states.items() if found.kind == kind] for kind in kinds}
    told = {kind: any(map(best.tells, members[kind])) for kind in kinds}
    reached = {kind: told[kind] and kind in best.sizes and best.sizes[kind].reached for kind in kinds}
    said = []
    for kind in sorted(kinds, key=lambda kind: (not reached[kind], not told[kind]))[:MOST_KINDS]:
        name = capitalised(kind_name(kind, kinds))
        if reached[kind]:
            said.append(_reached_words(best, best.sizes[kind], members[kind], name))
        elif told[kind]:
            said.append(_told_words(best, members[kind], name if len(kinds) > 1 else ""))
        else:
            said += [f"**{name}** is not told from healthy."] if any(map(best.loses, members[kind])) else []
    more = len(kinds) - MOST_KINDS
    return [*said, f"Further kinds of damage: {more}."] if more > 0 else said


def _reached_words(best: JudgedDetector, size: FoundSize, members: list[str], name: str) -> str:
    """Say from which size on a kind of damage is found."""
    limit = f"{rounded(size.smallest_mm2 if size.is_bound else size.area_mm2.value)}{SPACE}mm²"
    if size.is_bound:
        smallest = min(members, key=lambda state: best.states[state].area_mm2)
        spread = f" ({smallest}; none of this kind is smaller)"
    else:
        high = size.area_mm2.high
        spread = f" ({rounded(size.area_mm2.low)} to {rounded(high) if math.isfinite(high) else 'beyond the largest'})"
    return f"**{name} from {limit} on**{spread} is found in **nine of ten records**."


def _told_words(best: JudgedDetector, members: list[str], name: str) -> str:
    """Say which states of a kind are found, which are told from healthy alone, and which are not."""
    order = sorted(members, key=lambda state: -best.states[state].area_mm2)
    shares = {state: found.share.value for state in order if (found := best.states[state]).share and best.tells(state)}
    whole = [state for state, share in shares.items() if share >= FOUND]
    partly = [state for state in shares if state not in whole]
    alarms = [f"{_size(best, state)} {percent(shares[state])}" for state in (*whole, *partly)][:MOST_SIZES]
    of_kind = f" of {name[:1].lower()}{name[1:]}" if name else ""
    first = (
        f"**Only {_sizes(best, whole)}{of_kind} {'is' if len(whole) == 1 else 'are'} found**"
        if whole
        else f"**No size{of_kind} is found in nine of ten records**"
    )
    lost = [state for state in order if best.loses(state)]
    said = f"{first}. Records that alarm: {', '.join(alarms)}; healthy {percent(FALSE_ALARMS)}."
    return f"{said} {_lost_words(best, lost)}" if lost else said


def _lost_words(best: JudgedDetector, states: Sequence[str] | None = None) -> str:
    """Name the states that are not told from healthy, of all or of some."""
    lost = [state for state in states or best.states if best.loses(state)]
    return f"Not told from healthy: **{_sizes(best, lost)}**." if lost else ""


def _below_chance(best: JudgedDetector) -> str:
    """Call out intervals that lie wholly below chance; empty without one."""
    asked = {"all damage together": best.every, **{name: state.auc for name, state in best.states.items()}}
    below = [f"{name} ({limits(auc)})" for name, auc in asked.items() if auc.high < CHANCE][:MOST_SIZES]
    if not below:
        return ""
    return (
        f"**Below chance, with its whole interval: AUC of {joined(below)}**. What was learnt turns round on other "
        "gearboxes: look for a trap (`audit`)."
    )


def _next_step(found: Detectors) -> str:
    """Say what may find more, where something is not told; empty where all is."""
    best, beside = found.strongest, found.strongest_referenced
    if best is None or len(best.told) == len(best.states):
        return ""
    if beside is None:
        return "Next: two healthy records of each gearbox (`repeats: 2`), so that each is judged beside one."
    if more := [state for state in beside.told if state not in best.told]:
        return (
            f"Beside a healthy record of the same gearbox **{joined(more)}** {'is' if len(more) == 1 else 'are'} told."
        )
    return "Next: more gearboxes or larger damage; a healthy record of the same gearbox tells no more."


def detector_words(best: JudgedDetector) -> str:
    """Return what a detector is: of one that is chosen for each group of gearboxes, what was chosen most often."""
    if not best.picks:
        return best.title
    most = max(best.picks, key=lambda pick: pick[1])[0]
    return most if len(best.picks) == 1 else f"mostly {most}"


def _sizes(best: JudgedDetector, states: Sequence[str]) -> str:
    """Name a few states with their sizes, and how many more there are."""
    named = [_size(best, state) for state in states[:MOST_SIZES]]
    more = len(states) - len(named)
    return joined([*named, f"{more} more"] if more else named)


def _size(best: JudgedDetector, state: str) -> str:
    area_mm2 = best.states[state].area_mm2
    return f"{state} ({rounded(area_mm2)}{SPACE}mm²)" if area_mm2 > 0.0 else state


def first_certainty(found: Detectors, *, error_free: bool, audit: str) -> str:
    """Say how sure the answer is, and what takes from it.

    Parameters
    ----------
    found : Detectors
    error_free : bool
        Whether the gears have no manufacturing errors.
    audit : str
        What the audit says of traps in the set; its first sentence is told.
    """
    best = found.strongest
    if best is None:
        return "Nothing is known."
    spread = f"95{SPACE}% limits {limits(best.every)}" if math.isfinite(best.every.low) else "no limits"
    parts = [
        f"**Each of {counted(best.specimens, 'gearbox')} was judged by a model that had learnt from others alone.** Of "
        f"healthy records 5{SPACE}% give a false alarm. All damage together: **AUC {decimal(best.every.value)}** "
        f"({spread}; 0.5 is chance, 1 is perfect)."
    ]
    sham = best.sham
    lost = [name for name, state in best.states.items() if sham and state.auc.value <= sham.high]
    if sham and sham.low > CHANCE and lost:
        said = f"**Damage without effect is told too (AUC {decimal(sham.value)})**"
        parts.append(f"{said}: {joined(lost)} {'is' if len(lost) == 1 else 'are'} not told.")
    if error_free:
        parts.append("**The gears have no manufacturing errors**: on a real machine nothing is known.")
    told = audit.split(". ", maxsplit=1)[0].rstrip(".")
    return " ".join([*parts, f"{told} ({TRAP})." if TRAP_WORD in told else f"{told}."])


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
        return [("No answer", capitalised(lacking_words(found)))]
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
        if lost := [name for name, state in one.states.items() if state.auc.value <= sham.high]:
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
    name = max(best.states, key=lambda state: np.nan_to_num(best.states[state].auc.value))
    return f"The state {name} has the largest AUC: {decimal(best.states[name].auc.value)}."


def _kind_sentence(best: JudgedDetector, kind: str, size: FoundSize | None, name: str) -> str:
    """Say what is found of one kind; where the smallest or none is, the share of its records says how sure that is."""
    states = {state: found for state, found in best.states.items() if found.kind == kind}
    smallest = min(states, key=lambda state: states[state].area_mm2)
    largest = max(states, key=lambda state: states[state].area_mm2)
    if not any(map(best.tells, states)):
        if not any(map(best.loses, states)):
            return f"{capitalised(name)} has no score: its states have records of a single gearbox each."
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
