"""What a set can and cannot teach, in Markdown, from its audit."""

from __future__ import annotations

import math

from diagnostics.audit.audit import Audit

TEACHABLE_AUC, CHANCE_AUC = 0.75, 0.6
"""From the first on a state counts as found; below the second as lost in the spread between gearboxes."""


def card_section(audit: Audit) -> str:
    """Return the section for the card; it ends with a line break."""
    lines = ["## What this set was measured to teach", "", audit.verdict, ""]
    lines += [
        f"* **{finding.trap}**: {finding.measured}; {finding.bound}. {finding.mend}" for finding in audit.findings
    ]
    if audit.findings:
        lines.append("")
    if audit.realism:
        lines += [
            f"Against recordings of healthy gearboxes: of {audit.realism.channel_records} healthy channel-records on "
            f"average {audit.realism.mean_inside:.0%} lie inside the range of a quantity.",
            "",
            "| quantity | median | inside |",
            "|---|---|---|",
            *(f"| {s.quantity.title} | {s.quantiles[1]:.3g} | {s.inside:.0%} |" for s in audit.realism.shares),
            "",
        ]
    for name, entries in audit.detections.items():
        lines += [f"AUC against healthy on other specimens, from {name}:", "", "| state | AUC | |", "|---|---|---|"]
        lines += [f"| {entry.state} | {_auc(entry.auc.value)} | {_word(entry.auc.value)} |" for entry in entries]
        lines.append("")
    lines.append("From `siggen-diagnostics audit`; simulated data, judged on simulated data.")
    return "\n".join(lines) + "\n"


def _auc(value: float) -> str:
    return f"{value:.2f}" if math.isfinite(value) else "-"


def _word(value: float) -> str:
    if not math.isfinite(value):
        return "not judged"
    if value >= TEACHABLE_AUC:
        return "can be found"
    return "lost in the spread between gearboxes" if value < CHANCE_AUC else "hard"
