"""The summary of an audit in at most five sentences, written from its numbers."""

from __future__ import annotations

import math

from diagnostics.audit.audit import Audit
from diagnostics.audit.card_section import CHANCE_AUC
from diagnostics.audit.detectability import FEWEST_SPECIMENS, TARGETS, Detection, length_at
from diagnostics.audit.envelope import Realism
from diagnostics.page.wording import counted, decimal, joined, limits, percent


def audit_summary(audit: Audit) -> list[str]:
    """Return the verdict, what it rests on, realism where asked for, the hardest state, the size that is found."""
    found = [basis_sentence(audit)]
    found += [_realism_sentence(audit.realism)] if audit.realism else []
    return [audit.verdict, *found, *_hardest_sentence(audit), *_size_sentence(audit.detections)]


def basis_sentence(audit: Audit) -> str:
    """Say how much the audit has judged on, and what so few gearboxes leave open."""
    text = f"Judged on {counted(audit.records, 'record')} of {counted(audit.specimens, 'specimen')} (gearboxes)"
    if audit.specimens >= FEWEST_SPECIMENS:
        return f"{text} in {counted(audit.channels, 'channel')}."
    return (
        f"{text} in {counted(audit.channels, 'channel')}: traps that show between gearboxes may have "
        f"stayed unseen, and detectability needs {FEWEST_SPECIMENS} with healthy and {FEWEST_SPECIMENS} with damaged "
        "records."
    )


def _realism_sentence(found: Realism) -> str:
    text = (
        f"Of {counted(found.channel_records, 'healthy channel-record')} {percent(found.mean_inside)} on average lie "
        "inside the range that measured healthy gearboxes show for a quantity"
    )
    if not found.shares:
        return f"{text}."
    worst = min(found.shares, key=lambda share: share.inside)
    return f"{text}; fewest do for {worst.quantity.title}, with {percent(worst.inside)}."


def _hardest_sentence(audit: Audit) -> list[str]:
    """Say how well the best shipped indicator finds the hardest state, of how many, and which probes fail."""
    judged = {state: best for state, best in audit.best.items() if math.isfinite(best.held_out)}
    if not judged:
        return []
    hardest, easiest = (chosen(judged, key=lambda state: judged[state].held_out) for chosen in (min, max))
    best = judged[hardest]
    which = "hardest to tell from healthy" if len(judged) > 1 else "told from healthy"
    text = (
        f"The state {hardest} is {which}: the best of {counted(best.tried, 'single indicator')}, {best.column}, "
        f"reaches an AUC of {decimal(best.auc.value)} ({limits(best.auc)}) on the gearboxes that chose it, and the "
        f"best that other gearboxes choose {decimal(best.held_out)}"
    )
    if hardest != easiest:
        text += f"; for {easiest} that is {decimal(judged[easiest].held_out)}"
    lost = [state for state in judged if max(audit.probes(state).values()) < CHANCE_AUC]
    found = [f"No probe found {joined(lost)}: {joined(list(audit.probes(lost[0])))} failed."] if lost else []
    return [f"{text}.", *found]


def _size_sentence(detections: dict[str, list[Detection]]) -> list[str]:
    """Say from which length on damage is found at the lower target, by each variant that reaches it."""
    target, parts = TARGETS[0], []
    for name, entries in detections.items():
        for fault, reached in length_at(entries, target).items():
            if reached:
                bound = "at most " if reached.is_upper_bound else ""
                parts.append(f"{bound}{reached.length_mm:.2f}\N{NO-BREAK SPACE}mm of {fault} by {name}")
    return [f"An AUC of {target:g} is reached from {joined(parts)}, lengths along the profile."] if parts else []
