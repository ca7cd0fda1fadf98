"""A gearbox as it may be drawn: its parts by the functions that draw them, at any uniforms; what checks look at."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from siggen.config import Config, Dynamics, PlateHousing, Shafts
from siggen.config.changes import SECTIONS, changed_sections
from siggen.config.config import rated_nm
from siggen.config.consistency import consistency_problems
from siggen.config.dynamics import RATED
from siggen.config.machine import turned
from siggen.damage.ball_geometry import BallGeometry
from siggen.damage.fault import Fault
from siggen.drivetrain.bearings import BallBearing
from siggen.drivetrain.gear_stage import Rotor, Shaft
from siggen.errors import Problem
from siggen.gearbox.configured import pair_configs, possible_damages
from siggen.gearbox.housing import PlateNumbers, plate_numbers
from siggen.gearbox.mesh_damage import on_mesh
from siggen.gearbox.teeth import gear_pair, stiffness_options, tooth_law
from siggen.gearbox.train import rotor_numbers, shaft_numbers
from siggen.gears.gear_pair import GearPair, GeometryProblem, geometry_problems
from siggen.gears.planetary import InternalPair, internal_problems, ring_round
from siggen.keys.drawing import Uniforms, corners, draw
from siggen.keys.number import HIGH, MIDDLE, at, bounds
from siggen.mesh.stiffness_notes import stiffness_notes
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_law import ToothLaw
from siggen.names import SHAFT_OF, MeshName, Side
from siggen.rig.sizes import possible_sizes, sized

HARMLESS = {"operating_points": (), "sensors": (), "duration_s": 86_400.0}
"""In place of sections that are refused for themselves, where their defaults would not do."""


@dataclass(frozen=True, slots=True)
class PossibleMesh:
    """A mesh of any gearbox of a set, at the corners of all numbers.

    Attributes
    ----------
    name : MeshName
    at : what stands before its keys in the file, such as `stages.0.`
    pairs : those that can mesh
    problems : why others cannot
    damages : path and section of what states do to it, for each gear that may be damaged, at most of its teeth
    """

    name: MeshName
    at: str
    pairs: tuple[GearPair, ...]
    problems: tuple[GeometryProblem, ...]
    damages: tuple[tuple[str, Fault], ...]

    @property
    def internal(self) -> bool:
        """Whether it is that of planets in their ring."""
        return self.at == "planetary."

    @property
    def flanks(self) -> tuple[GearPair, ...]:
        """The pairs that differ in more than their bores."""
        return tuple({_without_bores(pair): pair for pair in self.pairs}.values())

    def stiffness_notes(self, bending: StiffnessOptions) -> tuple[str, ...]:
        """Return what to know about the stiffness model of the mesh, each sentence once."""
        gears = [gear.word for gear in self.name.gears]
        return tuple(dict.fromkeys(note for pair in self.pairs for note in stiffness_notes(pair, bending, gears)))


def _without_bores(pair: GearPair) -> GearPair:
    """Return the pair with bores that say nothing, so that pairs of equal teeth are equal."""
    return replace(pair, pinion=replace(pair.pinion, bore_radius_m=0.0), gear=replace(pair.gear, bore_radius_m=0.0))


def _in_ring(pair: GearPair, teeth: int) -> InternalPair | GeometryProblem:
    try:
        return ring_round(pair, teeth)
    except ValueError:
        where = "no ring meshes with planets at this distance"
        return GeometryProblem("", where, "", "allowed: a ring nearer to z_sun + 2 z_planet")


@dataclass(frozen=True)
class PossibleGearbox:
    """Any gearbox of a set: `config` has a default in place of sections that are `refused`, which a file gets wrong."""

    config: Config
    refused: frozenset[str] = frozenset()

    @classmethod
    def of_sections(cls, sections: Mapping[str, Any]) -> PossibleGearbox:
        """Return what valid sections allow; states and sensors by name."""
        defaults = {key: field.get_default() for key, field in Config.model_fields.items() if not field.is_required()}
        listed = {key: tuple(sections.get(key, {}).values()) for key in ("states", "sensors")}
        config = Config.model_construct(**{**defaults, **HARMLESS, **sections, **listed})
        return cls(config, frozenset(Config.model_fields.keys() - sections.keys()))

    @cached_property
    def pairs(self) -> tuple[PossibleGearbox, ...]:
        """Those with each pair of the set; itself where it has one pair."""
        return tuple(PossibleGearbox(own, self.refused) for own in pair_configs(self.config))

    @cached_property
    def dynamics(self) -> Dynamics:
        """The section, with ranges of the sizes that each gearbox draws as a whole."""
        return possible_sizes(self.config.dynamics, self.config.gears)

    def changed(self, state: int) -> PossibleGearbox:
        """Return those that a state has changed."""
        sections = {name: getattr(self.config, name) for name in ("machine", *SECTIONS)} | {"dynamics": self.dynamics}
        changes = changed_sections(sections, [change for _, change in self.config.changes_of(state)])
        return PossibleGearbox(self.config.model_copy(update=changes), self.refused)

    def contradictions(self) -> list[Problem]:
        """Return what is wrong between sections by their form."""
        named = {key: {one.name: one for one in getattr(self.config, key)} for key in ("states", "sensors")}
        return consistency_problems({**dict(self.config), **named}, {})

    @cached_property
    def meshes(self) -> tuple[PossibleMesh, ...]:
        """Meshes in the order of power; of a planetary set those of sun and planet, and of planet and ring."""
        return tuple(self._meshes())

    def _meshes(self) -> Iterator[PossibleMesh]:
        names, planetary = self.config.names.meshes, self.config.planetary
        stages = self.config.stages if planetary is None else ()
        for number, section in enumerate((self.config.gears, *(stage.gears for stage in stages))):
            possible = corners(lambda uniform, own=section: gear_pair(draw(own, uniform, "gears")))  # type: ignore[misc]
            mesh = self._mesh(names[number], f"stages.{number - 1}." if number else "", possible)
            yield mesh
        if planetary is not None:
            yield self._mesh(names[1], "planetary.", [_in_ring(pair, planetary.ring_teeth) for pair in mesh.flanks])

    def _mesh(self, name: MeshName, at: str, possible: Iterable[GearPair | GeometryProblem]) -> PossibleMesh:
        pairs, problems = list[GearPair](), list[GeometryProblem]()
        for one in possible:
            if isinstance(one, GeometryProblem):
                problems.append(one)
            elif own := internal_problems(one) if isinstance(one, InternalPair) else geometry_problems(one):
                problems += own
            else:
                pairs.append(one)
        return PossibleMesh(name, at, tuple(pairs), tuple(problems), self._damages(name.inner))

    def _damages(self, mesh: str) -> tuple[tuple[str, Fault], ...]:
        return tuple(
            (path, possible)
            for state in self.config.states
            for path, one in state.placed(f"states.{state.name}")
            if (own := on_mesh(one, mesh, self.config.names)) is not None
            for possible in possible_damages(own)
        )

    @property
    def largest_torque_nm(self) -> float:
        """Of all operating points, whatever its sign; 0 without any."""
        points = self.config.operating_points
        return float(max((abs(end) for point in points for end in bounds(point.torque_nm)), default=0.0))

    @property
    def rated_nm(self) -> float:
        """Torque of the motor's slip."""
        return rated_nm(self.config.dynamics, self.config.operating_points)

    @property
    def bending(self) -> StiffnessOptions:
        """How teeth bend."""
        return stiffness_options(self.config.stiffness)

    @property
    def stiffness_notes(self) -> tuple[str, ...]:
        """What to know about the stiffness model of the first mesh, each sentence once."""
        return self.meshes[0].stiffness_notes(self.bending)

    def law(self, uniform: Uniforms) -> ToothLaw:
        """Return how teeth push and rub."""
        return tooth_law(draw(self.dynamics, uniform, "dynamics"))

    def ball(self, side: Side, uniform: Uniforms) -> BallBearing | None:
        """Return each bearing of a shaft whose stiffness follows the load; None where it does not."""
        config = self.config
        gears = draw(config.gears, lambda _: MIDDLE, "gears")
        dynamics = sized(config.dynamics, gears, uniform)
        section: BallGeometry | None = getattr(dynamics, side).bearing.geometry
        return None if section is None else draw(section, uniform, f"dynamics.{side}.bearing.geometry").bearing()

    def rotor(self, side: Side, pair: GearPair, uniform: Uniforms) -> Rotor:
        """Return a gear of the first mesh on its bearings."""
        section = draw(getattr(self.dynamics, side), uniform, f"dynamics.{side}")
        return rotor_numbers(section, pair.member(side), pair.face_width_m)

    def shaft(self, side: Side, pair: GearPair) -> Callable[[Uniforms], Shaft]:
        """Return what draws a shaft that bends, with a typical gear."""
        rotor, shafts = self.rotor(side, pair, lambda _: MIDDLE), self.dynamics.shafts
        assert shafts is not None
        section, at = shafts.of(side), f"dynamics.shafts.{SHAFT_OF[side]}"
        return lambda uniform: shaft_numbers(draw(section, uniform, at), rotor, pair)

    def plates(self, uniform: Uniforms) -> PlateNumbers | None:
        """Return the numbers of a box of plates; None where something else carries the bearings."""
        housing = self.config.housing
        if self.config.dynamics.model == "casing" and isinstance(housing, PlateHousing):
            return plate_numbers(housing, uniform)
        return None

    def shafts(self, uniform: Uniforms) -> Shafts | None:
        """Return the drawn section of shafts that bend."""
        section = self.dynamics.shafts
        return None if section is None else draw(section, uniform, "dynamics.shafts")

    def driven_inertia_kg_m2(self, pair: GearPair) -> float:
        """Return the largest inertia behind a first mesh, as its driver feels it."""
        config, load = self.config, at(self.config.dynamics.load_inertia_kg_m2, HIGH)
        if config.planetary is not None:
            return load / (1.0 + config.planetary.ring_teeth / pair.pinion.teeth) ** 2
        gears = [self.rotor(Side.DRIVEN, pair, lambda _: HIGH)]
        for stage, mesh in zip(config.stages, self.meshes[1:], strict=True):
            section = draw(stage.gear, lambda _: HIGH, "")
            gears += [rotor_numbers(section, one.gear, one.face_width_m) for one in mesh.pairs[:1]]
        inertias = [one.inertia_kg_m2 for one in gears]
        turns = map(float, turned(config.gears, config.stages))
        inertias[-1] += load
        return sum(turn**2 * inertia for turn, inertia in zip(turns, inertias, strict=False))

    def number(self, path: str) -> Any:
        """Return the number of a key of sections, entries of a list by their place or name."""
        return self._number(path, self.dynamics)

    def given(self, path: str) -> str:
        """Return the key that a number stands at: its own, or the rated torque where it follows from that."""
        rated = path.startswith("dynamics.") and self._number(path, self.config.dynamics) is None
        return f"dynamics.{RATED}" if rated and self.number(path) is not None else path

    def _number(self, path: str, dynamics: Dynamics) -> Any:
        first, *keys = path.split(".")
        value: Any = dynamics if first == "dynamics" else getattr(self.config, first)
        for key in keys:
            if not isinstance(value, tuple):
                value = getattr(value, key)
            else:
                value = value[int(key)] if key.isdecimal() else next(one for one in value if one.name == key)
        return value

    def written(self, path: str) -> str:
        """Return a number as people write it: what was carried over has many digits."""
        number = self.number(path)
        return str(round(number, 3)) if isinstance(number, float) else str(number)
