"""Specimen: a gearbox of a set, drawn; every number is a value in SI, and nothing behind it asks the configuration."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import lcm

from siggen.config.internals import ALL
from siggen.damage.fault import Fault
from siggen.drivetrain.bearings import BallBearing
from siggen.drivetrain.gear_stage import GearStage, NextStage, PlanetaryStage, Shaft
from siggen.gearbox.background import DrawnBackground
from siggen.gearbox.channels import DrawnChannel
from siggen.gearbox.drive import PointVariation, UnbalanceLevels
from siggen.gearbox.housing import Block, Housing, Plates
from siggen.gearbox.labels import Labels
from siggen.gearbox.life import Lived
from siggen.gearbox.teeth import Teeth
from siggen.gears.gear_pair import GearPair
from siggen.gears.planetary import InternalPair, PlanetarySet
from siggen.mesh.tooth_law import MIXED_EHL, ToothLaw
from siggen.motion.response import Sampling
from siggen.names import Names, Side


@dataclass(frozen=True, slots=True)
class OperatingPoint:
    """Speed and torque of the first shaft, and how they vary within a record; None: not at all."""

    speed_hz: float
    torque_nm: float
    variation: PointVariation | None = None

    def turned(self, turning: float) -> OperatingPoint:
        """Return the point as a shaft has it that turns `turning` times per turn of the first one."""
        return OperatingPoint(self.speed_hz * turning, self.torque_nm / turning)


@dataclass(frozen=True, slots=True)
class DrawnState:
    """What a state is called; damage itself belongs to meshes.

    Attributes
    ----------
    sham : whether its damage is drawn with nothing removed
    labels : what else its records say of it
    changed : draws the gearbox in it; None where it has the numbers of the healthy one
    """

    name: str
    fault: str
    severity: str
    sham: bool
    labels: Labels
    changed: Callable[[], Specimen] | None = field(compare=False)


@dataclass(frozen=True, slots=True)
class ToothMesh:
    """One mesh of a gearbox.

    Attributes
    ----------
    inner : its name in sections; empty for the first one
    teeth : of its gears
    idler : whether its driver is the driven gear of the mesh in front
    direction_rad : from the driver's axis to that of its mate, against the first mesh
    """

    inner: str
    teeth: Teeth
    idler: bool = False
    direction_rad: float = 0.0

    @property
    def pair(self) -> GearPair:
        """Its gears."""
        return self.teeth.pair


@dataclass(frozen=True, slots=True)
class PairTrain:
    """Shafts of a train of pairs: rotors and couplings, those behind, what bends, bearings that follow the load."""

    first: GearStage
    behind: tuple[NextStage, ...] = ()
    bending: tuple[Shaft, Shaft] | None = None
    balls: tuple[tuple[Side, BallBearing], ...] = ()


@dataclass(frozen=True, slots=True)
class PlanetaryGears:
    """A planetary set: its teeth in numbers, sun and planet, planet and ring, and its bodies.

    `pin_errors_m`: how far each planet's pin is ahead of its place along the tangent; `meshes` are the teeth of the sun
    with each planet, then of each planet with the ring.
    """

    teeth: PlanetarySet
    pair: GearPair
    ring: InternalPair
    stage: PlanetaryStage
    pin_errors_m: tuple[float, ...]
    meshes: tuple[Teeth, ...]

    @property
    def hunting_turns(self) -> float:
        """Turns of the sun after which all teeth stand again as they did, and the carrier too."""
        return self.teeth.common_turns * (1.0 + self.teeth.ring / self.teeth.sun)

    def of_one_mesh(self, point: OperatingPoint) -> OperatingPoint:
        """Return a point as the sun has it against the carrier in one of its meshes."""
        speed_hz = point.speed_hz * (1.0 - float(self.teeth.carrier_turns))
        return OperatingPoint(speed_hz, point.torque_nm / len(self.teeth.places))


@dataclass(frozen=True, slots=True)
class Specimen:
    """A gearbox.

    Attributes
    ----------
    states : in the order of the file
    meshes : in the order of power; of a planetary set those of sun and planet, and of planet and ring
    law : how all teeth push and rub
    train, planets : its shafts; one of both
    housing : what carries its bearings; None for the ground
    unbalance : of its shafts; None: balanced
    background : what its machine does beside its meshing teeth
    channels : of its sensors
    renewed : number of a renewal -> the same with other gains, mounts and curves, where they were
    points : at which it is measured
    rated_nm : torque at which its motor slips as the file says
    damages : laws of the damage of all states of its set
    labels : what its set says of it as a whole
    life : how its teeth pitted, of a set that runs to failure
    stored : what no sensor sees and a record holds: names, or all; None: nothing
    bearing_point : the operating point under whose load its bearings stand; None where they have one stiffness
    oil_c : operating point -> temperature of its oil [°C]; None where that is given
    """

    specimen_id: int
    seed: int
    names: Names
    sampling: Sampling
    states: tuple[DrawnState, ...]
    meshes: tuple[ToothMesh, ...]
    law: ToothLaw
    train: PairTrain | None
    planets: PlanetaryGears | None
    housing: Housing | None
    unbalance: UnbalanceLevels | None
    background: DrawnBackground | None
    channels: tuple[DrawnChannel, ...]
    renewed: Callable[[int], tuple[DrawnChannel, ...]] = field(compare=False)
    points: tuple[OperatingPoint, ...]
    rated_nm: float
    damages: tuple[Fault, ...]
    labels: Labels
    life: Lived | None
    stored: tuple[str, ...] | None = None
    bearing_point: OperatingPoint | None = None
    oil_c: Callable[[OperatingPoint], float] | None = field(default=None, compare=False)

    @property
    def housed(self) -> bool:
        """Whether a housing carries its bearings, not the ground."""
        return self.housing is not None

    @property
    def boxed(self) -> bool:
        """Whether its housing is a box of plates of its own."""
        return isinstance(self.housing, Plates)

    @property
    def passes_forces(self) -> bool:
        """Whether sensors hear forces of bearings through its housing, beside its motion with the gears."""
        return self.housed and (self.planets is not None or not isinstance(self.housing, Block))

    @property
    def oiled(self) -> bool:
        """Whether its oil acts on records: by the friction of its teeth, or by the noise of their rubbing."""
        return self.law.friction.model == MIXED_EHL or self.background is not None

    @property
    def pair(self) -> GearPair:
        """The gears of the first mesh."""
        return self.meshes[0].pair

    @property
    def behind(self) -> tuple[ToothMesh, ...]:
        """The further meshes of a train."""
        return () if self.train is None else self.meshes[1:]

    @property
    def shaft_turns(self) -> tuple[Fraction, ...]:
        """Turns of every shaft of a train per turn of the first one, exactly."""
        turns = [Fraction(1)]
        for mesh in self.meshes:
            turns.append(turns[-1] * Fraction(mesh.pair.pinion.teeth, mesh.pair.gear.teeth))
        return tuple(turns)

    @property
    def hunting_turns(self) -> float:
        """Turns of the first shaft after which all teeth stand again as they did."""
        if self.planets is not None:
            return self.planets.hunting_turns
        return lcm(*(turns.denominator for turns in self.shaft_turns))

    @property
    def all_teeth(self) -> tuple[Teeth, ...]:
        """Teeth of all meshes, in the order of power; of a planetary set as `PlanetaryGears.meshes`."""
        return tuple(mesh.teeth for mesh in self.meshes) if self.planets is None else self.planets.meshes

    def reads(self, kind: str) -> bool:
        """Return whether a sensor reads a kind of `Input`, such as bearing forces."""
        return any(kind in channel.reads for channel in self.channels)

    def stores(self, quantity: str) -> bool:
        """Return whether a record holds a quantity that no sensor sees."""
        return self.stored is not None and (ALL in self.stored or quantity in self.stored)

    def in_state(self, state_id: int) -> Specimen:
        """Return the gearbox with the numbers that it has in a state; itself where the state changes none."""
        changed = self.states[state_id].changed
        return self if changed is None else changed()

    def under(self, point: OperatingPoint) -> Specimen:
        """Return the gearbox at an operating point: its bearings under load, its oil warmed; itself where none does."""
        loaded = self if self.bearing_point in (None, point) else replace(self, bearing_point=point)
        if self.oil_c is None or not self.oiled:
            return loaded
        warmed = self.law.with_oil_at(self.oil_c(point))
        return loaded if warmed == self.law else replace(loaded, law=warmed)
