"""What records of a gearbox are averaged by: its meshes, their gears by the user's names, and how often shafts turn.

All follows from the drivetrain that a set stores, or that options of a command give for recordings. Against its carrier
the sun of a planetary set whose ring is held turns once in as many mesh periods as it has teeth, and so do planets and
ring. So sun and ring are to each other as the gears of a pair, with pulses that come once per turn of the sun against
the carrier: records of such a set are read in that way.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from siggen.columns.drivetrain import GearTrain, TrainGear, TrainMesh, TrainShaft

EVEN = 1e-9
"""Turns by which evenly spaced planets may stand off: rounding of degrees."""


@dataclass(frozen=True, slots=True)
class Planets:
    """Teeth of sun, planets and ring, and where the planets stand on the carrier, in turns of it."""

    teeth: tuple[int, int, int]
    places: tuple[float, ...]

    @property
    def ring(self) -> int:
        """Teeth of the ring."""
        return self.teeth[2]

    @property
    def passing(self) -> int:
        """Orders of the carrier that equal planets leave a sensor are multiples of this: 1 at unequal distances."""
        gaps = np.diff(np.sort(np.asarray(self.places)), append=min(self.places) + 1.0)
        return len(self.places) if float(np.ptp(gaps)) < EVEN else 1

    @property
    def sun_turns(self) -> Fraction:
        """Turns of the sun against the carrier per turn of its shaft. Source: Willis."""
        sun, _, ring = self.teeth
        return Fraction(ring, sun + ring)


class MeshNames(NamedTuple):
    """What indicators of a mesh are called after: its name, empty of a plain pair, and its gears in order of power.

    A planetary set counts as one mesh of sun, planet and ring, whose averages are against the carrier.
    """

    name: str
    gears: tuple[str, ...]
    planetary: bool = False


GearNames: TypeAlias = tuple[MeshNames, ...]
"""Of all meshes, the first one first."""
Gearing: TypeAlias = GearTrain | tuple[int, int]
"""A drivetrain with teeth, or the teeth of one pair."""
PAIR: GearNames = (MeshNames("", ("pinion", "gear")),)
"""Of recordings of which teeth alone are known."""


@dataclass(frozen=True, slots=True)
class GearMesh:
    """One mesh of a gearbox.

    Attributes
    ----------
    names : MeshNames
    teeth : (int, int)
        Of its driver and its driven gear; of a planetary set of sun and ring.
    turns : Fraction
        Of its driver per turn of the input.
    before, behind : int
        Teeth of the other gear on the driver's and on the driven gear's shaft; 0 where there is none.
    planets : Planets, optional
        Of a planetary set.
    """

    names: MeshNames
    teeth: tuple[int, int]
    turns: Fraction = Fraction(1)
    before: int = 0
    behind: int = 0
    planets: Planets | None = None


def in_column(gear: str) -> str:
    """Return what parts of the names of columns call a gear; an idler's flank is MESH.NAME."""
    return "_".join(gear.split("."))


def pair_train(teeth: tuple[int, int], names: MeshNames = PAIR[0]) -> GearTrain:
    """Return the drivetrain of one pair of gears, each on a shaft of its name."""
    turns = ((1, 1), Fraction(*teeth).as_integer_ratio())
    return GearTrain(
        shafts=tuple(TrainShaft(name=gear, turns=turn) for gear, turn in zip(names.gears, turns, strict=True)),
        gears=tuple(TrainGear(name=gear, shaft=gear, teeth=z) for gear, z in zip(names.gears, teeth, strict=True)),
        meshes=(TrainMesh(name=names.name, driver=names.gears[0], driven=names.gears[1], order=(teeth[0], 1)),),
    )


def train_of(gears: Gearing) -> GearTrain:
    """Return the drivetrain of what a caller knows: all of it, or the teeth of one pair."""
    return gears if isinstance(gears, GearTrain) else pair_train(gears)


def with_teeth(train: GearTrain, teeth: Mapping[str, Any]) -> GearTrain:
    """Return a drivetrain with the teeth of one gearbox, by gear, as they stand in its labels."""
    return replace(train, gears=tuple(replace(gear, teeth=teeth[gear.name]) for gear in train.gears))


@lru_cache(maxsize=64)
def gear_names(train: GearTrain) -> GearNames:
    """Return what indicators of a gearbox are called after."""
    planet = _planet(train)
    if planet is None:
        return tuple(MeshNames(mesh.name, (mesh.driver, mesh.driven)) for mesh in train.meshes)
    of_sun = next(mesh for mesh in train.meshes if mesh.driven == planet.name)
    of_ring = next(mesh for mesh in train.meshes if mesh.driver == planet.name)
    return (MeshNames(of_sun.name, (of_sun.driver, planet.name, of_ring.driven), planetary=True),)


def first_teeth(train: GearTrain) -> tuple[Any, Any]:
    """Return the teeth of the first and the last gear of the first mesh, as labels have them."""
    first, *_, last = gear_names(train)[0].gears
    return train.gear(first).teeth, train.gear(last).teeth


@lru_cache(maxsize=1024)
def meshes_of(train: GearTrain) -> tuple[GearMesh, ...]:
    """Return all meshes of a gearbox whose teeth are known, the first one first."""
    teeth = {gear.name: int(gear.teeth or 0) for gear in train.gears}
    names, planet = gear_names(train), _planet(train)
    if planet is not None:
        sun, of_planet, ring = (teeth[gear] for gear in names[0].gears)
        return (GearMesh(names[0], (sun, ring), planets=Planets((sun, of_planet, ring), planet.places)),)
    shaft = {gear.name: gear.shaft for gear in train.gears}
    turns, found = {shaft[names[0].gears[0]]: Fraction(1)}, []
    for name in names:
        driver, driven = name.gears
        pair = teeth[driver], teeth[driven]
        own = turns[shaft[driver]]
        turns[shaft[driven]] = own * Fraction(*pair)
        before, behind = (
            next((teeth[other] for other in teeth if shaft[other] == shaft[gear] and other != gear), 0)
            for gear in name.gears
        )
        found.append(GearMesh(name, pair, own, before, behind))
    return tuple(found)


def _planet(train: GearTrain) -> TrainGear | None:
    """Return the planets of a planetary set, which stand on pins."""
    return next((gear for gear in train.gears if gear.places), None)
