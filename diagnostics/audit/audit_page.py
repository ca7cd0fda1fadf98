"""The audit as one self-contained page: figures, tables, sentences, each written from its numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.audit.audit import ALONE, UNPAIRED, WITH_REFERENCE, Audit
from diagnostics.audit.bank import sham_sentences
from diagnostics.audit.detectability import (
    FEWEST_SPECIMENS,
    SIZES,
    TARGETS,
    Detectability,
    DetectedArea,
    area_at,
    differ_in_area,
)
from diagnostics.audit.envelope import QuantityShare, Realism
from diagnostics.audit.reference_comparison import FEWEST_GEARBOXES, FEWEST_RECORDINGS, TELLING_AUC, ReferenceComparison
from diagnostics.page.blocks import (
    Block,
    Cell,
    FigureBlock,
    FigureGrid,
    Heading,
    Page,
    Paragraph,
    TableBlock,
    note_blocks,
    summary_blocks,
)
from diagnostics.page.provenance import provenance
from diagnostics.page.sentences import Sentences
from diagnostics.page.style import FAULT_COLOURS, HEALTHY_COLOUR, PINION_COLOUR, new_figure
from diagnostics.page.tables import cell, table
from diagnostics.page.wording import capitalised, counted
from siggen.dataset.reading import Dataset

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TEACHABLE_AUC, CHANCE_AUC = 0.75, 0.6
"""From the first on a state counts as found; below the second a probe has failed."""


def _strongest(probes: Mapping[str, float]) -> str:
    return max(probes, key=lambda name: probes[name])


SAID = Sentences(
    Path(__file__).with_name("templates") / "audit.txt",
    fewest_gearboxes=FEWEST_GEARBOXES,
    fewest_recordings=FEWEST_RECORDINGS,
    fewest_specimens=FEWEST_SPECIMENS,
    strongest=_strongest,
    teachable=TEACHABLE_AUC,
    telling_auc=TELLING_AUC,
)


def chance_sentence(audit: Audit) -> str:
    """Say what chance stays below, or what it reaches where that is too much; empty where nothing was judged."""
    chance = audit.chance
    if chance is None or not math.isfinite(chance.auc):
        return ""
    limits = [law.auc for law in chance.states.values() if math.isfinite(law.auc)]
    return SAID.chance(chance, limits, audit.gearboxes_needed is not None)


def verdict_words(audit: Audit, state: str) -> str:
    """Say by what a state is found best; where it is not found, by which probes it was looked for in vain."""
    return SAID.verdict(audit, state, lost_below(audit, state))


def lost_below(audit: Audit, state: str) -> float:
    """Return the AUC below which a state counts as lost: 0.6, or what the strongest detector reaches by chance."""
    limit = audit.chance.of(state) if audit.chance else math.nan
    return max(CHANCE_AUC, limit) if math.isfinite(limit) else CHANCE_AUC


def shown_ladders(audit: Audit) -> dict[str, list[Detectability]]:
    """Return the detections that are shown over the size of the damage: the strongest ones, and the older probe."""
    found = {ALONE: audit.ladder(referenced=False), WITH_REFERENCE: audit.ladder(referenced=True)}
    found[UNPAIRED] = audit.detections.get(UNPAIRED, [])
    return {name: entries for name, entries in found.items() if entries}


def detector_parts(audit: Audit) -> list[Block]:
    """Return the tables of the detectors; nothing where none could judge."""
    if not audit.states:
        return []
    return [Paragraph(f"{SAID.how()} {chance_sentence(audit)}".strip()), _strongest_table(audit), _every_table(audit)]


def _strongest_table(audit: Audit) -> TableBlock:
    ladders = [{entry.state: entry for entry in audit.ladder(referenced=side)} for side in (False, True)]
    rows = []
    for state in audit.states:
        cells: list[object] = [state]
        for ladder in ladders:
            entry = ladder.get(state)
            cells += [entry.basis, entry.auc] if entry else [None, None]
        law = audit.chance.states.get(state) if audit.chance else None
        rows.append([*cells, cell(law.p_value if law else None, ".3f"), verdict_words(audit, state)])
    head = ["State", "Strongest alone", "AUC [-]", "Strongest with a healthy reference", "AUC [-]", "Chance", "Verdict"]
    return table(head, rows, SAID.strongest_table(), text=True)


def _every_table(audit: Audit) -> TableBlock:
    rows = []
    for name, entries in audit.detections.items():
        by_state = {entry.state: entry.auc.value for entry in entries}
        number = max((entry.tried for entry in entries), default=0)
        rows.append((capitalised(name), number, *(by_state.get(state) for state in audit.states)))
    head = ["Detector", "Columns", *audit.states]
    caption = "Every detector on every state: AUC against healthy on gearboxes that were not seen."
    return table(head, rows, caption, sortable=True)


OUTSIDE = 0.05
"""A recording is outside where fewer gearboxes than this lie as far from their median."""


def reference_sentences(found: ReferenceComparison) -> list[str]:
    """Say what gives the set away, whether recordings lie within its spread, and how wide that is."""
    inside = sum(place.farther >= OUTSIDE for place in found.places)
    return [SAID.telling(found), SAID.together(found), SAID.spread(found, inside)]


def reference_parts(found: ReferenceComparison) -> list[Block]:
    """Return the tables of the page."""
    rows = [
        (*(gap.name, gap.auc, gap.measured, gap.synthetic, gap.synthetic_spread), cell(100.0 * gap.inside, ".0f"))
        for gap in found.gaps
    ]
    head = ["Feature", "AUC [-]", "Measured", "Synthetic", "Spread of gearboxes", "Synthetic inside [%]"]
    places = [(p.name, p.distance, cell(100.0 * p.farther, ".0f"), p.windows) for p in found.places]
    place_head = ["Recording", "Distance [spreads]", "Channels as far [%]", "Windows"]
    return [
        *(Paragraph(text) for text in reference_sentences(found)),
        table(place_head, places, SAID.places_table(), ".3g", sortable=True),
        table(head, rows, SAID.gaps_table(), ".3g", sortable=True),
    ]


def audit_summary(audit: Audit) -> list[str]:
    """Return the verdict, what shams tell, its basis, realism if asked for, the hardest state, the size found."""
    found = [SAID.basis(audit)]
    found += [_realism_sentence(audit.realism)] if audit.realism else []
    found += reference_sentences(audit.reference) if audit.reference else []
    return [
        audit.verdict,
        *([SAID.first(audit.made_again)] if audit.made_again else []),
        *sham_sentences(audit.shams),
        *found,
        *_hardest_sentence(audit),
        *([] if audit.gearboxes_needed else _size_sentence(shown_ladders(audit))),
    ]


def _realism_sentence(found: Realism) -> str:
    worst, beside = (
        min(shares, key=lambda one: one.inside, default=None) for shares in (found.shares, found.background)
    )
    return SAID.realism(found, worst, beside)


def _hardest_sentence(audit: Audit) -> list[str]:
    """Name the strongest detector of the hardest and the easiest state, and say what is lost."""
    reached = {state: max(audit.probes(state).values()) for state in audit.states if audit.probes(state)}
    if not reached:
        return []
    hardest, easiest = (chosen(reached, key=lambda state: reached[state]) for chosen in (min, max))
    lost = [state for state in reached if reached[state] < lost_below(audit, state) and not audit.gearboxes_needed]
    told = [SAID.hardest(audit, hardest, easiest, len(reached)), chance_sentence(audit)]
    told += [SAID.lost(lost, list(audit.probes(lost[0])))] if lost else []
    return [text for text in told if text]


def _size_sentence(detections: dict[str, list[Detectability]]) -> list[str]:
    """Say from which damaged area on damage is found at the lower target, by each variant that reaches it."""
    found = [
        (name, fault, area)
        for name, entries in detections.items()
        for fault, area in area_at(entries, TARGETS[0]).items()
        if area
    ]
    return [SAID.sizes(TARGETS[0], found)] if found else []


COLUMNS = 2
BINS = 40
MARKERS = "osD^v"
RANGE_COLOUR = "#cfe8d5"

SIZE_TITLES = {
    "damaged_area_mm2": "Damaged area [mm²]",
    "damaged_area_share": "Share of the flank [-]",
    "damage_profile_length_mm": "Length along the profile [mm]",
}
RANGE_CAPTION = "Quantities of the healthy records and the ranges of measured healthy gearboxes."
BACKGROUND_CAPTION = (
    "What stands beside the mesh lines in the healthy records, and the ranges of two or three measured machines."
)
REALISM_CAPTION = "Healthy channel-records (grey) against the range of measured healthy gearboxes (green)."
SIZE_CAPTION = (
    "AUC against healthy over the damaged area, with 95 % limits. Dashed: chance. Dotted: 0.75 and 0.85. Damage of one "
    "area is in the tables."
)


def realism_figure(found: Realism) -> Figure:
    """Return one histogram per quantity over its range (green)."""
    rows = -(-len(found.shares) // COLUMNS)
    figure, axes = new_figure(rows, COLUMNS, height_in=1.3 * rows)
    for axis, share in zip(axes.ravel(), found.shares, strict=False):
        _draw_quantity(axis, share)
    for axis in axes.ravel()[len(found.shares) :]:
        axis.set_visible(False)
    return figure


def _draw_quantity(axis: Any, share: QuantityShare) -> None:
    values = share.values[np.isfinite(share.values)]
    ranges = share.quantity.ranges
    low, high = ranges[0][0], ranges[-1][1]
    if values.size:
        # the outermost 2 % would stretch the axis until the range is a line
        points = np.quantile(values, [0.01, 0.99])
        low, high = min(low, points[0]), max(high, points[1])
    margin = 0.06 * (high - low)
    for start, end in ranges:
        axis.axvspan(start, end, color=RANGE_COLOUR, linewidth=0)
    axis.hist(np.clip(values, low, high), bins=np.linspace(low, high, BINS), color=HEALTHY_COLOUR)
    axis.set_xlim(low - margin, high + margin)
    axis.set_yticks([])
    axis.tick_params(labelsize=8)
    colour = PINION_COLOUR if share.inside < 0.5 else "black"
    axis.set_title(f"{share.quantity.title}\n{share.inside:.0%} inside", fontsize=8, color=colour)


def detectability_figure(variants: dict[str, list[Detectability]]) -> Figure:
    """Return AUC over damaged area with intervals: a panel per variant, a marker per fault; dotted: targets.

    Faults whose states do not differ in area stand in the tables only, unless there are no others.
    """
    lines = [line for line in _ladders(variants) if differ_in_area(line[2])] or _ladders(variants)
    names = list(dict.fromkeys(name for name, _, _ in lines))
    faults = list(dict.fromkeys(fault for _, fault, _ in lines))
    figure, axes = new_figure(len(names), 1, height_in=0.9 + 1.9 * len(names), sharex=True, sharey=True)
    named: set[str] = set()
    for name, fault, entries in lines:
        colour, marker = FAULT_COLOURS[faults.index(fault) % len(FAULT_COLOURS)], MARKERS[faults.index(fault) % 5]
        _draw_ladder(axes[names.index(name), 0], entries, colour, marker, None if fault in named else fault)
        named.add(fault)
    for axis, name in zip(axes[:, 0], names, strict=True):
        _frame(axis, name)
    axes[0, 0].set_xlim(0.0, 1.05 * axes[0, 0].get_xlim()[1])
    axes[-1, 0].set_xlabel("Damaged area [mm²]")
    figure.supylabel("AUC against healthy [-]", fontsize=10)
    figure.legend(fontsize=8.5, loc="outside upper center", ncols=min(len(faults), 2))
    return figure


def _ladders(variants: dict[str, list[Detectability]]) -> list[tuple[str, str, list[Detectability]]]:
    """Return what was judged, by variant and fault."""
    found = [
        (name, fault, [entry for entry in entries if entry.fault == fault and np.isfinite(entry.auc.value)])
        for name, entries in variants.items()
        for fault in dict.fromkeys(entry.fault for entry in entries)
    ]
    return [line for line in found if line[2]]


def _draw_ladder(axis: Any, entries: list[Detectability], colour: str, marker: str, label: str | None) -> None:
    value, low, high = (np.array([getattr(entry.auc, part) for entry in entries]) for part in ("value", "low", "high"))
    limits = np.nan_to_num([value - low, high - value]).clip(0.0)
    axis.errorbar(
        [entry.area_mm2 for entry in entries],
        value,
        limits,
        marker=marker,
        markersize=4,
        color=colour,
        label=label,
        capsize=2,
    )


def _frame(axis: Any, name: str) -> None:
    axis.axhline(0.5, color="#9aa7b2", linestyle="--", linewidth=0.8)
    for target in TARGETS:
        axis.axhline(target, color="#9aa7b2", linestyle=":", linewidth=0.8)
    axis.set_ylim(0.3, 1.02)
    axis.set_title(name, loc="left", fontsize=9, fontweight="bold")


def audit_page(audit: Audit, dataset: Dataset, drawn: dict[str, bytes]) -> Page:
    """Return the page."""
    title = f"Audit of {dataset.path.name}"
    tone = "failed" if audit.findings or audit.tells_too_little else "passed"
    parts: list[Block] = [Heading(title, 1), *summary_blocks(audit_summary(audit), tone), Heading("Leaks")]
    parts.append(_findings_table(audit) if audit.findings else Paragraph(audit.verdict))
    if audit.realism:
        parts += [Heading("Against healthy gearboxes"), *_realism_parts(audit.realism, drawn)]
    if audit.reference:
        parts += [Heading("Against your recordings"), *reference_parts(audit.reference)]
    parts.append(Heading("Detectability"))
    parts += detector_parts(audit)
    if audit.best:
        parts += [Paragraph(SAID.how_single()), _best_table(audit)]
    parts += [part for name, found in shown_ladders(audit).items() for part in _detection_parts(name, found, audit)]
    if "detectability" in drawn:
        parts.append(FigureGrid([FigureBlock(drawn["detectability"], SIZE_CAPTION)]))
    parts += [Heading("Notes"), *note_blocks((*audit.notes, provenance(dataset, audit.seed)))]
    return Page(title, parts)


def _best_table(audit: Audit) -> TableBlock:
    rows = [
        (state, Cell(indicator, channel), best.auc, best.held_out)
        for state in audit.states
        if (best := audit.best.get(state))
        for indicator, channel in (best.column.split("__", 1),)
    ]
    head = ["State", "Best indicator", "Its AUC [-]", "Chosen on other gearboxes [-]"]
    tried = max(best.tried for best in audit.best.values())
    caption = f"Best of {counted(tried, 'single indicator')} by state: AUC against healthy, with 95 % limits."
    return table(head, rows, caption, text=True)


def _findings_table(audit: Audit) -> TableBlock:
    rows = [(one.leak, one.measured, one.bound, one.mend) for one in audit.findings]
    caption = "Leaks, what was measured, and how to correct the configuration."
    return table(["Leak", "Measured", "Bound", "How to correct it"], rows, caption, text=True)


def _realism_parts(found: Realism, drawn: dict[str, bytes]) -> list[Block]:
    head = ["Quantity", "Range", "5 %", "Median", "95 %", "Inside [%]", "Undefined [%]"]
    spread_head = ["Quantity", "Median [dB]", "Range [dB]"]
    spread = [(one.name, one.spread_db, f"{one.wanted_db[0]:g} … {one.wanted_db[1]:g}") for one in found.spreads]
    return [
        Paragraph(SAID.inside_all(found)),
        table(head, _share_rows(found.shares), RANGE_CAPTION, ".3g", sortable=True),
        table(head, _share_rows(found.background), BACKGROUND_CAPTION, ".3g", sortable=True),
        table(spread_head, spread, "Spread between the sensors of a gearbox.", ".1f"),
        FigureGrid([FigureBlock(drawn["realism"], REALISM_CAPTION)]),
    ]


def _share_rows(shares: tuple[QuantityShare, ...]) -> list[list[object]]:
    return [
        [
            share.quantity.title,
            " or ".join(f"{low:g} … {high:g}" for low, high in share.quantity.ranges),
            *share.quantiles,
            *(cell(100.0 * part, ".0f") for part in (share.inside, share.undefined)),
        ]
        for share in shares
    ]


def _detection_parts(name: str, entries: list[Detectability], audit: Audit) -> list[Block]:
    sizes = [size for size in SIZES if entries and size in entries[0].sizes]
    rows = [
        (Cell(entry.state, entry.basis or entry.fault), cell(entry.auc), *(entry.sizes[size] for size in sizes))
        for entry in entries
    ]
    title = name[0].upper() + name[1:]
    if not any(math.isfinite(entry.auc.value) for entry in entries):
        return [Heading(title, 3), Paragraph("No state could be judged. The notes give the reason.")]
    caption = f"AUC against healthy on unseen gearboxes by {name}, with 95 % limits from resampled gearboxes."
    reached = [
        f"{fault}: AUC {target:g} {_reached(area)}"
        for target in TARGETS
        for fault, area in area_at(entries, target).items()
        if not audit.gearboxes_needed
    ]
    head = ["State", "AUC [-]", *(SIZE_TITLES[size] for size in sizes)]
    told = [Paragraph(f"Interpolated damaged area: {'; '.join(reached)}.")] if reached else []
    return [Heading(title, 3), table(head, rows, caption, ".3g", sortable=True), *told]


def _reached(area: DetectedArea | None) -> str:
    if area is None:
        return "not reached"
    return f"{'below' if area.is_upper_bound else 'at'} {area.area_mm2:.2g} mm²"
