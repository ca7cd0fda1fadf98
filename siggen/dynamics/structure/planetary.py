"""Structure of a planetary set in its carrier's frame: 2N meshes on motor, sun, planets, ring, carrier and load.

Equations: standard literature (Lin & Parker 1999, three coordinates per body), directions derived again. All rotations
count counter-clockwise, as the sun drives; x and y turn with the carrier, in which lines of action stand still. So do
supports that are alike in all directions. Planets move along the radius (x) and along the tangent (y) against their
pins, so that free rotation moves no translation. What turning adds to the inertia, 2 Ω_c m in the speeds and Ω_c² m
in the places, is left out: beside a spring k at a frequency ω it counts as 2 Ω_c/ω, below 1 % above 200 Ω_c.

Sliding, derived: with n the direction in which flanks push and t = z x n, a point at s of the driving flank moves by
v_a·t + s θ̇_a along the flanks, its mate by v_b·t + (s - T) θ̇_b, with a negative T in a ring. It counts in the sense in
which the driving gear turns, so that it grows with s.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, pi, sin, tan

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.body import Body, Row
from siggen.dynamics.structure.casing_structure import seated_springs
from siggen.dynamics.structure.gear_stage import Coupling
from siggen.dynamics.structure.mesh_vectors import MeshVectors
from siggen.dynamics.structure.structure import Element, Structure, assemble, vector


@dataclass(frozen=True, slots=True)
class PlanetaryBody:
    """A member with its support, alike in all directions; `turning_stiffness_nm_per_rad` holds the ring."""

    base_radius_m: float
    mass_kg: float
    inertia_kg_m2: float
    stiffness_n_per_m: float
    damping_n_s_per_m: float
    turning_stiffness_nm_per_rad: float = 0.0
    turning_damping_nm_s_per_rad: float = 0.0


@dataclass(frozen=True, slots=True)
class PlanetaryStage:
    """Numbers of a set whose ring is held; the carrier's base radius is not read.

    Working pressure angles of the meshes with the sun and with the ring [rad]; places of the planets [turns]; the
    support of a planet is its pin's.
    """

    sun_angle_rad: float
    ring_angle_rad: float
    centre_distance_m: float
    sun: PlanetaryBody
    planet: PlanetaryBody
    ring: PlanetaryBody
    carrier: PlanetaryBody
    places_turns: tuple[float, ...]
    motor_inertia_kg_m2: float
    load_inertia_kg_m2: float
    input_coupling: Coupling
    output_coupling: Coupling

    @property
    def ratio(self) -> float:
        """Turns of the sun per turn of the carrier, 1 + R_br/R_bs."""
        return 1.0 + self.ring.base_radius_m / self.sun.base_radius_m


def planetary_structure(stage: PlanetaryStage, body: Body | None = None) -> Structure:
    """Return the structure of a planetary set; its meshes: sun with each planet, then each planet with the ring.

    q = [θ_m, x_s, y_s, θ_s, x_c, y_c, θ_c, x, y and θ of every planet, x_r, y_r, θ_r, θ_l, those of the body].

    A `body` holds sun, carrier and ring in its seats, at the moment at which the frame's axes are its own; without one
    they stand on the ground, whatever the frame's angle.
    """
    numbers = range(1, len(stage.places_turns) + 1)
    names = ["s", "c", *(f"p{i}" for i in numbers), "r"]
    own = ("theta_m", *(f"{axis}_{name}" for name in names for axis in ("x", "y", "theta")), "theta_l")
    coordinates = own if body is None else (*own, *body.inertias)
    held = supports_of_set(stage, {} if body is None else body.seats)
    elements, masses = _springs(stage), _masses(stage)
    if body is not None:
        elements += body.supports
        masses += [Element({name: 1.0}, inertia, 0.0) for name, inertia in body.inertias.items()]
    flexibility = None if body is None else body.flexibility_m_per_n
    springs = seated_springs(coordinates, {name: (one,) for name, one in held.items()}, tuple(held), flexibility)
    stiffness, damping = assemble(coordinates, elements)
    stiffness, damping = stiffness + springs.stiffness, damping + springs.damping
    mass, _ = assemble(coordinates, masses)
    for matrix in (mass, damping, stiffness):
        matrix.setflags(write=False)
    return Structure(
        coordinates=coordinates,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        meshes=(*_sun_meshes(coordinates, stage), *_ring_meshes(coordinates, stage)),
        shaft_lines=(("theta_m", "theta_s"), *((f"theta_p{i}",) for i in numbers), ("theta_c", "theta_l")),
        torque_vector=vector(coordinates, {"theta_m": 1.0, "theta_l": -stage.ratio}),
        motions={
            f"{place}/{direction}": vector(coordinates, {f"{axis}_{name}": 1.0})
            for place, name in _SEEN.items()
            for direction, axis in (("horizontal", "x"), ("vertical", "y"))
        },
        bearing_forces=springs.forces,
        bearing_directions=springs.directions,
        line_speeds=_line_speeds(stage),
        frame="theta_c",
    )


_SEEN = {"sun_bearing": "s", "carrier_bearing": "c", "ring": "r"}
"""Place of a sensor -> body whose motion it shows; along axes of the frame, which `in_space` turns."""
AXES = {"x": "horizontal", "y": "vertical"}
RING_TURNING = "ring/turning"
"""What keeps the ring from turning: a moment [N m] among the forces on a housing."""


SEATS_OF_SET = (*(f"{place}/{axis}" for place in _SEEN for axis in AXES.values()), RING_TURNING)
"""Place/axis of what presses on a housing: both axes of sun, carrier and ring, and the ring's moment."""


def _line_speeds(stage: PlanetaryStage) -> tuple[float, ...]:
    """Return the turns of sun, planets and carrier per turn of the sun (Willis, in base radii)."""
    carrier = 1.0 / stage.ratio
    planet = carrier * (1.0 - stage.ring.base_radius_m / stage.planet.base_radius_m)
    return (1.0, *(planet for _ in stage.places_turns), carrier)


def _moved(stage: PlanetaryStage, number: int) -> tuple[dict[str, float], dict[str, float]]:
    """Return how far a planet moves in all, along the radius and along the tangent: with the carrier, and beyond."""
    angle = 2.0 * pi * stage.places_turns[number - 1]
    radial = {f"x_p{number}": 1.0, "x_c": cos(angle), "y_c": sin(angle)}
    along = {f"y_p{number}": 1.0, "x_c": -sin(angle), "y_c": cos(angle), "theta_c": stage.centre_distance_m}
    return radial, along


def _masses(stage: PlanetaryStage) -> list[Element]:
    """Return masses as elements: what moves along a direction, and how heavy it is."""
    found = [Element({"theta_m": 1.0}, stage.motor_inertia_kg_m2, 0.0)]
    found += [Element({"theta_l": 1.0}, stage.load_inertia_kg_m2, 0.0)]
    for name, body in (("s", stage.sun), ("c", stage.carrier), ("r", stage.ring)):
        found += [Element({f"{axis}_{name}": 1.0}, body.mass_kg, 0.0) for axis in "xy"]
        found += [Element({f"theta_{name}": 1.0}, body.inertia_kg_m2, 0.0)]
    for number in range(1, len(stage.places_turns) + 1):
        found += [Element(direction, stage.planet.mass_kg, 0.0) for direction in _moved(stage, number)]
        found += [Element({f"theta_p{number}": 1.0}, stage.planet.inertia_kg_m2, 0.0)]
    return found


def _springs(stage: PlanetaryStage) -> list[Element]:
    found = [
        Element({first: 1.0, second: -1.0}, coupling.stiffness_nm_per_rad, coupling.damping_nm_s_per_rad)
        for first, second, coupling in (
            ("theta_m", "theta_s", stage.input_coupling),
            ("theta_c", "theta_l", stage.output_coupling),
        )
    ]
    pin = stage.planet.stiffness_n_per_m, stage.planet.damping_n_s_per_m
    numbers = range(1, len(stage.places_turns) + 1)
    return found + [Element({f"{axis}_p{i}": 1.0}, *pin) for i in numbers for axis in AXES]


def supports_of_set(stage: PlanetaryStage, seats: Mapping[str, Row]) -> dict[str, Element]:
    """Return place/axis -> what holds sun, carrier and ring, in seats or on the ground; in the order of all seats."""
    bodies = {"s": stage.sun, "c": stage.carrier, "r": stage.ring}
    found = {
        f"{place}/{shown}": ({f"{axis}_{name}": 1.0}, bodies[name].stiffness_n_per_m, bodies[name].damping_n_s_per_m)
        for place, name in _SEEN.items()
        for axis, shown in AXES.items()
    }
    held = stage.ring.turning_stiffness_nm_per_rad, stage.ring.turning_damping_nm_s_per_rad
    found[RING_TURNING] = ({"theta_r": 1.0}, *held)
    return {
        name: Element({**own, **{key: -value for key, value in seats.get(name, {}).items()}}, *numbers)
        for name, (own, *numbers) in found.items()
    }


def _sun_meshes(coordinates: Sequence[str], stage: PlanetaryStage) -> list[MeshVectors]:
    """Return the meshes of the sun, which pushes a planet at ψ along (-sin(ψ - α), cos(ψ - α))."""
    radii, found, slant = (stage.sun.base_radius_m, stage.planet.base_radius_m), [], stage.sun_angle_rad
    for number, place in enumerate(stage.places_turns, start=1):
        angle = 2.0 * pi * place - slant
        push = {"x_s": -sin(angle), "y_s": cos(angle), "theta_s": radii[0], f"theta_p{number}": radii[1]}
        carried = _planet(stage, number, -sin(slant), -cos(slant))
        mass = radii[0] ** 2 / stage.sun.inertia_kg_m2 + radii[1] ** 2 / stage.planet.inertia_kg_m2
        turning = ("theta_s", f"theta_p{number}")
        across = {"x_s": -cos(angle), "y_s": -sin(angle), **_planet(stage, number, cos(slant), -sin(slant))}
        sliding = _sliding(coordinates, across, turning, (radii[0] + radii[1]) * tan(slant))
        found.append(_mesh(coordinates, {**push, **carried}, sliding, 1.0 / mass, turning, f"sun_{number}"))
    return found


def _ring_meshes(coordinates: Sequence[str], stage: PlanetaryStage) -> list[MeshVectors]:
    """Return the meshes of the planets, each of which pushes the ring along (sin(ψ + α), -cos(ψ + α))."""
    radii, found, slant = (stage.planet.base_radius_m, stage.ring.base_radius_m), [], stage.ring_angle_rad
    for number, place in enumerate(stage.places_turns, start=1):
        angle = 2.0 * pi * place + slant
        push = {"x_r": -sin(angle), "y_r": cos(angle), "theta_r": radii[1], f"theta_p{number}": -radii[0]}
        carried = _planet(stage, number, sin(slant), -cos(slant))
        mass = radii[0] ** 2 / stage.planet.inertia_kg_m2 + radii[1] ** 2 / stage.ring.inertia_kg_m2
        turning = (f"theta_p{number}", "theta_r")
        across = {"x_r": -cos(angle), "y_r": -sin(angle), **_planet(stage, number, cos(slant), sin(slant))}
        # planets turn the other way
        sliding = -_sliding(coordinates, across, turning, (radii[0] - radii[1]) * tan(slant))
        found.append(_mesh(coordinates, {**push, **carried}, sliding, 1.0 / mass, turning, f"ring_{number}"))
    return found


def _planet(stage: PlanetaryStage, number: int, radial: float, along: float) -> dict[str, float]:
    """Return the entries of a planet's whole motion with factors along the radius and along the tangent."""
    found: dict[str, float] = {}
    for factor, direction in zip((radial, along), _moved(stage, number), strict=True):
        for name, value in direction.items():
            found[name] = found.get(name, 0.0) + factor * value
    return found


def _sliding(
    coordinates: Sequence[str], across: dict[str, float], turning: tuple[str, str], line_m: float
) -> FloatArray:
    """Return r_0, r_1 (2, n) of the gears that turn; `across` is the motion of both across the line of action."""
    driving, driven = turning
    shifts = vector(coordinates, {**across, driven: line_m})
    return np.array([shifts, vector(coordinates, {driving: 1.0, driven: -1.0})])


def _mesh(
    coordinates: Sequence[str],
    along: dict[str, float],
    sliding: FloatArray,
    mass_kg: float,
    turning: tuple[str, str],
    name: str,
) -> MeshVectors:
    sliding.setflags(write=False)
    return MeshVectors(vector(coordinates, along), sliding, mass_kg, turning, name=name)
