"""What a reader sees first: order spectra of one gearbox by the size of its damage, an answer, and how sure it is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.alarms import (
    CHANCE,
    FALSE_ALARMS,
    FEWEST_SPECIMENS,
    FOUND,
    Detectors,
    FoundSize,
    JudgedDetector,
)
from diagnostics.page.sideband_marks import mark_handles, order_words
from diagnostics.page.style import state_colours, styled
from diagnostics.page.wording import capitalised, counted, decimal, joined, limits, percent, percent_limits, rounded
from diagnostics.records.state_classes import HEALTHY, kind_name
from diagnostics.report.drawing import BEHIND_COLOUR, DECADES_SHOWN, around, draw_spectrum, strongest
from diagnostics.report.examples import Example, ExampleSet

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_SIZES, MOST_KINDS = 4, 3
"""Rows of the figure, and kinds of damage in the sentence; more do not fit the first screen."""

TRAP_WORD, TRAP = "trap", "something other than damage that tells the labels"
SPACE = "\N{NO-BREAK SPACE}"
SIZE_IN, ORDERS = (5.6, 1.0, 1.0), 4.6
"""Width, and height of the frame and of a row [in]; how far from the mesh line spectra are shown."""


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
            axis.set_title(_row_title(one, areas, best), loc="left", fontweight="bold", color=colours[one.state])
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
        return (
            "**No answer**: that needs healthy and damaged records of "
            f"**{FEWEST_SPECIMENS} gearboxes or more** in this set."
        )
    if not best.told:
        said = [_nothing_words(best)]
    elif best.sizes:
        said = _kinds_words(best)
    else:
        said = [f"Told from healthy: **{_sizes(best, best.told[::-1])}**.", _lost_words(best)]
        said.append(f"{counted(best.healthy, 'healthy record')} are too few to name a size.")
    said += [_below_chance(best), f"Detector: **{detector_words(best)}**.", _next_step(found)]
    return " ".join(part for part in said if part)


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
            said.append(f"**{name}** is not told from healthy.")
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
    lost = [state for state in order if state not in shares]
    said = f"{first}. Records that alarm: {', '.join(alarms)}; healthy {percent(FALSE_ALARMS)}."
    return f"{said} {_lost_words(best, lost)}" if lost else said


def _lost_words(best: JudgedDetector, states: Sequence[str] | None = None) -> str:
    """Name the states that are not told from healthy, of all or of some."""
    lost = [state for state in states or best.states if not best.tells(state)]
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
    lost = [name for name, state in best.states.items() if sham and not state.auc.value > sham.high]
    if sham and sham.low > CHANCE and lost:
        said = f"**Damage without effect is told too (AUC {decimal(sham.value)})**"
        parts.append(f"{said}: {joined(lost)} {'is' if len(lost) == 1 else 'are'} not told.")
    if error_free:
        parts.append("**The gears have no manufacturing errors**: on a real machine nothing is known.")
    told = audit.split(". ", maxsplit=1)[0].rstrip(".")
    return " ".join([*parts, f"{told} ({TRAP})." if TRAP_WORD in told else f"{told}."])
