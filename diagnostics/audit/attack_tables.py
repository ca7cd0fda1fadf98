"""What can and cannot be found in a set: attackers by state, as tables of the page, and for the card."""

from __future__ import annotations

import math

from diagnostics.audit.audit import ALONE, UNPAIRED, WITH_REFERENCE, Audit
from diagnostics.audit.detectability import Detectability
from diagnostics.page import html
from diagnostics.page.html import Cell
from diagnostics.page.tables import interval_cell
from diagnostics.page.wording import capitalised, counted, decimal, joined

TEACHABLE_AUC, CHANCE_AUC = 0.75, 0.6
"""From the first on a state counts as found; below the second a probe has failed."""

HOW = (
    "Attackers learn on some gearboxes and are judged on others. Each band, direction and weight is chosen on the "
    "gearboxes to learn from. Records of one gearbox never stand on both sides. Healthy-referenced attackers see the "
    "difference from a healthy record of the same gearbox, which is not judged itself. The strongest attacker of a "
    "state is chosen after the fact, so its AUC is slightly optimistic. The 95 % limits come from resampled gearboxes."
)


def chance_sentence(audit: Audit) -> str:
    """Say what chance stays below, or what it reaches where that is too much; empty where nothing was judged."""
    chance = audit.chance
    if chance is None or not math.isfinite(chance.auc):
        return ""
    strongest = f"By chance the strongest of {counted(chance.attackers, 'attacker')}"
    limits = [law.auc for law in chance.states.values() if math.isfinite(law.auc)]
    lowest, highest = decimal(chance.auc), decimal(max(limits, default=chance.auc))
    spread = f"a limit between {lowest} and {highest}, by state," if highest != lowest else f"an AUC of {lowest}"
    turns = f"{chance.permutations} permutations of the states."
    if audit.gearboxes_needed is None:
        return f"{strongest} stays below {spread} in 95 % of {turns}"
    return (
        f"{strongest} reaches an AUC of {decimal(chance.auc)} in 5 % of {turns} So no AUC here tells damage from "
        "chance, and no length of damage is named."
    )


def tried(audit: Audit) -> int:
    """Return how many single indicators were tried."""
    return max((best.tried for best in audit.best.values()), default=0)


def _auc(value: float) -> str:
    return f"{value:.2f}" if math.isfinite(value) else "-"


def verdict_words(audit: Audit, state: str) -> str:
    """Say by what a state is found best; where it is not found, by which probes it was looked for in vain.

    What an attacker reaches on a sham is no damage.
    """
    probes = audit.probes(state)
    if not probes:
        return "not judged"
    best = max(probes, key=lambda name: probes[name])
    if audit.gearboxes_needed:
        return f"too few gearboxes to tell ({_auc(probes[best])} by {best})"
    if audit.on_sham(best) >= probes[best] >= lost_below(audit, state):
        return f"not shown to be damage: {best} reaches {_auc(probes[best])}, and {_auc(audit.on_sham(best))} on a sham"
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


def shown_ladders(audit: Audit) -> dict[str, list[Detectability]]:
    """Return the detections that are shown over the size of the damage: the strongest ones, and the older probe."""
    found = {ALONE: audit.ladder(referenced=False), WITH_REFERENCE: audit.ladder(referenced=True)}
    found[UNPAIRED] = audit.detections.get(UNPAIRED, [])
    return {name: entries for name, entries in found.items() if entries}


def attack_parts(audit: Audit) -> list[str]:
    """Return the tables of the attackers; nothing where none could judge."""
    if not audit.states:
        return []
    return [html.paragraph(f"{HOW} {chance_sentence(audit)}".strip()), _strongest_table(audit), _every_table(audit)]


def _strongest_table(audit: Audit) -> str:
    ladders = [{entry.state: entry for entry in audit.ladder(referenced=side)} for side in (False, True)]
    rows = []
    for state in audit.states:
        cells = [Cell(state)]
        for ladder in ladders:
            entry = ladder.get(state)
            cells += [Cell(entry.basis), interval_cell(entry.auc)] if entry else [Cell("–"), Cell("–")]
        rows.append([*cells, _chance_cell(audit, state), Cell(verdict_words(audit, state))])
    head = ["State", "Strongest alone", "AUC [-]", "Strongest with a healthy reference", "AUC [-]", "Chance", "Verdict"]
    caption = (
        "The strongest attacker by state, with what it chose most often: AUC against healthy, with 95 % limits. "
        "Chance: share of permutations, the stated states among them, in which the strongest of all attackers but the "
        "networks, the teeth and the older probes reaches as much. Each state is a test of its own: of twenty "
        "states without any effect one lies at 0.05 or below."
    )
    return html.table(head, rows, caption=caption, text=True)


def _chance_cell(audit: Audit, state: str) -> Cell:
    """Return the p-value of the bank of attackers on a state."""
    law = audit.chance.states.get(state) if audit.chance else None
    if law is None or not math.isfinite(law.p_value):
        return Cell("–")
    return Cell(f"{law.p_value:.3f}", value=law.p_value)


def _every_table(audit: Audit) -> str:
    rows = []
    for name, entries in audit.detections.items():
        by_state = {entry.state: entry.auc.value for entry in entries}
        number = max((entry.tried for entry in entries), default=0)
        cells = [by_state.get(state, math.nan) for state in audit.states]
        shown = [Cell(f"{auc:.2f}" if math.isfinite(auc) else "–", value=auc) for auc in cells]
        rows.append([Cell(capitalised(name)), Cell(str(number), value=number), *shown])
    head = ["Attacker", "Columns", *audit.states]
    caption = "Every attacker on every state: AUC against healthy on gearboxes that were not seen."
    return html.table(head, rows, caption=caption, sortable=True)
