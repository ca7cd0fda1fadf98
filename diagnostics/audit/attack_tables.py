"""What the attackers reached, as tables of the page: the strongest by state, and every one of them."""

from __future__ import annotations

import math

from diagnostics.audit.audit import ALONE, UNPAIRED, WITH_REFERENCE, Audit
from diagnostics.audit.card_section import verdict_words
from diagnostics.audit.chance_sentence import chance_sentence
from diagnostics.audit.detectability import Detection
from diagnostics.page import html
from diagnostics.page.html import Cell
from diagnostics.page.tables import interval_cell
from diagnostics.page.wording import capitalised

HOW = (
    "Attackers learn on some gearboxes and are judged on others. Each band, direction and weight is chosen on the "
    "gearboxes to learn from. Records of one gearbox never stand on both sides. Healthy-referenced attackers see the "
    "difference from a healthy record of the same gearbox, which is not judged itself. The strongest attacker of a "
    "state is chosen after the fact, so its AUC is slightly optimistic. The 95 % limits come from resampled gearboxes."
)


def shown_ladders(audit: Audit) -> dict[str, list[Detection]]:
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
        "networks and the older probes reaches as much. Each state is a test of its own: of twenty states without any "
        "effect one lies at 0.05 or below."
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
