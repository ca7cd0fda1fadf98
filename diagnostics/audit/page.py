"""The audit as one self-contained page."""

from __future__ import annotations

import math

from diagnostics.audit.attack_tables import attack_parts, shown_ladders
from diagnostics.audit.audit import Audit
from diagnostics.audit.audit_sentences import audit_summary
from diagnostics.audit.card_section import tried
from diagnostics.audit.detectability import SIZES, TARGETS, DetectedLength, Detection, length_at
from diagnostics.audit.envelope import QuantityShare, Realism
from diagnostics.audit.reference_tables import reference_parts
from diagnostics.page import html
from diagnostics.page.html import Cell
from diagnostics.page.provenance import provenance
from diagnostics.page.tables import interval_cell
from diagnostics.page.wording import counted, percent
from siggen.dataset.reading import Dataset

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


def _detection_table(name: str, entries: list[Detection], audit: Audit) -> str:
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
