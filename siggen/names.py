"""Names: what gears, shafts and meshes of a gearbox are called, in the order of power.

Files that have a `machine` name them; a pair has pinion and gear, a planetary set sun, planet, ring and carrier.
Sections of a configuration count each mesh as a pair: its driver is the pinion, SLOW.pinion behind the first mesh. What
leaves the program, such as columns, places and messages, is composed of these names; no text is rewritten.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import TypeAlias, TypeVar

from siggen.errors import Problem

Table: TypeAlias = tuple[tuple[str, str], ...]
"""Keys of sections, each with the one that the user wrote."""
Value = TypeVar("Value")
EITHER, SEVERAL = "either", "several"


class Side(StrEnum):
    """The two gears of a mesh: the one that drives, and the one that is driven; sections call them pinion and gear."""

    DRIVER = "pinion"
    DRIVEN = "gear"

    @property
    def number(self) -> int:
        """0 of the driver, 1 of the driven gear."""
        return int(self is Side.DRIVEN)

    @property
    def mate(self) -> Side:
        """The gear that it meets."""
        return Side.DRIVER if self is Side.DRIVEN else Side.DRIVEN


MACHINES = {"motor": 0, "load": -1}
"""What stands beside a gearbox, and the place of the shaft that leads there, in the order of power."""
PINION, GEAR = SECTIONS = (Side.DRIVER.value, Side.DRIVEN.value)
"""What sections of the configuration call the gears of a mesh, and the shafts of a pair."""
SHAFT_OF = {PINION: "driver", GEAR: "driven"}
"""Gear of the first mesh -> key of its shaft in `dynamics.shafts`."""


@dataclass(frozen=True, slots=True)
class GearName:
    """What a gear is called.

    Attributes
    ----------
    inner : in sections of the configuration: pinion, gear, slow.gear
    word : by its user, in damage and labels; an idler has two, MESH.NAME by the mesh of each flank
    body : in the graph; both flanks of an idler are one body
    called : in sentences: the pinion, ida
    """

    inner: str
    word: str
    body: str
    called: str

    @property
    def column(self) -> str:
        """What parts of the names of columns call it."""
        return "_".join(self.word.split("."))

    @property
    def inner_column(self) -> str:
        """The same before names are given."""
        return "_".join(self.inner.split("."))


@dataclass(frozen=True, slots=True)
class ShaftName:
    """What a shaft is called: in sections, by its user, in sentences, and what its bearings are."""

    inner: str
    word: str
    called: str

    @property
    def bearing(self) -> str:
        """The place of its bearings."""
        return f"{self.word}_bearing"


@dataclass(frozen=True, slots=True)
class MeshName:
    """What a mesh is called, in sections and by its user, and its gears; the mesh of a pair has no name."""

    inner: str
    word: str
    driver: GearName
    driven: GearName

    @property
    def gears(self) -> tuple[GearName, GearName]:
        """Driver and driven gear."""
        return self.driver, self.driven

    def gear(self, side: Side) -> GearName:
        """Return one of its gears."""
        return self.gears[side.number]

    @property
    def frequency(self) -> str:
        """The column of its frequency."""
        return f"mesh_{self.word}_hz" if self.word else "mesh_hz"


@dataclass(frozen=True, slots=True)
class Names:
    """The names of one gearbox.

    Attributes
    ----------
    meshes, shafts : in the order of power; of a planetary set those of sun and planet, and of planet and ring
    paths : keys of sections, such as stages.0.gears.pinion, and where the user wrote them
    given : whether a file gave them
    """

    meshes: tuple[MeshName, ...]
    shafts: tuple[ShaftName, ...]
    paths: Table = ()
    given: bool = False

    @property
    def gears(self) -> tuple[GearName, ...]:
        """All gears, those of each mesh one after the other; of a planetary set the planet once."""
        return tuple(dict.fromkeys(gear for mesh in self.meshes for gear in mesh.gears))

    @property
    def first(self) -> MeshName:
        """The first mesh."""
        return self.meshes[0]

    def gear(self, inner: str) -> str:
        """Return what damage and labels call a gear; words such as none stay."""
        return next((gear.word for gear in self.gears if gear.inner == inner), inner)

    def called(self, word: str) -> str:
        """Return what sentences call a gear by its word; of either gear of a mesh, the one with fewer teeth."""
        return next((gear.called for gear in self.gears if gear.word == word), "the smaller gear")

    @property
    def flanks(self) -> dict[str, tuple[str, str]]:
        """What `gear` of damage may hold: gears, and for each mesh the drawn one of both -> mesh by sections, side."""
        found: dict[str, tuple[str, str]] = {}
        for mesh in self.meshes:
            for side, gear in zip(Side, mesh.gears, strict=True):
                found.setdefault(gear.word, (mesh.inner, side))
        either = {_in(mesh.word, EITHER): (mesh.inner, EITHER) for mesh in self.meshes}
        return found if self == PLANETARY else {**found, **either}

    def mesh(self, inner: str) -> MeshName:
        """Return a mesh."""
        return next(mesh for mesh in self.meshes if mesh.inner == inner)

    @property
    def bearings(self) -> dict[str, str]:
        """Places of the bearings of all shafts, by sections."""
        return {f"{shaft.inner}_bearing": shaft.bearing for shaft in self.shafts}

    def quantity(self, mesh: MeshName, name: str) -> str:
        """Return the name of a quantity of a mesh that no sensor sees; that of the only mesh stands alone."""
        return f"{mesh.word}_{name}" if mesh.word and len(self.meshes) > 1 else name

    def of_turning(self, of_shafts: Sequence[Value]) -> dict[str, Value]:
        """Return what is known of every shaft in the order of power by all that turns: motor, gears, load."""
        found = {"motor": of_shafts[0]}
        # of a planetary set the ring's mesh has no shaft behind it
        for mesh, driving, driven in zip(self.meshes, of_shafts, of_shafts[1:], strict=False):
            found |= {mesh.driver.body: driving, mesh.driven.body: driven}
        return {**found, "load": of_shafts[-1]}

    def own_path(self, path: str) -> str:
        """Return a key of sections as the user wrote it."""
        for inner, own in sorted(self.paths, key=lambda table: -len(table[0])):
            if path.startswith(f"{inner}.") or (path == inner and not inner.endswith("gears")):
                return f"{own}{path.removeprefix(inner)}"
        return path

    def problem(self, problem: Problem) -> Problem:
        """Return a problem at the key that the user wrote."""
        return replace(problem, path=self.own_path(problem.path))


PAIR = Names(
    (
        MeshName(
            "",
            "",
            GearName(PINION, PINION, PINION, "the pinion"),
            GearName(GEAR, GEAR, GEAR, "the gear"),
        ),
    ),
    (
        ShaftName(PINION, PINION, "the pinion's shaft"),
        ShaftName(GEAR, GEAR, "the gear's shaft"),
    ),
)
"""Of two gears without names of their own."""
PLANET = GearName(GEAR, "planet", "planet_1", "the planet")
PLANETARY = Names(
    (
        MeshName("", "", GearName(PINION, "sun", "sun", "the sun"), PLANET),
        MeshName("ring", "ring", PLANET, GearName("ring.gear", "ring", "ring", "the ring")),
    ),
    (ShaftName(PINION, "sun", "the sun's shaft"), ShaftName(GEAR, "carrier", "the carrier's shaft")),
)
"""Of a planetary set, whose first mesh is that of the sun with its first planet."""


def _in(mesh: str, gear: str) -> str:
    return f"{mesh}.{gear}" if mesh else gear
