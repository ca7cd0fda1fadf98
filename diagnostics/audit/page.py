"""The audit as one self-contained page."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from diagnostics.audit.detectability import SIZES, TARGETS, DetectedLength, Detection, length_at
from diagnostics.audit.envelope import Realism
from diagnostics.report import html
from diagnostics.report.html import Cell
from diagnostics.report.tables import interval_cell

if TYPE_CHECKING:
    from diagnostics.audit.audit_report import Audit

HOW = (
    "Logistic regression on log RMS, kurtosis, FM4 and log sideband index, averaged over the channels; cross-validated "
    "by specimen, healthy and faulty records from different specimens; limits: 95 %, resampled specimens. Where a "
    "state is at 0.5 nothing can be found on a gearbox that was not seen before."
)


def audit_page(audit: Audit, dataset: Any, drawn: dict[str, bytes]) -> str:
    """Return the page."""
    title = f"Audit of {dataset.path.name}"
    parts = [html.heading(title, 1), html.paragraph(audit.verdict, "first"), html.heading("Traps")]
    parts.append(_findings_table(audit) if audit.findings else html.paragraph("No trap was found."))
    if audit.realism:
        parts += [html.heading("Against healthy gearboxes"), *_realism_parts(audit.realism, drawn)]
    parts.append(html.heading("Detectability"))
    parts += [html.paragraph(HOW), *(_detection_table(name, found) for name, found in audit.detections.items())]
    if "detectability" in drawn:
        parts.append(html.figure_grid([html.figure_block(drawn["detectability"], "AUC over the size of the damage.")]))
    cost = f"{audit.seconds_per_record:.3f} s per record for measuring; identity {dataset.manifest['identity']}."
    parts += [html.heading("Notes"), *(html.paragraph(note, "note") for note in (*audit.notes, cost))]
    return html.page(title, parts)


def _findings_table(audit: Audit) -> str:
    rows = [[Cell(f.trap), Cell(f.measured), Cell(f.bound), Cell(f.mend)] for f in audit.findings]
    # these cells are sentences: they have to wrap, unlike numbers
    return '<style>.wrap td{white-space:normal;text-align:left}</style><div class="wrap">' + (
        html.table(["Trap", "Measured", "Bound", "How to mend it"], rows) + "</div>"
    )


def _realism_parts(found: Realism, drawn: dict[str, bytes]) -> list[str]:
    text = (
        f"{found.channel_records} healthy channel-records; on average {found.mean_inside:.0%} lie inside the range of "
        f"a quantity, {found.all_inside:.0%} inside all of them. A share says how the distribution lies, not that it "
        "is the right one, and a line counts even where it is noise (see the traps): the ranges pool few machines."
    )
    rows = [
        [
            Cell(share.quantity.title),
            Cell(" or ".join(f"{low:g} … {high:g}" for low, high in share.quantity.ranges)),
            *(Cell(f"{point:.3g}" if math.isfinite(point) else "undefined", value=point) for point in share.quantiles),
            Cell(f"{share.inside:.0%}", value=share.inside),
            Cell(f"{share.undefined:.0%}", value=share.undefined),
        ]
        for share in found.shares
    ]
    head = ["Quantity", "Range", "5 %", "Median", "95 %", "Inside", "Undefined"]
    spread = [
        [Cell(s.name), Cell(f"{s.spread_db:.1f}"), Cell(f"{s.wanted_db[0]:g} … {s.wanted_db[1]:g}")]
        for s in found.spreads
    ]
    return [
        html.paragraph(text),
        html.table(head, rows, sortable=True),
        *([html.table(["Spread between sensors of a gearbox [dB]", "Median", "Range"], spread)] if spread else []),
        html.figure_grid([html.figure_block(drawn["realism"], "Healthy channel-records against the range (green).")]),
    ]


def _detection_table(name: str, entries: list[Detection]) -> str:
    sizes = [size for size in SIZES if entries and size in entries[0].sizes]
    rows = [
        [
            Cell(f"{entry.state} ({entry.fault})"),
            *(Cell(f"{entry.sizes[size]:.3g}", value=entry.sizes[size]) for size in sizes),
            interval_cell(entry.auc),
        ]
        for entry in entries
    ]
    reached = [
        f"{fault}: AUC {target:g} {_reached(length)}"
        for target in TARGETS
        for fault, length in length_at(entries, target).items()
    ]
    return (
        html.heading(name[0].upper() + name[1:], 3)
        + html.table(["State", *(size.replace("_", " ") for size in sizes), "AUC against healthy"], rows)
        + html.paragraph("Interpolated profile length: " + "; ".join(reached) + ".")
    )


def _reached(length: DetectedLength | None) -> str:
    if length is None:
        return "not reached"
    return f"{'below' if length.is_upper_bound else 'at'} {length.length_mm:.2f} mm"
