"""What turns in the gearboxes of a set, in the user's names: what readers of a set need to count orders."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from siggen.gearbox.specimen import Specimen

Ratio: TypeAlias = tuple[int, int]
"""Numerator and denominator of a number of turns; exact, since it follows from teeth."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainShaft:
    """A shaft, and its turns per turn of the input; None where gearboxes of one set differ in teeth."""

    name: str
    turns: Ratio | None


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainGear:
    """A gear.

    Attributes
    ----------
    name : by its user; an idler is two, MESH.NAME by the mesh of each flank
    shaft : that it turns with; empty for a ring that is held
    teeth : None where gearboxes of one set differ: the column with the quantity `teeth` of this gear has them
    places : where equal gears stand on pins of the shaft, in turns of it; empty for a gear that is fixed to it
    """

    name: str
    shaft: str
    teeth: int | None
    places: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainMesh:
    """A mesh: its gears, and its frequency in orders of the input, as `TrainShaft.turns`."""

    name: str
    driver: str
    driven: str
    order: Ratio | None


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainBearings:
    """The bearings of a shaft, by the place that sensors call them."""

    name: str
    shaft: str


@dataclass(frozen=True, slots=True, kw_only=True)
class GearTrain:
    """Shafts, gears, meshes and bearings in the order of power; the mesh of a plain pair has an empty name."""

    shafts: tuple[TrainShaft, ...]
    gears: tuple[TrainGear, ...]
    meshes: tuple[TrainMesh, ...]
    bearings: tuple[TrainBearings, ...] = ()

    def gear(self, name: str) -> TrainGear:
        """Return a gear by its name."""
        return next(gear for gear in self.gears if gear.name == name)


def gear_train(gearbox: Specimen) -> GearTrain:
    """Return what turns in the gearboxes of a set, of which one is given."""
    names, planets = gearbox.names, gearbox.planets
    drawn = any(column.name == "pair" for column in gearbox.labels)
    pairs = [(mesh.pair.pinion.teeth, mesh.pair.gear.teeth) for mesh in gearbox.meshes]
    places: tuple[float, ...] = ()
    turns = list(gearbox.shaft_turns)
    if planets is None:
        orders = [teeth[0] * turned for teeth, turned in zip(pairs, turns, strict=False)]
    else:
        places, turns[1:] = tuple(map(float, planets.teeth.places)), [planets.teeth.carrier_turns]
        orders = [planets.teeth.sun * (1 - turns[1])] * 2
    gears: dict[str, TrainGear] = {}
    for number, (mesh, teeth) in enumerate(zip(names.meshes, pairs, strict=True)):
        for gear, count, shaft in zip(mesh.gears, teeth, range(number, number + 2), strict=True):
            held = shaft >= len(names.shafts)
            gears.setdefault(
                gear.word,
                TrainGear(
                    name=gear.word,
                    shaft="" if held else names.shafts[shaft].word,
                    teeth=None if drawn and not held else count,
                    places=places if shaft == 1 else (),
                ),
            )
    return GearTrain(
        shafts=tuple(
            TrainShaft(name=shaft.word, turns=_known(turned, drawn=drawn))
            for shaft, turned in zip(names.shafts, turns, strict=True)
        ),
        gears=tuple(gears.values()),
        meshes=tuple(
            TrainMesh(
                name=mesh.word, driver=mesh.driver.word, driven=mesh.driven.word, order=_known(order, drawn=drawn)
            )
            for mesh, order in zip(names.meshes, orders, strict=True)
        ),
        bearings=tuple(TrainBearings(name=shaft.bearing, shaft=shaft.word) for shaft in names.shafts),
    )


def _known(ratio: Fraction, *, drawn: bool) -> Ratio | None:
    return None if drawn else ratio.as_integer_ratio()
