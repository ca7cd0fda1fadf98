"""The audit as one self-contained page.

Figures of the audit: every quantity against its range, and AUC over the size of the damage.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.audit.attack_tables import attack_parts, shown_ladders, tried
from diagnostics.audit.audit import Audit
from diagnostics.audit.audit_sentences import audit_summary, reference_parts
from diagnostics.audit.detectability import SIZES, TARGETS, Detectability, DetectedLength, differ_in_length, length_at
from diagnostics.audit.envelope import QuantityShare, Realism
from diagnostics.page import html
from diagnostics.page.html import Cell
from diagnostics.page.provenance import provenance
from diagnostics.page.style import FAULT_COLOURS, HEALTHY_COLOUR, PINION_COLOUR, new_figure
from diagnostics.page.tables import interval_cell
from diagnostics.page.wording import counted, percent
from siggen.dataset.reading import Dataset

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLUMNS = 2
BINS = 40
MARKERS = "osD^v"
RANGE_COLOUR = "#cfe8d5"

HOW_SINGLE = (
    "The table has the best of all indicators in all channels, by state. Its AUC is optimistic, because the indicator "
    'is chosen on the same gearboxes. The AUC "chosen on other gearboxes" is not: half of the gearboxes choose the '
    "indicator, the other half judge it."
)
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
    "AUC against healthy over the length of the damage along the profile, with 95 % limits. Dashed: chance. Dotted: "
    "0.75 and 0.85. Damage that grows along the face only is in the tables."
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
    """Return AUC over profile length with intervals: a panel per variant, a marker per fault; dotted: targets.

    Faults whose states do not differ in length stand in the tables only, unless there are no others.
    """
    lines = [line for line in _ladders(variants) if differ_in_length(line[2])] or _ladders(variants)
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
    axes[-1, 0].set_xlabel("Length of the damage along the profile [mm]")
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
    length = [entry.sizes.get(SIZES[2], entry.sizes[SIZES[0]]) for entry in entries]
    value, low, high = (np.array([getattr(entry.auc, part) for entry in entries]) for part in ("value", "low", "high"))
    limits = np.nan_to_num([value - low, high - value]).clip(0.0)
    axis.errorbar(length, value, limits, marker=marker, markersize=4, color=colour, label=label, capsize=2)


def _frame(axis: Any, name: str) -> None:
    axis.axhline(0.5, color="#9aa7b2", linestyle="--", linewidth=0.8)
    for target in TARGETS:
        axis.axhline(target, color="#9aa7b2", linestyle=":", linewidth=0.8)
    axis.set_ylim(0.3, 1.02)
    axis.set_title(name, loc="left", fontsize=9, fontweight="bold")


def audit_page(audit: Audit, dataset: Dataset, drawn: dict[str, bytes]) -> str:
    """Return the page."""
    title = f"Audit of {dataset.path.name}"
    parts = [html.heading(title, 1), *html.summary(audit_summary(audit)), html.heading("Traps")]
    parts.append(_findings_table(audit) if audit.findings else html.paragraph(audit.verdict))
    if audit.realism:
        parts += [html.heading("Against healthy gearboxes"), *_realism_parts(audit.realism, drawn)]
    if audit.reference:
        parts += [html.heading("Against your recordings"), *reference_parts(audit.reference)]
    parts.append(html.heading("Detectability"))
    parts += attack_parts(audit)
    if audit.best:
        parts += [html.paragraph(HOW_SINGLE), _best_table(audit)]
    parts += [_detection_table(name, found, audit) for name, found in shown_ladders(audit).items()]
    if "detectability" in drawn:
        parts.append(html.figure_grid([html.figure_block(drawn["detectability"], SIZE_CAPTION)]))
    parts += [html.heading("Notes"), *html.notes((*audit.notes, provenance(dataset, audit.seed)))]
    return html.page(title, parts)


def _best_table(audit: Audit) -> str:
    rows = [
        [
            Cell(state),
            Cell(best.column.split("__", 1)[0], best.column.split("__", 1)[1]),
            interval_cell(best.auc),
            Cell(f"{best.held_out:.2f}" if math.isfinite(best.held_out) else "–", value=best.held_out),
        ]
        for state, best in ((state, audit.best[state]) for state in audit.states if state in audit.best)
    ]
    head = ["State", "Best indicator", "Its AUC [-]", "Chosen on other gearboxes [-]"]
    caption = f"Best of {counted(tried(audit), 'single indicator')} by state: AUC against healthy, with 95 % limits."
    return html.table(head, rows, caption=caption, text=True)


def _findings_table(audit: Audit) -> str:
    rows = [[Cell(f.trap), Cell(f.measured), Cell(f.bound), Cell(f.mend)] for f in audit.findings]
    caption = "Traps, what was measured, and how to correct the configuration."
    return html.table(["Trap", "Measured", "Bound", "How to correct it"], rows, caption=caption, text=True)


def _realism_parts(found: Realism, drawn: dict[str, bytes]) -> list[str]:
    text = (
        f"{percent(found.all_inside)} of {counted(found.channel_records, 'healthy channel-record')} lie inside the "
        "ranges of all quantities. A share does not prove that the distribution is right: the ranges come from few "
        "machines. A spectral line counts even where it is only noise (see the traps)."
    )
    head = ["Quantity", "Range", "5 %", "Median", "95 %", "Inside [%]", "Undefined [%]"]
    spread_head = ["Quantity", "Median [dB]", "Range [dB]"]
    spread = [
        [Cell(s.name), Cell(f"{s.spread_db:.1f}"), Cell(f"{s.wanted_db[0]:g} … {s.wanted_db[1]:g}")]
        for s in found.spreads
    ]
    return [
        html.paragraph(text),
        html.table(head, _share_rows(found.shares), caption=RANGE_CAPTION, sortable=True),
        *(
            [html.table(head, _share_rows(found.background), caption=BACKGROUND_CAPTION, sortable=True)]
            if found.background
            else []
        ),
        *([html.table(spread_head, spread, caption="Spread between the sensors of a gearbox.")] if spread else []),
        html.figure_grid([html.figure_block(drawn["realism"], REALISM_CAPTION)]),
    ]


def _share_rows(shares: tuple[QuantityShare, ...]) -> list[list[Cell]]:
    return [
        [
            Cell(share.quantity.title),
            Cell(" or ".join(f"{low:g} … {high:g}" for low, high in share.quantity.ranges)),
            *(Cell(f"{point:.3g}" if math.isfinite(point) else "undefined", value=point) for point in share.quantiles),
            Cell(f"{100.0 * share.inside:.0f}", value=share.inside),
            Cell(f"{100.0 * share.undefined:.0f}", value=share.undefined),
        ]
        for share in shares
    ]


def _detection_table(name: str, entries: list[Detectability], audit: Audit) -> str:
    sizes = [size for size in SIZES if entries and size in entries[0].sizes]
    rows = [
        [
            Cell(entry.state, entry.basis or entry.fault),
            interval_cell(entry.auc),
            *(Cell(f"{entry.sizes[size]:.3g}", value=entry.sizes[size]) for size in sizes),
        ]
        for entry in entries
    ]
    title = name[0].upper() + name[1:]
    if not any(math.isfinite(entry.auc.value) for entry in entries):
        return html.heading(title, 3) + html.paragraph("No state could be judged. The notes give the reason.")
    caption = f"AUC against healthy on unseen gearboxes by {name}, with 95 % limits from resampled gearboxes."
    reached = [
        f"{fault}: AUC {target:g} {_reached(length)}"
        for target in TARGETS
        for fault, length in length_at(entries, target).items()
        if not audit.gearboxes_needed
    ]
    return (
        html.heading(title, 3)
        + html.table(["State", "AUC [-]", *(SIZE_TITLES[size] for size in sizes)], rows, caption=caption, sortable=True)
        + (html.paragraph("Interpolated length along the profile: " + "; ".join(reached) + ".") if reached else "")
    )


def _reached(length: DetectedLength | None) -> str:
    if length is None:
        return "not reached"
    return f"{'below' if length.is_upper_bound else 'at'} {length.length_mm:.2f} mm"
