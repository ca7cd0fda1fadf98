"""What a reader sees first: order spectra of one gearbox by the size of its damage, an answer, and how sure it is."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.page.sideband_marks import mark_handles, order_words
from diagnostics.page.style import state_colours, styled
from diagnostics.page.wording import capitalised, counted, decimal, joined, limits, percent, percent_limits, rounded
from diagnostics.records.state_classes import HEALTHY, kind_name
from diagnostics.report.drawing import BEHIND_COLOUR, DECADES_SHOWN, around, draw_spectrum, strongest
from diagnostics.report.examples import Example, ExampleSet
from diagnostics.statistics.detector import Detector, FoundSize
from diagnostics.training.detectors import FEWEST_SPECIMENS, Detectors

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_SIZES, MOST_KINDS = 4, 3
"""Rows of the figure, and kinds of damage in the sentence; more do not fit the first screen."""

TRAP_WORD, TRAP = "trap", "something other than damage that tells the labels"
SPACE = "\N{NO-BREAK SPACE}"
SIZE_IN, ORDERS = (5.6, 1.0, 1.0), 4.6
"""Width, and height of the frame and of a row [in]; how far from the mesh line spectra are shown."""


def first_figure(
    examples: ExampleSet, matrix: FeatureMatrix, classes: tuple[str, ...], best: Detector | None
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
    best : Detector, optional
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


def _row_title(example: Example, areas: dict[int, float], best: Detector | None) -> str:
    area = areas[example.record_id]
    size = f", {rounded(area)} mm²" if area > 0.0 else ""
    found = best.states.get(example.state) if best else None
    if found is None or found.share is None:
        return f"{example.state}{size}"
    spread = f" ({percent_limits(found.share)})" if math.isfinite(found.share.low) else ""
    return f"{example.state}{size}: found in {percent(found.share.value)} of records{spread}"


def first_caption(examples: ExampleSet) -> str:
    """Return what the figure shows, for a reader who has never seen one."""
    return (
        f"Vibration of one gearbox with growing damage (colour), over the same gearbox healthy (grey): specimen "
        f"{examples.specimen_id}, {examples.channel}, {examples.speed_hz:.3g}{SPACE}Hz, "
        f"{examples.torque_nm:.3g}{SPACE}N{SPACE}m. Damage lifts the marked sidebands of the tooth mesh. Sizes are "
        f"damaged areas of this gearbox, shares those of all, with 95{SPACE}% limits."
    )


def first_answer(found: Detectors) -> str:
    """Say in a sentence which damage is found, from which size on, and by what; `**` marks what matters."""
    best = found.strongest
    if best is None:
        return (
            "**No answer**: that needs healthy and damaged records of "
            f"**{FEWEST_SPECIMENS} gearboxes or more** in this set."
        )
    by = f"Detector: **{detector_words(best)}**."
    if not best.sizes:
        name = max(best.states, key=lambda state: best.states[state].auc.value)
        return f"The state **{name}** is told best; {best.healthy} healthy records are too few to name a size. {by}"
    kinds = list(dict.fromkeys(state.kind for state in best.states.values()))
    reached = {kind: kind in best.sizes and best.sizes[kind].reached for kind in kinds}
    order = sorted(kinds, key=lambda kind: not reached[kind])
    said = [_kind_words(best, kind, best.sizes.get(kind), kind_name(kind, kinds)) for kind in order]
    more = f"; further kinds of damage: {len(said) - MOST_KINDS}" if len(said) > MOST_KINDS else ""
    return f"{'; '.join([f'**{capitalised(said[0])}', *(f'**{one}' for one in said[1:MOST_KINDS])])}{more}. {by}"


def detector_words(best: Detector) -> str:
    """Return what a detector is: of one that is chosen for each group of gearboxes, what was chosen most often."""
    if not best.picks:
        return best.title
    most = max(best.picks, key=lambda pick: pick[1])[0]
    return most if len(best.picks) == 1 else f"mostly {most}"


def _kind_words(best: Detector, kind: str, size: FoundSize | None, name: str) -> str:
    """Return what is found of a kind of damage, behind the `**` that opens it."""
    states = sorted(
        (state for state, found in best.states.items() if found.kind == kind),
        key=lambda state: best.states[state].area_mm2,
    )
    if size is not None and size.reached:
        limit = size.smallest_mm2 if size.is_bound else size.area_mm2.value
        smallest = f" ({states[0]}; none of this kind is smaller)" if size.is_bound else ""
        return f"{name} from {rounded(limit)}{SPACE}mm² on** is found in **nine of ten records**{smallest}"
    said = f"{name}** is found in only **{_share(best, states[-1])}** of records ({_size(best, states[-1])})"
    return f"{said}, down to {_share(best, states[0])} ({_size(best, states[0])})" if len(states) > 1 else said


def _share(best: Detector, state: str) -> str:
    share = best.states[state].share
    return percent(share.value) if share else "an unknown share"


def _size(best: Detector, state: str) -> str:
    area_mm2 = best.states[state].area_mm2
    return f"{state}, {rounded(area_mm2)}{SPACE}mm²" if area_mm2 > 0.0 else state


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
    lost = [name for name, state in best.states.items() if sham and not state.auc.value > sham.value]
    if sham and lost:
        parts.append(f"**Damage without effect is told too (AUC {decimal(sham.value)})**: {joined(lost)} is not found.")
    if error_free:
        parts.append("**The gears have no manufacturing errors**: on a real machine nothing is known.")
    told = audit.split(". ", maxsplit=1)[0].rstrip(".")
    return " ".join([*parts, f"{told} ({TRAP})." if TRAP_WORD in told else f"{told}."])
