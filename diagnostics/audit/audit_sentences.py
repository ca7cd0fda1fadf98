"""The summary of an audit in a few findings, written from its numbers."""

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
    text = (
        f"The audit used {counted(audit.records, 'record')} of {counted(audit.specimens, 'specimen')} (gearboxes) in "
        f"{counted(audit.channels, 'channel')}."
    )
    if audit.specimens >= FEWEST_SPECIMENS:
        return text
    return (
        f"{text} Traps that only appear between gearboxes may not have been found. Detectability needs "
        f"{FEWEST_SPECIMENS} gearboxes with healthy and {FEWEST_SPECIMENS} with damaged records."
    )


def _realism_sentence(found: Realism) -> str:
    text = (
        f"On average over the quantities, {percent(found.mean_inside)} of "
        f"{counted(found.channel_records, 'healthy channel-record')} lie in the range of measured healthy gearboxes."
    )
    if not found.shares:
        return text
    worst = min(found.shares, key=lambda share: share.inside)
    return f"{text} The share is lowest for {worst.quantity.title}: {percent(worst.inside)}."


def _hardest_sentence(audit: Audit) -> list[str]:
    """Say how well the best shipped indicator finds the hardest state, of how many, and which probes fail."""
    judged = {state: best for state, best in audit.best.items() if math.isfinite(best.held_out)}
    if not judged:
        return []
    hardest, easiest = (chosen(judged, key=lambda state: judged[state].held_out) for chosen in (min, max))
    best = judged[hardest]
    which = f"The state {hardest} is the hardest to find" if len(judged) > 1 else f"The damaged state is {hardest}"
    text = (
        f"{which}: an indicator chosen on other gearboxes reaches an AUC of {decimal(best.held_out)}. The best of "
        f"{counted(best.tried, 'single indicator')}, {best.column}, reaches {decimal(best.auc.value)} "
        f"({limits(best.auc)}) on the same gearboxes that it was chosen on."
    )
    if hardest != easiest:
        easy = decimal(judged[easiest].held_out)
        text += f" For {easiest} an indicator chosen on other gearboxes reaches {easy}."
    lost = [state for state in judged if max(audit.probes(state).values()) < CHANCE_AUC]
    found = (
        [f"No method found {joined(lost)}. These methods failed: {joined(list(audit.probes(lost[0])))}."]
        if lost
        else []
    )
    return [text, *found]


def _size_sentence(detections: dict[str, list[Detection]]) -> list[str]:
    """Say from which length on damage is found at the lower target, by each variant that reaches it."""
    target, parts = TARGETS[0], []
    for name, entries in detections.items():
        for fault, reached in length_at(entries, target).items():
            if reached:
                bound = "at most " if reached.is_upper_bound else ""
                parts.append(f"{bound}{reached.length_mm:.2f}\N{NO-BREAK SPACE}mm of {fault} by {name}")
    return [f"An AUC of {target:g} is reached from {joined(parts)}. Lengths are along the profile."] if parts else []
