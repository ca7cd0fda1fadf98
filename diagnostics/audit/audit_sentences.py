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
    name, entries = next(iter(audit.detections.items()), ("", []))
    return [audit.verdict, *found, *_hardest_sentence(name, entries), *_size_sentence(audit.detections)]


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


def _hardest_sentence(name: str, entries: list[Detection]) -> list[str]:
    judged = [entry for entry in entries if math.isfinite(entry.auc.value)]
    if not judged:
        return []
    hardest, easiest = (chosen(judged, key=lambda entry: entry.auc.value) for chosen in (min, max))
    if len(judged) == 1:
        return [f"On unseen gearboxes {hardest.state} is told from healthy with an AUC of {_auc(hardest)} by {name}."]
    lost = [entry.state for entry in judged if entry.auc.value < CHANCE_AUC]
    verdict = (
        f"; {joined(lost)} {'is' if len(lost) == 1 else 'are'} lost in the spread between gearboxes" if lost else ""
    )
    return [
        f"On unseen gearboxes the AUC against healthy by {name} goes from {_auc(hardest)} for {hardest.state} to "
        f"{_auc(easiest)} for {easiest.state}{verdict}."
    ]


def _auc(entry: Detection) -> str:
    return f"{decimal(entry.auc.value)} ({limits(entry.auc)})"


def _size_sentence(detections: dict[str, list[Detection]]) -> list[str]:
    """Say from which length on damage is found at the lower target, by each variant that reaches it."""
    target, parts = TARGETS[0], []
    for name, entries in detections.items():
        for fault, reached in length_at(entries, target).items():
            if reached:
                bound = "at most " if reached.is_upper_bound else ""
                parts.append(f"{bound}{reached.length_mm:.2f}\N{NO-BREAK SPACE}mm of {fault} by {name}")
    return [f"An AUC of {target:g} is reached from {joined(parts)}, lengths along the profile."] if parts else []
