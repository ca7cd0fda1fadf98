"""A sentence on what the strongest attacker reaches by chance."""

from __future__ import annotations

import math

from diagnostics.audit.audit import Audit
from diagnostics.page.wording import counted, decimal


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
