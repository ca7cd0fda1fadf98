"""What attackers tell of a sham: damage that was drawn and passed on with nothing removed, which none should find.

A sham is judged as a damaged state is, against the other healthy records, and beside the law of the strongest attacker
under exchanged states. Where it is told from healthy, the pipeline leaks, and detection of damage means that much less.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from diagnostics.audit.bank_detections import StateChance, detection_by, state_chance
from diagnostics.audit.held_out import Attacker, dealt_folds
from diagnostics.audit.measured_set import MeasuredSet, exchange_blocks
from diagnostics.page.wording import decimal, limits
from diagnostics.records.state_classes import HEALTHY, SHAM
from diagnostics.statistics.evaluation import Interval


@dataclass(frozen=True, slots=True)
class ShamFound:
    """The strongest attacker on one sham, and what chance reaches.

    Attributes
    ----------
    state, attacker : str
    auc : Interval
        Against the other healthy records, on gearboxes that were not learnt from.
    chance : StateChance, optional
        Of all attackers that can be permuted.
    """

    state: str
    attacker: str
    auc: Interval
    chance: StateChance | None

    @property
    def told(self) -> bool:
        """Whether attackers reach more than chance does in 5 % of the cases."""
        return self.chance is not None and self.chance.p_value <= 0.05

    def numbers(self) -> dict[str, Any]:
        """Return everything for JSON."""
        return {
            "state": self.state,
            "attacker": self.attacker,
            "auc": self.auc.numbers(),
            "chance": asdict(self.chance) if self.chance else None,
            "told": self.told,
        }


def shams_found(measured: MeasuredSet, attackers: Sequence[Attacker], seed: int) -> tuple[ShamFound, ...]:
    """Return what a bank of attackers reaches on every sham of a set; none for a set without or too few gearboxes."""
    labels = measured.labels
    if SHAM not in labels:
        return ()
    sham = labels[SHAM].astype(bool)
    # As the bank judges damage: a sham's records are no healthy ones while it is asked for.
    asked = replace(measured, labels={**labels, "fault": np.where(sham, SHAM, labels["fault"])})
    folds = dealt_folds(labels["specimen_id"], seed)
    found = (_found(asked, attackers, state, folds, seed) for state in dict.fromkeys(labels["state"][sham].tolist()))
    return tuple(one for one in found if one is not None)


def _found(
    asked: MeasuredSet, attackers: Sequence[Attacker], state: str, folds: np.ndarray, seed: int
) -> ShamFound | None:
    every = [(detection_by(asked, one, state, folds, seed).auc, one.name) for one in attackers]
    defined = [(auc, name) for auc, name in every if math.isfinite(auc.value)]
    if not defined:
        return None
    auc, name = max(defined, key=lambda entry: entry[0].value)
    permutable = [one for one in attackers if one.permutable]
    return ShamFound(state, name, auc, state_chance(asked, permutable, state, folds, exchange_blocks(asked), seed))


def sham_sentences(found: Sequence[ShamFound]) -> list[str]:
    """Say of every sham how well it is told from healthy records, and what that means."""
    return [
        f"{one.state} is a sham: its damage was drawn and passed on with nothing removed. The strongest attacker, "
        f"{one.attacker}, tells it from {HEALTHY} with an AUC of {decimal(one.auc.value)} ({limits(one.auc)}); "
        f"{_chance_text(one)}"
        for one in found
    ]


def _chance_text(one: ShamFound) -> str:
    if one.chance is None or not math.isfinite(one.chance.auc):
        return "what chance reaches is not known."
    said = f"chance reaches {decimal(one.chance.auc)} in 5 % of the cases."
    return f"{said} So the set leaks: damage counts as found only above this AUC." if one.told else said
