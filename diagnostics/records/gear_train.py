"""Which meshes a gearbox has, from the labels of its records: names, teeth, and how often their shafts turn.

The first mesh has no name and the labels `teeth_pinion` and `teeth_gear`. A further mesh NAME has `teeth_NAME_pinion`
and `teeth_NAME_gear`. Its pinion stands on the shaft of the gear in front. The columns stand in the order of power.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from diagnostics.records.planetary_members import MEMBERS, Planets, planet_labels, planets_of

TEETH = re.compile(r"teeth_(?P<mesh>[a-z][a-z0-9_]*)_pinion")
GEARS = ("pinion", "gear")


@dataclass(frozen=True, slots=True)
class Mesh:
    """One mesh of a gearbox.

    Attributes
    ----------
    name : str
        Empty for the first one.
    teeth : (int, int)
        Of its pinion and its gear.
    turns : Fraction
        Of its pinion per turn of the first pinion.
    before, behind : int
        Teeth of the other gear on its pinion's and on its gear's shaft; 0 where there is none.
    planets : Planets, optional
        Of a planetary set, whose sun and ring are pinion and gear here.
    """

    name: str
    teeth: tuple[int, int]
    turns: Fraction = Fraction(1)
    before: int = 0
    behind: int = 0
    planets: Planets | None = None


@dataclass(frozen=True, slots=True)
class GearNames:
    """What columns of indicators are called after: shafts of the first mesh, and further meshes."""

    shafts: tuple[str, ...] = GEARS
    meshes: tuple[str, ...] = ()

    @property
    def is_planetary(self) -> bool:
        """Whether the shafts are members of a planetary set, which turn against its carrier."""
        return self.shafts == MEMBERS


PAIR = GearNames()


def further_meshes(columns: Iterable[str]) -> tuple[str, ...]:
    """Return the names of the further meshes by the names of label columns; none for gearboxes with one mesh."""
    names = tuple(columns)
    found = (match["mesh"] for name in names if (match := TEETH.fullmatch(name)))
    return tuple(mesh for mesh in found if f"teeth_{mesh}_gear" in names)


def teeth_columns(meshes: Iterable[str]) -> tuple[str, ...]:
    """Return the label columns that hold the teeth of further meshes."""
    return tuple(f"teeth_{mesh}_{gear}" for mesh in meshes for gear in GEARS)


def gear_train(labels: Mapping[str, Any]) -> tuple[Mesh, ...]:
    """Return all meshes of a record's gearbox, the first one first.

    Parameters
    ----------
    labels : mapping of str
        Of the record, in the order of the set's columns.
    """
    if (planets := planets_of(labels)) is not None:
        return (Mesh("", (planets.teeth[0], planets.ring), planets=planets),)
    names = ("", *further_meshes(labels))
    pairs = [_teeth(labels, name) for name in names]
    turns, found = Fraction(1), []
    for place, (name, teeth) in enumerate(zip(names, pairs, strict=True)):
        before = pairs[place - 1][1] if place else 0
        behind = pairs[place + 1][0] if place + 1 < len(pairs) else 0
        found.append(Mesh(name, teeth, turns, before, behind))
        turns *= Fraction(*teeth)
    return tuple(found)


def names_of(train: Sequence[Mesh]) -> GearNames:
    """Return what columns of a gearbox's indicators are called after."""
    shafts = GEARS if train[0].planets is None else MEMBERS
    return GearNames(shafts, tuple(mesh.name for mesh in train[1:]))


def train_labels(train: Sequence[Mesh]) -> dict[str, Any]:
    """Return the labels that `gear_train` makes meshes of: what a file keeps of them."""
    first = train[0]
    if first.planets is not None:
        return planet_labels(first.planets)
    found: dict[str, Any] = {}
    for mesh in train:
        found |= dict(zip(_columns(mesh.name), mesh.teeth, strict=True))
    return found


def _columns(mesh: str) -> tuple[str, ...]:
    return teeth_columns([mesh]) if mesh else ("teeth_pinion", "teeth_gear")


def _teeth(labels: Mapping[str, Any], mesh: str) -> tuple[int, int]:
    pinion, gear = _columns(mesh)
    return int(labels[pinion]), int(labels[gear])
