"""Structures of gears that run in a casing on bolts.

Equations: 11-DOF model with a casing of two translations and rocking (reference: standard
literature; the casing as in paper B: Luo, Baddour, Liang, MSSP 119 (2019) 155-181, whose equations were not available);
directions of the elements derived. With a casing, y runs along the line of action from pinion to gear, x across it, and
the casing turns from x to y. Given and measured quantities are horizontal (from gear to pinion) and vertical (along the
pitch-line velocity of the pinion at the mesh).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.housing.ordered_sums import squares
from siggen.dynamics.housing.stiff_pencil import solve_lower, solve_upper, upper_root
from siggen.dynamics.structure.axial_motion import (
    axial_approach,
    axial_bearings,
    axial_inertias,
    tilt_share,
)
from siggen.dynamics.structure.body import Body, Casing, axis_vector, rigid_body
from siggen.dynamics.structure.gear_stage import GearStage, Rotor
from siggen.dynamics.structure.mesh_vectors import MeshVectors
from siggen.dynamics.structure.structure import (
    Element,
    Structure,
    assemble,
    shafts,
    sliding_vectors,
    stage_lines,
    vector,
)
from siggen.dynamics.structure.tilting_shaft import Shaft, crossed_ends, tilting_ends

AXES = ("vertical", "horizontal")


def casing_structure(stage: GearStage, casing: Casing, shafts_of_gears: tuple[Shaft, Shaft] | None = None) -> Structure:
    """Return the gears in a rigid casing, q = [θ_m, θ_1, θ_2, θ_L, x_1, y_1, x_2, y_2, x_c, y_c, φ_c] and tilts.

    Sensors at the bearings sit on the casing. A sensor of another name is seen as `casing_<name>`.

    Raises
    ------
    ValueError
        If the bolts leave the casing free to move.
    """
    return carried_structure(stage, casing_body(stage, casing), shafts_of_gears)


def casing_body(stage: GearStage, casing: Casing) -> Body:
    """Return a rigid casing as the body that carries a stage.

    Raises
    ------
    ValueError
        As `casing_structure`.
    """
    refuse_single_bolt(casing)
    gear_place = (casing.pinion_place_m[0] - _centre_distance_m(stage), casing.pinion_place_m[1])
    return rigid_body(casing, {"gear_bearing": gear_place}, stage.working_pressure_angle_rad)


def refuse_single_bolt(casing: Casing) -> None:
    """Raise if nothing keeps a casing from turning.

    Raises
    ------
    ValueError
        If its bolts stand in one place.
    """
    if len(set(casing.bolts.places_m)) < 2:
        raise ValueError(
            f"bolts: received {len(set(casing.bolts.places_m))} distinct places; allowed are at least 2, "
            "since about a single one the casing would turn freely"
        )


def carried_structure(stage: GearStage, body: Body, shafts_of_gears: tuple[Shaft, Shaft] | None = None) -> Structure:
    """Return the gears in a body, q = [θ_m, θ_1, θ_2, θ_L, x_1, y_1, x_2, y_2, coordinates of the body].

    With shafts that bend, the tilts [φ_x1, φ_y1, φ_x2, φ_y2] come behind: what a gear moves along x and y at a distance
    along its axis, per distance. Seats do not tilt. With helical teeth [z_1, z_2] come last (`axial_motion`); a body
    without seats along the shafts holds them where they are.
    """
    angle = stage.working_pressure_angle_rad
    bearings = {
        **_bearings("1", "pinion_bearing", stage.pinion, body, angle),
        **_bearings("2", "gear_bearing", stage.gear, body, angle),
    }
    held = _held(bearings, shafts_of_gears)
    crossing = _crossing(held, bearings, stage, shafts_of_gears)
    along, grounded = _axial(stage, body)
    held |= {name: (element,) for name, element in along.items()}
    inertias = {**_rotations(stage), **_translations(stage), **body.inertias, **_tilt_inertias(shafts_of_gears)}
    inertias |= axial_inertias(stage)
    coordinates = tuple(inertias)
    stiffness, damping = assemble(coordinates, (*shafts(stage), *body.supports, *grounded.values()))
    springs = seated_springs(coordinates, held, tuple(body.seats), body.flexibility_m_per_n, crossing)
    centre_line = axis_vector("horizontal", angle)
    line_of_action = {
        "y_1": 1.0,
        "y_2": -1.0,
        **axial_approach(stage, None if shafts_of_gears is None else centre_line),
    }
    across = {"x_1": 1.0, "x_2": -1.0}
    motions = {name: vector(coordinates, row) for name, row in body.motions.items()}
    structure = _structure(
        stage, inertias, stiffness + springs.stiffness, damping + springs.damping, line_of_action, motions, across
    )
    share = tilt_share(stage)
    tilt = None if shafts_of_gears is None else vector(coordinates, {"phi_y_1": share, "phi_y_2": -share})
    mesh = replace(structure.mesh, tilt=tilt, centre_line=centre_line)
    rows = {name: vector(coordinates, one.direction) for name, one in grounded.items()}
    forces = {name: (one.stiffness * rows[name], one.damping * rows[name]) for name, one in grounded.items()}
    return replace(
        structure,
        meshes=(mesh,),
        bearing_forces=springs.forces | forces,
        bearing_directions=springs.directions | rows,
    )


def _axial(stage: GearStage, body: Body) -> tuple[dict[str, Element], dict[str, Element]]:
    """Return place/axis -> what holds the shafts along their axes: in seats of the body, and without one."""
    seated: dict[str, Element] = {}
    grounded: dict[str, Element] = {}
    for name, one in axial_bearings(stage).items():
        seat = {key: -value for key, value in body.seats.get(name, {}).items()}
        found = seated if name in body.seats else grounded
        found[name] = Element({one.coordinate: 1.0, **seat}, one.stiffness, one.damping)
    return seated, grounded


def _held(
    bearings: Mapping[str, Element], shafts_of_gears: tuple[Shaft, Shaft] | None
) -> dict[str, tuple[Element, ...]]:
    """Return what lies between the gears and the casing, by place/axis: of a shaft that bends one for each end."""
    if shafts_of_gears is None:
        return {name: (bearing,) for name, bearing in bearings.items()}
    of_gear = {"pinion_bearing": ("1", shafts_of_gears[0]), "gear_bearing": ("2", shafts_of_gears[1])}
    held = {}
    for name, bearing in bearings.items():
        index, shaft = of_gear[name.split("/")[0]]
        held[name] = tuple(tilting_ends(bearing, shaft, index).values())
    return held


Crossing = Mapping[str, Sequence[tuple[float, float]]]
"""Bearing -> stiffness and damping that tie both axes, for each of its springs."""


def _crossing(
    held: dict[str, tuple[Element, ...]],
    bearings: Mapping[str, Element],
    stage: GearStage,
    shafts_of_gears: tuple[Shaft, Shaft] | None,
) -> Crossing:
    """Return what ties both axes of bearings that do; of shafts that bend their springs are put into `held`."""
    found = {}
    for number, (name, rotor) in enumerate((("pinion_bearing", stage.pinion), ("gear_bearing", stage.gear))):
        mixed = rotor.bearing.stiffness_xy_n_per_m
        if mixed == 0.0:
            continue
        axes = f"{name}/vertical", f"{name}/horizontal"
        if shafts_of_gears is None:
            found[name] = [(mixed, 0.0)]
            continue
        both = bearings[axes[0]], bearings[axes[1]]
        ends = crossed_ends(both, mixed, shafts_of_gears[number], str(number + 1))
        held |= {axis: tuple(end.elements[i] for end in ends) for i, axis in enumerate(axes)}
        found[name] = [(end.stiffness, end.damping) for end in ends]
    return found


def _tilt_inertias(shafts_of_gears: tuple[Shaft, Shaft] | None) -> dict[str, float]:
    if shafts_of_gears is None:
        return {}
    return {
        f"phi_{axis}_{index}": shaft.tilt_inertia_kg_m2
        for index, shaft in zip("12", shafts_of_gears, strict=True)
        for axis in "xy"
    }


class SeatedSprings(NamedTuple):
    """Stiffness and damping (n, n) of all bearings; by place/axis force per displacement and velocity, direction."""

    stiffness: FloatArray
    damping: FloatArray
    forces: dict[str, tuple[FloatArray, FloatArray]]
    directions: dict[str, FloatArray]


def seated_springs(
    coordinates: tuple[str, ...],
    held: Mapping[str, Sequence[Element]],
    seats: tuple[str, ...],
    flexibility_m_per_n: FloatArray | None,
    crossing: Crossing | None = None,
) -> SeatedSprings:
    """Return bearings on seats that give way by (seats, seats), each by the forces on all of them.

    Derived: springs k_i in series with the flexibility R of their seats have the stiffness K = (diag(1/k) + R)^-1
    together. A damper c sees its own spring's share of the motion, K/k: C = K diag(c/k²) K (exact for slow motion).
    Where both axes of a bearing are tied, matrices k and c stand for the diagonal ones.
    """
    elements = [(seats.index(name), element) for name, of_place in held.items() for element in of_place]
    rows = np.array([vector(coordinates, element.direction) for _, element in elements])
    seat = [number for number, _ in elements]
    k, c = (np.array([getattr(e, name) for _, e in elements]) for name in ("stiffness", "damping"))
    stiff, damped = np.diag(k), np.diag(c)
    for name, ties in (crossing or {}).items():
        axes = [[i for i, place in enumerate(seat) if seats[place] == f"{name}/{axis}"] for axis in AXES]
        for i, j, tie in zip(*axes, ties, strict=True):
            stiff[i, j], damped[i, j] = stiff[j, i], damped[j, i] = tie
    if flexibility_m_per_n is not None:
        give, slow = np.diag(1.0 / k), np.diag(c / k**2)
        if crossing:
            give = _inverse(stiff)
            slow = _squares(give, _squares(damped, give))
        stiff = _inverse(give + flexibility_m_per_n[np.ix_(seat, seat)])
        damped = _squares(stiff, _squares(slow, stiff))
    pushing, braking = _squares(stiff, rows), _squares(damped, rows)
    forces, directions = {}, {}
    for name in held:
        own = [number for number, place in enumerate(seat) if place == seats.index(name)]
        forces[name] = np.add.reduce(pushing[own]), np.add.reduce(braking[own])
        # both ends of a shaft share a force between shaft and seat as their springs do
        directions[name] = np.add.reduce(rows[own] * (k[own] / k[own].sum())[:, None])
    return SeatedSprings(_squares(rows, pushing), _squares(rows, braking), forces, directions)


def _squares(left: FloatArray, right: FloatArray) -> FloatArray:
    return squares(np.ascontiguousarray(left), np.ascontiguousarray(right))


def _inverse(matrix: FloatArray) -> FloatArray:
    """Return the inverse of a small positive definite matrix; a library's last bits depend on the processor."""
    root = upper_root(matrix)
    inverse = solve_upper(root, solve_lower(root, np.eye(len(matrix))))
    return np.asarray(0.5 * (inverse + inverse.T))


def _rotations(stage: GearStage) -> dict[str, float]:
    return {
        "theta_m": stage.motor_inertia_kg_m2,
        "theta_1": stage.pinion.inertia_kg_m2,
        "theta_2": stage.gear.inertia_kg_m2,
        "theta_l": stage.load_inertia_kg_m2,
    }


def _translations(stage: GearStage) -> dict[str, float]:
    pinion, gear = stage.pinion.mass_kg, stage.gear.mass_kg
    return {"x_1": pinion, "y_1": pinion, "x_2": gear, "y_2": gear}


def _centre_distance_m(stage: GearStage) -> float:
    radii = stage.pinion.base_radius_m + stage.gear.base_radius_m
    return float(radii / np.cos(stage.working_pressure_angle_rad))


def _bearings(index: str, name: str, rotor: Rotor, body: Body, angle_rad: float) -> dict[str, Element]:
    """Return place/axis -> the spring between a gear and its seat in the body."""
    bearing = rotor.bearing
    numbers = {
        "vertical": (bearing.stiffness_y_n_per_m, bearing.damping_y_n_s_per_m),
        "horizontal": (bearing.stiffness_x_n_per_m, bearing.damping_x_n_s_per_m),
    }
    result = {}
    for axis, (stiffness, damping) in numbers.items():
        u = axis_vector(axis, angle_rad)
        seat = {key: -value for key, value in body.seats[f"{name}/{axis}"].items()}
        result[f"{name}/{axis}"] = Element({f"x_{index}": u[0], f"y_{index}": u[1], **seat}, stiffness, damping)
    return result


def _structure(
    stage: GearStage,
    inertias: Mapping[str, float],
    stiffness: FloatArray,
    damping: FloatArray,
    line_of_action: Mapping[str, float],
    motions: Mapping[str, FloatArray],
    across: Mapping[str, float],
) -> Structure:
    coordinates = tuple(inertias)
    mass = np.diag(list(inertias.values()))
    for matrix in (mass, damping, stiffness):
        matrix.setflags(write=False)
    rolling = {"theta_1": stage.pinion.base_radius_m, "theta_2": -stage.gear.base_radius_m}
    return Structure(
        coordinates=coordinates,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        meshes=(
            MeshVectors(
                vector(coordinates, {**rolling, **line_of_action}),
                sliding_vectors(coordinates, stage, across),
                stage.equivalent_mesh_mass_kg,
            ),
        ),
        shaft_lines=stage_lines(coordinates),
        torque_vector=vector(coordinates, {"theta_m": 1.0, "theta_l": -stage.ratio}),
        motions=motions,
        bearing_forces={},
        bearing_directions={},
    )
