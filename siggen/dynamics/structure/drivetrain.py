"""Structures of several meshes in a row: shafts with one or two gears on bearings on the ground or in a body.

Equations: standard literature (a round beam on two supports; gears as rigid discs); direction of the lines of action
derived. With x along the first centre line from pinion to gear and y along the pitch-line velocity of the first pinion,
which turns from x to y, a driven gear in the direction χ is pushed along (-sin(χ - α), cos(χ - α)) by a gear that turns
that way and along (sin(χ + α), -cos(χ + α)) by one that turns back. Rotations count in the running sense of their
shaft. An idler is one body in two meshes, driven in one and driver in the next.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import cos, pi, prod, sin, sqrt, tan
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.body import Body
from siggen.dynamics.structure.casing_structure import seated_springs
from siggen.dynamics.structure.gear_stage import Bearing, GearStage, Rotor
from siggen.dynamics.structure.mesh_vectors import MeshVectors
from siggen.dynamics.structure.structure import Element, Structure, assemble, shafts, vector

PLACES = (1.0 / 3.0, 2.0 / 3.0)
"""Of both gears between the bearings of their shaft (assumed)."""
TORSIONAL_DAMPING = 0.005
"""Of a steel shaft between two gears, as a share of the critical one (assumed)."""
AXES = {"vertical": "y", "horizontal": "x"}


@dataclass(frozen=True, slots=True)
class CommonShaft:
    """A round shaft on two bearings that carries a driven gear and the pinion of the next mesh."""

    span_m: float
    diameter_m: float
    youngs_modulus_pa: float
    poisson_ratio: float

    @property
    def torsional_stiffness_nm_per_rad(self) -> float:
        """Stiffness of the piece between both gears: G J over its length."""
        shear = 0.5 * self.youngs_modulus_pa / (1.0 + self.poisson_ratio)
        return shear * pi * self.diameter_m**4 / 32.0 / (self.span_m * (PLACES[1] - PLACES[0]))

    @property
    def bending_m_per_n(self) -> FloatArray:
        """Deflection (2, 2) of the places of both gears by forces there, on stiff bearings."""
        a, b = (self.span_m * place for place in PLACES)
        length, rigidity = self.span_m, self.youngs_modulus_pa * pi * self.diameter_m**4 / 64.0

        def deflection(at: float, force_at: float) -> float:
            low, beyond = min(at, force_at), length - max(at, force_at)
            return low * beyond * (length**2 - low**2 - beyond**2) / (6.0 * rigidity * length)

        return np.array([[deflection(a, a), deflection(a, b)], [deflection(b, a), deflection(b, b)]])


@dataclass(frozen=True, slots=True)
class NextStage:
    """A mesh behind another one: its gears, the shaft that its pinion shares, the direction to its gear [rad].

    Without a shaft its pinion is the gear in front itself, an idler.
    """

    name: str
    working_pressure_angle_rad: float
    pinion: Rotor
    gear: Rotor
    shaft: CommonShaft | None
    direction_rad: float


def drivetrain(first: GearStage, behind: Sequence[NextStage], body: Body | None = None) -> Structure:
    """Return motor, shafts with their gears, load, and what carries the bearings: the ground, or a body.

    q = [θ_m, x_1, y_1, θ_1, x_2, ..., θ_L, coordinates of the body], gears numbered in the order of power. The bearings
    of the shaft that mesh k drives are called by it, of the first mesh `pinion_bearing` and `gear_bearing`.
    On the ground horizontal runs from the first pinion to its gear, in a body from gear to pinion, as in single stages.
    """
    rotors = [first.pinion, first.gear, *(rotor for stage in behind for rotor in _new_rotors(stage))]
    inertias = {**_inertias(first, rotors), **({} if body is None else body.inertias)}
    coordinates, carried = tuple(inertias), _carried(first, behind)
    held = {f"{one.place}/{name}": (one.held(name, body),) for one in carried for name in AXES}
    free = [element for one in carried for name in AXES for element in one.bent(name)]
    supports = () if body is None else body.supports
    turned = assemble(coordinates, (*_torsion(first, behind), *free, *supports))
    seats, flexibility = (tuple(held), None) if body is None else (tuple(body.seats), body.flexibility_m_per_n)
    springs = seated_springs(coordinates, held, seats, flexibility)
    stiffness, damping = springs.stiffness + turned[0], springs.damping + turned[1]
    mass = np.diag(list(inertias.values()))
    for matrix in (mass, damping, stiffness):
        matrix.setflags(write=False)
    ratio = first.ratio * prod(stage.gear.base_radius_m / stage.pinion.base_radius_m for stage in behind)
    motions = springs.directions if body is None else _body_motions(coordinates, body)
    return Structure(
        coordinates=coordinates,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        meshes=_meshes(coordinates, first, behind, 1.0 if body is None else -1.0),
        shaft_lines=_lines(behind),
        torque_vector=vector(coordinates, {"theta_m": 1.0, "theta_l": -ratio}),
        motions=motions,
        bearing_forces=springs.forces,
        bearing_directions=springs.directions,
    )


def _body_motions(coordinates: Sequence[str], body: Body) -> dict[str, FloatArray]:
    return {name: vector(coordinates, row) for name, row in body.motions.items()}


class _Carried(NamedTuple):
    """A shaft as it stands: what its bearings are called, the numbers of its gears, both bearings together.

    Both gears of a common shaft stand alike about its middle. So their mean motion is held by the bearings and the
    bending in series, and so is their difference, which does not load the seats as a whole (derived).
    """

    place: str
    gears: tuple[int, ...]
    bearing: Bearing
    shaft: CommonShaft | None

    def held(self, name: str, body: Body | None) -> Element:
        """Return the spring between the mean motion of the gears and the seats along an axis."""
        axis, stiffness, damping = self._bearing(name)
        seat = {} if body is None else {key: -value for key, value in body.seats[f"{self.place}/{name}"].items()}
        moved = {f"{axis}_{gear}": 1.0 / len(self.gears) for gear in self.gears}
        bending = 0.0 if self.shaft is None else 0.5 * float(self.shaft.bending_m_per_n[0].sum())
        return _in_series({**moved, **seat}, stiffness, damping, bending)

    def bent(self, name: str) -> list[Element]:
        """Return the spring between the gears of a common shaft along an axis."""
        if self.shaft is None:
            return []
        axis, stiffness, damping = self._bearing(name)
        (own, other), lever = self.shaft.bending_m_per_n[0].tolist(), 0.25 / (PLACES[1] - PLACES[0]) ** 2
        first, second = (f"{axis}_{gear}" for gear in self.gears)
        return [_in_series({first: 1.0, second: -1.0}, lever * stiffness, lever * damping, 2.0 * (own - other))]

    def _bearing(self, name: str) -> tuple[str, float, float]:
        axis = AXES[name]
        stiffness, damping = (
            getattr(self.bearing, f"{word}_{axis}_{unit}")
            for word, unit in (("stiffness", "n_per_m"), ("damping", "n_s_per_m"))
        )
        return axis, stiffness, damping


def _in_series(direction: dict[str, float], stiffness: float, damping: float, bending_m_per_n: float) -> Element:
    """Return a spring with its damper in series with bending; the damper sees its spring's share of the motion."""
    share = 1.0 / (1.0 + stiffness * bending_m_per_n)
    return Element(direction, stiffness * share, damping * share**2)


def _carried(first: GearStage, behind: Sequence[NextStage]) -> list[_Carried]:
    """Return the shafts in the order of power."""
    names, seats = ["gear", *(stage.name for stage in behind)], [first.gear, *(stage.gear for stage in behind)]
    found = [_Carried("pinion_bearing", (1,), first.pinion.bearing, None)]
    shafts_behind = [*(stage.shaft for stage in behind), None]
    for name, rotor, gears, shaft in zip(names, seats, _gears_of_shafts(behind)[1:], shafts_behind, strict=True):
        found.append(_Carried(f"{name}_bearing", gears, rotor.bearing, shaft))
    return found


def _new_rotors(stage: NextStage) -> tuple[Rotor, ...]:
    return (stage.gear,) if stage.shaft is None else (stage.pinion, stage.gear)


def _ends(behind: Sequence[NextStage]) -> list[tuple[int, int]]:
    """Return the numbers of the driving and the driven gear of every mesh."""
    found = [(1, 2)]
    for stage in behind:
        driving = found[-1][1] + (stage.shaft is not None)
        found.append((driving, driving + 1))
    return found


def _gears_of_shafts(behind: Sequence[NextStage]) -> list[tuple[int, ...]]:
    """Return the numbers of the gears of every shaft: an idler stands alone."""
    ends = _ends(behind)
    between = [tuple(dict.fromkeys((driven, driving))) for (_, driven), (driving, _) in pairwise(ends)]
    return [(1,), *between, (ends[-1][1],)]


def _inertias(first: GearStage, rotors: Sequence[Rotor]) -> dict[str, float]:
    found = {"theta_m": first.motor_inertia_kg_m2}
    for number, rotor in enumerate(rotors, start=1):
        found |= {f"x_{number}": rotor.mass_kg, f"y_{number}": rotor.mass_kg, f"theta_{number}": rotor.inertia_kg_m2}
    return found | {"theta_l": first.load_inertia_kg_m2}


def _torsion(first: GearStage, behind: Sequence[NextStage]) -> list[Element]:
    """Return the couplings at both ends, and the shafts between two gears."""
    driving, driven = shafts(first)
    lines = _gears_of_shafts(behind)
    found = [driving, replace(driven, direction={f"theta_{lines[-1][0]}": 1.0, "theta_l": -1.0})]
    inertia = first.gear.inertia_kg_m2
    for line, stage in zip(lines[1:-1], behind, strict=True):
        if stage.shaft is not None:
            stiffness, other = stage.shaft.torsional_stiffness_nm_per_rad, stage.pinion.inertia_kg_m2
            damping = 2.0 * TORSIONAL_DAMPING * sqrt(stiffness * inertia * other / (inertia + other))
            found.append(Element({f"theta_{line[0]}": 1.0, f"theta_{line[1]}": -1.0}, stiffness, damping))
        inertia = stage.gear.inertia_kg_m2
    return found


def _lines(behind: Sequence[NextStage]) -> tuple[tuple[str, ...], ...]:
    first, *found = [tuple(f"theta_{gear}" for gear in gears) for gears in _gears_of_shafts(behind)]
    return (("theta_m", *first), *found[:-1], (*found[-1], "theta_l"))


def _meshes(
    coordinates: Sequence[str], first: GearStage, behind: Sequence[NextStage], to_gear: float
) -> tuple[MeshVectors, ...]:
    gears = _Gears("", first.working_pressure_angle_rad, first.pinion, first.gear, 0.0)
    found, sense = [_mesh(coordinates, gears, 1, (1.0, to_gear))], 1.0
    for stage, (driving, _) in zip(behind, _ends(behind)[1:], strict=True):
        sense = -sense
        gears = _Gears(stage.name, stage.working_pressure_angle_rad, stage.pinion, stage.gear, stage.direction_rad)
        found.append(_mesh(coordinates, gears, driving, (sense, to_gear)))
    return tuple(found)


class _Gears(NamedTuple):
    name: str
    angle_rad: float
    pinion: Rotor
    gear: Rotor
    direction_rad: float


def _mesh(coordinates: Sequence[str], gears: _Gears, number: int, senses: tuple[float, float]) -> MeshVectors:
    """Return the mesh of gears `number` and the next one.

    `senses`: 1 if its pinion turns as the first one, else -1; 1 if x runs from the first pinion to its gear, else -1.
    """
    a, b = str(number), str(number + 1)
    sense, to_gear = senses
    slope = gears.direction_rad - sense * gears.angle_rad
    x, y = -sense * sin(slope), sense * cos(slope)
    u, v = -sense * y, sense * x
    radii = gears.pinion.base_radius_m, gears.gear.base_radius_m
    line_m = (radii[0] + radii[1]) * tan(gears.angle_rad)
    along = {**_opposed(a, b, to_gear * x, y), f"theta_{a}": radii[0], f"theta_{b}": -radii[1]}
    still = {**_opposed(a, b, to_gear * u, v), f"theta_{b}": -line_m}
    rolling = {f"theta_{a}": 1.0, f"theta_{b}": 1.0}
    sliding = np.array([vector(coordinates, still), vector(coordinates, rolling)])
    sliding.setflags(write=False)
    by_inertia = radii[0] ** 2 / gears.pinion.inertia_kg_m2 + radii[1] ** 2 / gears.gear.inertia_kg_m2
    return MeshVectors(
        vector(coordinates, along),
        sliding,
        1.0 / by_inertia,
        (f"theta_{a}", f"theta_{b}"),
        centre_line=(to_gear * cos(gears.direction_rad), sin(gears.direction_rad)),
        name=gears.name,
    )


def _opposed(a: str, b: str, x: float, y: float) -> dict[str, float]:
    return {f"x_{a}": x, f"y_{a}": y, f"x_{b}": -x, f"y_{b}": -y}
