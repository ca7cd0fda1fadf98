"""The damage of a pair as a whole: rows of a flank, what cannot be, contacts without land. Derived."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from math import gcd

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.covering import hidden_rows
from siggen.damage.part import Damage, DamageProblem, Refusal, ToothDamage, damaged_teeth, pits_of
from siggen.damage.row_columns import COLUMNS, FACE
from siggen.damage.whole_loss import takes_whole_contact
from siggen.errors import mm
from siggen.gears.gear_pair import GearPair
from siggen.names import SECTIONS, Side


def pit_rows(pits: Iterable[ToothDamage]) -> FloatArray:
    """Return the damage of one flank as rows (n, 14).

    Columns: `siggen.damage.row_columns`. Sorted, without duplicates and without what a deeper one hides: a
    union depends on none of these, and neither does any bit of what follows.

    Raises
    ------
    ValueError
        If one is not finite, has no extent, an unknown floor or edges that cross.
    """
    return _rows_of(tuple(pits)).copy()


@lru_cache(maxsize=64)  # tables and labels ask some twenty times for the same teeth
def _rows_of(pits: Damage) -> FloatArray:
    for index, pit in enumerate(pits):
        for problem in _located(index, pit, pit.own_problems()):
            raise ValueError(str(problem))
    found = [row for pit in pits for row in pit.rows()]
    rows = np.unique(np.array(found, dtype=np.float64).reshape(-1, COLUMNS), axis=0)
    rows = rows[np.argsort(rows[:, FACE], kind="stable")]  # across the face, as their intervals are sorted
    return rows[~hidden_rows(rows)] if len(rows) > 1 else rows


def damage_problems(
    pair: GearPair, damage: Iterable[ToothDamage], called: Sequence[str] = SECTIONS
) -> tuple[DamageProblem, ...]:
    """Return everything that makes a damage impossible on a pair without geometry problems; empty for a possible one.

    Every damage says itself what is wrong with it and its place. No contact may lose its whole length, neither by one
    flank nor by two mating ones together; that is looked for only when every damage is possible by itself. `called`:
    both gears in sentences.
    """
    damage = tuple(damage)
    return single_problems(pair, damage) or tuple(_contact_problems(pair, damage, called))


def single_problems(pair: GearPair, damage: Iterable[ToothDamage]) -> tuple[DamageProblem, ...]:
    """Return what is wrong with each damage by itself; a contact without length is none of it."""
    problems: list[DamageProblem] = []
    for index, pit in enumerate(damage):
        own = tuple(pit.own_problems())
        problems.extend(_located(index, pit, own or pit.place_problems(pair)))
    return tuple(problems)


def _located(index: int, damage: ToothDamage, refusals: Iterable[Refusal]) -> Iterator[DamageProblem]:
    for name, received, allowed in refusals:
        yield DamageProblem(index, received, allowed, damage.kind, name)


def _contact_problems(pair: GearPair, damage: Damage, called: Sequence[str]) -> Iterator[DamageProblem]:
    for side, tooth, mate in lost_contacts(pair, damage):
        index, pit = next((i, pit) for i, pit in enumerate(damage) if pit.gear == side and pit.tooth == tooth)
        together = "" if mate is None else f" together with {called[side.mate.number]} tooth {mate}"
        flank = f"{called[side.number]} tooth {tooth}{together}"
        received = f"{_kinds(damage, side, tooth)} of {flank} that take the whole contact length"
        allowed = f"a loss below the face width {mm(pair.face_width_m)} everywhere"
        yield DamageProblem(index, received, allowed, pit.kind, "contact")


def _kinds(damage: Damage, side: Side, tooth: int) -> str:
    kinds = sorted({pit.kind for pit in pits_of(damage, side, tooth)})
    return " and ".join(f"{kind}s" for kind in kinds)


def lost_contacts(pair: GearPair, damage: Damage) -> Iterator[tuple[Side, int, int | None]]:
    """Yield (gear, tooth, None) of flanks without contact length somewhere on the path of contact.

    Then (the driver, tooth, tooth of the gear) of meeting flanks that only together leave none.
    """
    rows = {
        (side, tooth): pit_rows(pits_of(damage, side, tooth)) for side in Side for tooth in damaged_teeth(damage, side)
    }
    none = np.empty((0, COLUMNS))
    whole: set[tuple[str, int]] = set()
    for (side, tooth), own in rows.items():
        first, second = (own, none) if side == Side.DRIVER else (none, own)
        if takes_whole_contact(pair, first, second):
            whole.add((side, tooth))
            yield side, tooth, None
    shared = gcd(pair.pinion.teeth, pair.gear.teeth)
    for i in damaged_teeth(damage, Side.DRIVER):
        for j in damaged_teeth(damage, Side.DRIVEN):
            if (i - j) % shared or (Side.DRIVER, i) in whole or (Side.DRIVEN, j) in whole:
                continue
            if takes_whole_contact(pair, rows[Side.DRIVER, i], rows[Side.DRIVEN, j]):
                yield Side.DRIVER, i, j
