"""TrainOrders: shafts and meshes of the machine that is calibrated, by their orders, named as its user names them.

Orders are turns, or teeth that mesh, per turn of the first shaft. Shafts and meshes stand in the order of power.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from diagnostics.records.gear_train import meshes_of
from siggen.columns.drivetrain import GearTrain


@dataclass(frozen=True, slots=True)
class RigShaft:
    """One shaft: name, turns per turn of the first one, teeth of its gears."""

    name: str
    turns: Fraction
    teeth: tuple[int, ...]

    @property
    def step(self) -> float:
        """Its turns as a number."""
        return float(self.turns)

    @property
    def words(self) -> str:
        """What a sentence calls it."""
        return f"the {self.name} shaft"


@dataclass(frozen=True, slots=True)
class MeshOrder:
    """One mesh: name, empty for that of a pair, order, and the shafts of its driver and driven gear."""

    name: str
    order: float
    shafts: tuple[RigShaft, RigShaft]

    def called(self, what: str) -> str:
        """Return the name of its line or of a group of its lines."""
        return f"mesh {self.name} {what}" if self.name else f"mesh {what}"

    @property
    def words(self) -> str:
        """What a sentence calls it, with its teeth."""
        driver, driven = self.shafts
        name = f" {self.name}" if self.name else ""
        return f"mesh{name} ({driver.teeth[-1]}/{driven.teeth[0]} teeth)"


@dataclass(frozen=True, slots=True)
class TrainOrders:
    """All shafts and meshes of a machine."""

    shafts: tuple[RigShaft, ...]
    meshes: tuple[MeshOrder, ...]

    @property
    def teeth(self) -> tuple[int, int]:
        """Of the first mesh."""
        return self.shafts[0].teeth[-1], self.shafts[1].teeth[0]


def drivetrain(train: GearTrain) -> TrainOrders:
    """Return the shafts and meshes of a gearbox whose teeth are known; it is no planetary set."""
    meshes = meshes_of(train)
    turns = [Fraction(1)]
    teeth: list[tuple[int, ...]] = [meshes[0].teeth[:1]]
    for number, mesh in enumerate(meshes):
        turns.append(turns[-1] * Fraction(*mesh.teeth))
        teeth.append((mesh.teeth[1], *(one.teeth[0] for one in meshes[number + 1 : number + 2])))
    named = (shaft.name for shaft in train.shafts)
    found = tuple(RigShaft(*one) for one in zip(named, turns, teeth, strict=True))
    return TrainOrders(
        found,
        tuple(
            MeshOrder(mesh.names.name, float(shaft.turns * mesh.teeth[0]), (shaft, behind))
            for mesh, (shaft, behind) in zip(meshes, pairwise(found), strict=True)
        ),
    )
