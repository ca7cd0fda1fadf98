"""Structures of several meshes in a row: shafts with one or two gears on bearings on the ground.

Equations: standard literature (a round beam on two supports; gears as rigid discs); direction of the lines of action
derived. With x along the first centre line from pinion to gear and y along the pitch-line velocity of the first pinion,
which turns from x to y, a driven gear in the direction χ is pushed along (-sin(χ - α), cos(χ - α)) by a gear that turns
that way and along (sin(χ + α), -cos(χ + α)) by one that turns back. Rotations count in the running sense of their
shaft.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import cos, pi, prod, sin, sqrt, tan
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.housing.ordered_sums import squares
from siggen.dynamics.structure.mesh_vectors import MeshVectors
from siggen.dynamics.structure.structure import Bearing, Element, Rotor, SpurStage, Structure, assemble, shafts, vector

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
    """A mesh behind another one: its gears, the shaft that its pinion shares, the direction to its gear [rad]."""

    name: str
    working_pressure_angle_rad: float
    pinion: Rotor
    gear: Rotor
    shaft: CommonShaft
    direction_rad: float


def drivetrain(first: SpurStage, behind: Sequence[NextStage]) -> Structure:
    """Return motor, shafts with their gears, and load: q = [θ_m, x_1, y_1, θ_1, ..., x_2m, y_2m, θ_2m, θ_L].

    Gears 2k - 1 and 2k are those of mesh k; the bearings of the shaft of gear 2k are called by mesh k, of the first
    mesh `pinion_bearing` and `gear_bearing`.
    """
    rotors = [first.pinion, first.gear, *(rotor for stage in behind for rotor in (stage.pinion, stage.gear))]
    inertias, carried = _inertias(first, rotors), _carried(first, behind)
    coordinates = tuple(inertias)
    held, turned = _springs(coordinates, carried), assemble(coordinates, _torsion(first, behind))
    stiffness, damping = held[0] + turned[0], held[1] + turned[1]
    mass = np.diag(list(inertias.values()))
    for matrix in (mass, damping, stiffness):
        matrix.setflags(write=False)
    motions, forces = _at_bearings(coordinates, carried)
    ratio = first.ratio * prod(stage.gear.base_radius_m / stage.pinion.base_radius_m for stage in behind)
    return Structure(
        coordinates=coordinates,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        meshes=_meshes(coordinates, first, behind),
        shaft_lines=_lines(len(behind) + 1),
        torque_vector=vector(coordinates, {"theta_m": 1.0, "theta_l": -ratio}),
        motions=motions,
        bearing_forces=forces,
        bearing_directions=motions,
    )


class _Carried(NamedTuple):
    """A shaft as it stands: what its bearings are called, the numbers of its gears, both bearings together."""

    place: str
    gears: tuple[int, ...]
    bearing: Bearing
    shaft: CommonShaft | None

    def held(self, axis: str) -> tuple[FloatArray, FloatArray]:
        """Return stiffness and damping (gears, gears) of the shaft on its bearings along an axis.

        Bearings and bending give way in series. The dampers see their own springs' share of the motion, as in
        `casing_structure.seated_springs`.
        """
        stiffness = getattr(self.bearing, f"stiffness_{axis}_n_per_m")
        damping = getattr(self.bearing, f"damping_{axis}_n_s_per_m")
        if self.shaft is None:
            return np.array([[stiffness]]), np.array([[damping]])
        ends = np.array([[1.0 - place for place in PLACES], PLACES])
        levers = squares(ends, ends)
        held = _inverse(levers * (2.0 / stiffness) + self.shaft.bending_m_per_n)
        slow = levers * (2.0 * damping / stiffness**2)
        return held, squares(held, squares(slow, held))


def _inverse(matrix: FloatArray) -> FloatArray:
    """Return the inverse of a symmetric (2, 2); written out, since a library's last bits depend on the processor."""
    (a, b), (_, d) = matrix
    return np.asarray(np.array([[d, -b], [-b, a]]) / (a * d - b * b))


def _carried(first: SpurStage, behind: Sequence[NextStage]) -> list[_Carried]:
    """Return the shafts in the order of power."""
    names, seats = ["gear", *(stage.name for stage in behind)], [first.gear, *(stage.gear for stage in behind)]
    found = [_Carried("pinion_bearing", (1,), first.pinion.bearing, None)]
    for number, (name, rotor) in enumerate(zip(names, seats, strict=True)):
        last = number == len(behind)
        gears = (2 * number + 2,) if last else (2 * number + 2, 2 * number + 3)
        found.append(_Carried(f"{name}_bearing", gears, rotor.bearing, None if last else behind[number].shaft))
    return found


def _springs(coordinates: Sequence[str], carried: Sequence[_Carried]) -> tuple[FloatArray, FloatArray]:
    """Return stiffness and damping (n, n) of the bearings and bending shafts."""
    n = len(coordinates)
    stiffness, damping = np.zeros((n, n)), np.zeros((n, n))
    for shaft in carried:
        for axis in AXES.values():
            rows = np.ix_(*[[coordinates.index(f"{axis}_{gear}") for gear in shaft.gears]] * 2)
            held = shaft.held(axis)
            stiffness[rows] += held[0]
            damping[rows] += held[1]
    return stiffness, damping


def _at_bearings(
    coordinates: Sequence[str], carried: Sequence[_Carried]
) -> tuple[dict[str, FloatArray], dict[str, tuple[FloatArray, FloatArray]]]:
    """Return by place/axis how the shaft moves in the middle of its bearings, and the force on them."""
    motions, forces = {}, {}
    for shaft in carried:
        for name, axis in AXES.items():
            held = [matrix.sum(axis=0) for matrix in shaft.held(axis)]
            names = [f"{axis}_{gear}" for gear in shaft.gears]
            pushing, braking = (vector(coordinates, dict(zip(names, row.tolist(), strict=True))) for row in held)
            forces[f"{shaft.place}/{name}"] = pushing, braking
            motions[f"{shaft.place}/{name}"] = pushing / getattr(shaft.bearing, f"stiffness_{axis}_n_per_m")
    return motions, forces


def _inertias(first: SpurStage, rotors: Sequence[Rotor]) -> dict[str, float]:
    found = {"theta_m": first.motor_inertia_kg_m2}
    for number, rotor in enumerate(rotors, start=1):
        found |= {f"x_{number}": rotor.mass_kg, f"y_{number}": rotor.mass_kg, f"theta_{number}": rotor.inertia_kg_m2}
    return found | {"theta_l": first.load_inertia_kg_m2}


def _torsion(first: SpurStage, behind: Sequence[NextStage]) -> list[Element]:
    """Return the couplings at both ends, and the shafts between two gears."""
    driving, driven = shafts(first)
    last = 2 * len(behind) + 2
    found = [driving, replace(driven, direction={f"theta_{last}": 1.0, "theta_l": -1.0})]
    inertia = first.gear.inertia_kg_m2
    for number, stage in enumerate(behind, start=1):
        stiffness, other = stage.shaft.torsional_stiffness_nm_per_rad, stage.pinion.inertia_kg_m2
        damping = 2.0 * TORSIONAL_DAMPING * sqrt(stiffness * inertia * other / (inertia + other))
        found.append(Element({f"theta_{2 * number}": 1.0, f"theta_{2 * number + 1}": -1.0}, stiffness, damping))
        inertia = stage.gear.inertia_kg_m2
    return found


def _lines(meshes: int) -> tuple[tuple[str, ...], ...]:
    between = [(f"theta_{2 * number}", f"theta_{2 * number + 1}") for number in range(1, meshes)]
    return (("theta_m", "theta_1"), *between, (f"theta_{2 * meshes}", "theta_l"))


def _meshes(coordinates: Sequence[str], first: SpurStage, behind: Sequence[NextStage]) -> tuple[MeshVectors, ...]:
    gears = _Gears("", first.working_pressure_angle_rad, first.pinion, first.gear, 0.0)
    found, sense = [_mesh(coordinates, gears, 1, 1.0)], 1.0
    for number, stage in enumerate(behind, start=1):
        sense = -sense
        gears = _Gears(
            stage.name, stage.working_pressure_angle_rad, stage.pinion, stage.gear, stage.direction_rad
        )  # fmt: skip
        found.append(_mesh(coordinates, gears, 2 * number + 1, sense))
    return tuple(found)


class _Gears(NamedTuple):
    name: str
    angle_rad: float
    pinion: Rotor
    gear: Rotor
    direction_rad: float


def _mesh(coordinates: Sequence[str], gears: _Gears, number: int, sense: float) -> MeshVectors:
    """Return the mesh of gears `number` and the next one; its pinion turns from x to y (sense 1) or back (-1)."""
    a, b = str(number), str(number + 1)
    slope = gears.direction_rad - sense * gears.angle_rad
    x, y = -sense * sin(slope), sense * cos(slope)
    radii = gears.pinion.base_radius_m, gears.gear.base_radius_m
    along = {f"x_{a}": x, f"y_{a}": y, f"theta_{a}": radii[0], f"x_{b}": -x, f"y_{b}": -y, f"theta_{b}": -radii[1]}
    u, v = -sense * y, sense * x
    line_m = (radii[0] + radii[1]) * tan(gears.angle_rad)
    still = {f"x_{a}": u, f"y_{a}": v, f"x_{b}": -u, f"y_{b}": -v, f"theta_{b}": -line_m}
    sliding = np.array(
        [vector(coordinates, still), vector(coordinates, {f"theta_{a}": 1.0, f"theta_{b}": 1.0})]
    )  # fmt: skip
    sliding.setflags(write=False)
    by_inertia = radii[0] ** 2 / gears.pinion.inertia_kg_m2 + radii[1] ** 2 / gears.gear.inertia_kg_m2
    return MeshVectors(
        vector(coordinates, along),
        sliding,
        1.0 / by_inertia,
        (f"theta_{a}", f"theta_{b}"),
        centre_line=(cos(gears.direction_rad), sin(gears.direction_rad)),
        name=gears.name,
    )
