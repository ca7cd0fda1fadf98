"""What attackers tell of a sham: damage that was drawn and passed on with nothing removed, which none should find.

A sham is judged as a damaged state is, against the other healthy records, and beside the law of the strongest attacker
under exchanged states: by attackers that see a record alone, and by those that see it beside a healthy record. Where it
is told from healthy, the pipeline leaks. Damage counts as found where an attacker exceeds what it reaches on a sham.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from diagnostics.audit.bank_detections import DESIGN, PERMUTATIONS, StateChance, detection_by, state_chance
from diagnostics.audit.finding import Finding
from diagnostics.audit.measured_set import MeasuredSet, exchange_blocks
from diagnostics.judging.evaluation import Entry
from diagnostics.page.wording import decimal, limits
from diagnostics.records.state_classes import HEALTHY, SHAM
from diagnostics.statistics.evaluation import Interval

TRAP = "sham_told_from_healthy"


@dataclass(frozen=True, slots=True)
class ShamFound:
    """The strongest attacker on one sham, and what chance reaches.

    Attributes
    ----------
    state, side, attacker : str
        `side` says what the attackers see.
    auc : Interval
        Against the other healthy records, on gearboxes that were not learnt from.
    chance : StateChance, optional
        Of all attackers that can be permuted.
    reached : dict of str to float
        AUC of every attacker.
    """

    state: str
    side: str
    attacker: str
    auc: Interval
    chance: StateChance | None
    reached: dict[str, float]

    @property
    def told(self) -> bool:
        """Whether attackers reach more than chance does in 5 % of the cases."""
        return self.chance is not None and self.chance.p_value <= 0.05

    def numbers(self) -> dict[str, Any]:
        """Return everything for JSON."""
        return {
            "state": self.state,
            "side": self.side,
            "attacker": self.attacker,
            "auc": self.auc.numbers(),
            "chance": asdict(self.chance) if self.chance else None,
            "told": self.told,
            "auc_by_attacker": self.reached,
        }


def shams_found(measured: MeasuredSet, sides: Mapping[str, Sequence[Entry]], seed: int) -> tuple[ShamFound, ...]:
    """Return what attackers reach on every sham of a set, by what they see.

    None for a set without a sham, with too few gearboxes, or without a healthy record that a sham can stand beside.
    """
    labels = measured.labels
    if SHAM not in labels:
        return ()
    sham = labels[SHAM].astype(bool)
    # As the bank judges damage: a sham's records are no healthy ones while it is asked for.
    asked = replace(measured, labels={**labels, "fault": np.where(sham, SHAM, labels["fault"])})
    folds = DESIGN.dealt(labels["specimen_id"], seed)
    states = dict.fromkeys(labels["state"][sham].tolist())
    found = (_found(asked, (side, bank), state, folds, seed) for state in states for side, bank in sides.items())
    return tuple(one for one in found if one is not None)


def _found(
    asked: MeasuredSet, bank: tuple[str, Sequence[Entry]], state: str, folds: np.ndarray, seed: int
) -> ShamFound | None:
    side, attackers = bank
    every = [(detection_by(asked, one, state, folds, seed).auc, one.name) for one in attackers]
    defined = [(auc, name) for auc, name in every if math.isfinite(auc.value)]
    if not defined:
        return None
    auc, name = max(defined, key=lambda entry: entry[0].value)
    permutable = [one for one in attackers if one.many]
    chance = state_chance(asked, permutable, state, folds, exchange_blocks(asked), seed)
    return ShamFound(state, side, name, auc, chance, {name: auc.value for auc, name in defined})


def sham_traps(found: Sequence[ShamFound]) -> list[Finding]:
    """Return a finding for every sham that attackers tell better than in any of the permutations.

    That happens to one of 500 sets without a leak, by each side.
    """
    return [
        Finding(
            TRAP,
            f"{one.attacker} tells {one.state}, damage without any effect, from healthy records with an AUC of "
            f"{one.auc.value:.2f} ({one.auc.low:.2f} to {one.auc.high:.2f})",
            f"in none of {PERMUTATIONS} permutations the strongest attacker reaches as much",
            "Find what differs between records of damaged states and healthy ones besides the teeth: what was drawn, "
            "in which order, by which program.",
        )
        for one in found
        if one.chance is not None and one.chance.p_value * (1 + PERMUTATIONS) < 1.5
    ]


def sham_sentences(found: Sequence[ShamFound]) -> list[str]:
    """Say of every sham how well it is told from healthy records, and what that means."""
    return [
        f"{one.state} is a sham: its damage was drawn and passed on with nothing removed. The strongest attacker "
        f"{one.side}, {one.attacker}, tells it from {HEALTHY} with an AUC of {decimal(one.auc.value)} "
        f"({limits(one.auc)}); {_chance_text(one)}"
        for one in found
    ]


def _chance_text(one: ShamFound) -> str:
    if one.chance is None or not math.isfinite(one.chance.auc):
        return "what chance reaches is not known."
    said = f"chance reaches {decimal(one.chance.auc)} in 5 % of the cases."
    return f"{said} More than chance: damage counts as found only above this AUC." if one.told else said
