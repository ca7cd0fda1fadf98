"""What can and cannot be found in a set, in Markdown, from its audit."""

from __future__ import annotations

import math

from diagnostics.audit.audit import SINGLE, Audit
from diagnostics.page.wording import joined

TEACHABLE_AUC, CHANCE_AUC = 0.75, 0.6
"""From the first on a state counts as found; below the second a probe has failed."""


def card_section(audit: Audit) -> str:
    """Return the section for the card; it ends with a line break."""
    lines = ["## What this set was measured to teach", "", audit.verdict, ""]
    lines += [
        f"* **{finding.trap}**: {finding.measured}. Bound: {finding.bound}. To correct it: {finding.mend}"
        for finding in audit.findings
    ]
    if audit.findings:
        lines.append("")
    if audit.realism:
        lines += [
            f"Averaged over the quantities, {audit.realism.mean_inside:.0%} of {audit.realism.channel_records} healthy "
            "channel-records lie inside the range of recordings of healthy gearboxes.",
            "",
            "| quantity | median | inside |",
            "|---|---|---|",
            *(f"| {s.quantity.title} | {s.quantiles[1]:.3g} | {s.inside:.0%} |" for s in audit.realism.shares),
            "",
        ]
    lines += [*probe_table(audit), ""] if audit.states else []
    lines.append("These values come from `siggen-diagnostics audit`. Simulated data were judged on simulated data.")
    return "\n".join(lines) + "\n"


def probe_table(audit: Audit) -> list[str]:
    """Return what every probe reached for every state, and what that means."""
    names = list(dict.fromkeys(name for state in audit.states for name in audit.probes(state)))
    head = ["state", "best indicator", "its AUC", *(_heading(name, audit) for name in names), "verdict"]
    rows = []
    for state in audit.states:
        best, probes = audit.best.get(state), audit.probes(state)
        own = [f"`{best.column}`", _auc(best.auc.value)] if best else ["-", "-"]
        rows.append([state, *own, *(_auc(probes.get(name, math.nan)) for name in names), verdict_words(audit, state)])
    return [
        "The table gives the AUC against healthy. The AUC of the best indicator is optimistic: it is chosen on the "
        "same gearboxes. The other columns are judged on gearboxes that were not seen.",
        "",
        f"| {' | '.join(head)} |",
        f"|{'---|' * len(head)}",
        *(f"| {' | '.join(row)} |" for row in rows),
    ]


def _heading(name: str, audit: Audit) -> str:
    return f"best of {tried(audit)}, chosen on other gearboxes" if name == SINGLE else name


def tried(audit: Audit) -> int:
    """Return how many single indicators were tried."""
    return max((best.tried for best in audit.best.values()), default=0)


def _auc(value: float) -> str:
    return f"{value:.2f}" if math.isfinite(value) else "-"


def verdict_words(audit: Audit, state: str) -> str:
    """Say by what a state is found best; where it is not found, by which probes it was looked for in vain."""
    probes = audit.probes(state)
    if not probes:
        return "not judged"
    best = max(probes, key=lambda name: probes[name])
    if audit.gearboxes_needed:
        return f"too few gearboxes to tell ({_auc(probes[best])} by {best})"
    if probes[best] >= max(TEACHABLE_AUC, lost_below(audit, state)):
        return f"can be found, best by {best} ({_auc(probes[best])})"
    tried = joined([f"{name} ({_auc(auc)})" for name, auc in probes.items()])
    if probes[best] < lost_below(audit, state):
        return f"not found by {tried}"
    return f"hard to find, best by {best} ({_auc(probes[best])}) of {tried}"


def lost_below(audit: Audit, state: str) -> float:
    """Return the AUC below which a state counts as lost: 0.6, or what the strongest attacker reaches by chance."""
    limit = audit.chance.of(state) if audit.chance else math.nan
    return max(CHANCE_AUC, limit) if math.isfinite(limit) else CHANCE_AUC
