"""Structures with other bodies than two gears: shafts alone, or gears that run in a casing on bolts.

Equations: 4-DOF torsional model and 11-DOF model with a casing of two translations and rocking (reference: standard
literature; the casing as in paper B: Luo, Baddour, Liang, MSSP 119 (2019) 155-181, whose equations were not available);
directions of the elements derived. With a casing, y runs along the line of action from pinion to gear, x across it, and
the casing turns from x to y. Given and measured quantities are horizontal (from gear to pinion) and vertical (along the
pitch-line velocity of the pinion at the mesh).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.structure import (
    Element,
    Rotor,
    SpurStage,
    Structure,
    assemble,
    shafts,
    sliding_vectors,
    vector,
)
from siggen.dynamics.structure.tilting_shaft import Shaft, tilting_ends

Point = tuple[float, float]
"""Horizontal and vertical distance from the casing's centre of gravity [m]."""


@dataclass(frozen=True, slots=True)
class Bolts:
    """Bolts between casing and ground, all alike: horizontal stiffness by shear, vertical by the bolt's axis."""

    shear_stiffness_n_per_m: float
    axial_stiffness_n_per_m: float
    damping_ratio: float
    places_m: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class Casing:
    """A rigid casing, and where pinion and sensors stand on it."""

    mass_kg: float
    inertia_kg_m2: float
    bolts: Bolts
    pinion_place_m: Point
    sensor_places_m: Mapping[str, Point]


def torsional(stage: SpurStage) -> Structure:
    """Return the rotations alone, q = [θ_m, θ_1, θ_2, θ_L]; what can be seen are the gears' base circles.

    Source: standard literature (torsional spur gear model).
    """
    inertias = _rotations(stage)
    coordinates = tuple(inertias)
    stiffness, damping = assemble(coordinates, shafts(stage))
    rims = {
        "pinion_rim/tangential": vector(coordinates, {"theta_1": stage.pinion.base_radius_m}),
        "gear_rim/tangential": vector(coordinates, {"theta_2": stage.gear.base_radius_m}),
    }
    return _structure(stage, inertias, stiffness, damping, {}, rims, {})


def casing_structure(stage: SpurStage, casing: Casing, shafts_of_gears: tuple[Shaft, Shaft] | None = None) -> Structure:
    """Return the gears in a bolted casing, q = [θ_m, θ_1, θ_2, θ_L, x_1, y_1, x_2, y_2, x_c, y_c, φ_c].

    Sensors at the bearings sit on the casing. A sensor of another name is seen as `casing_<name>`.
    With shafts that bend, the tilts [φ_x1, φ_y1, φ_x2, φ_y2] come behind: what a gear moves along x and y at a distance
    along its axis, per distance. The casing itself does not tilt.

    Raises
    ------
    ValueError
        If the bolts leave the casing free to move.
    """
    if len(set(casing.bolts.places_m)) < 2:
        raise ValueError(
            f"bolts: received {len(set(casing.bolts.places_m))} distinct places; allowed are at least 2, "
            "since about a single one the casing would turn freely"
        )
    angle = stage.working_pressure_angle_rad
    gear_place = (casing.pinion_place_m[0] - _centre_distance_m(stage), casing.pinion_place_m[1])
    seats = {"pinion_bearing": casing.pinion_place_m, "gear_bearing": gear_place}
    bearings = {
        **_bearings("1", "pinion_bearing", stage.pinion, casing.pinion_place_m, angle),
        **_bearings("2", "gear_bearing", stage.gear, gear_place, angle),
    }
    held = _held(bearings, shafts_of_gears)
    places = {**seats, **{f"casing_{name}": place for name, place in casing.sensor_places_m.items()}}
    inertias = {**_rotations(stage), **_translations(stage), **_casing_inertias(casing)}
    inertias |= _tilt_inertias(shafts_of_gears)
    coordinates = tuple(inertias)
    springs = (element for elements in held.values() for element in elements)
    stiffness, damping = assemble(coordinates, (*shafts(stage), *springs, *bolt_elements(casing, angle)))
    motions = {
        f"{name}/{axis}": vector(coordinates, _on_casing(place, axis, angle))
        for name, place in places.items()
        for axis in ("vertical", "horizontal")
    }
    line_of_action = {"y_1": 1.0, "y_2": -1.0}
    across = {"x_1": 1.0, "x_2": -1.0}
    forces = {name: _force_rows(coordinates, elements) for name, elements in held.items()}
    structure = _structure(stage, inertias, stiffness, damping, line_of_action, motions, across)
    tilt = None if shafts_of_gears is None else vector(coordinates, {"phi_y_1": 1.0, "phi_y_2": -1.0})
    return replace(structure, bearing_forces=forces, tilt_vector=tilt)


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


def _tilt_inertias(shafts_of_gears: tuple[Shaft, Shaft] | None) -> dict[str, float]:
    if shafts_of_gears is None:
        return {}
    return {
        f"phi_{axis}_{index}": shaft.tilt_inertia_kg_m2
        for index, shaft in zip("12", shafts_of_gears, strict=True)
        for axis in "xy"
    }


def _force_rows(coordinates: tuple[str, ...], elements: Sequence[Element]) -> tuple[FloatArray, FloatArray]:
    """Return what the elements together press with, per displacement and per velocity, each (n,)."""
    directions = [vector(coordinates, element.direction) for element in elements]
    pairs = list(zip(elements, directions, strict=True))
    stiffness, damping = [e.stiffness * v for e, v in pairs], [e.damping * v for e, v in pairs]
    return np.add.reduce(stiffness), np.add.reduce(damping)


def bolt_elements(casing: Casing, angle_rad: float) -> tuple[Element, ...]:
    """Return the bolts as springs on the casing; c = 2 ζ √(k m_c/bolts)."""
    bolts = casing.bolts
    numbers = {"horizontal": bolts.shear_stiffness_n_per_m, "vertical": bolts.axial_stiffness_n_per_m}
    share = casing.mass_kg / len(bolts.places_m)
    return tuple(
        Element(_on_casing(place, axis, angle_rad), k, float(2.0 * bolts.damping_ratio * np.sqrt(k * share)))
        for place in bolts.places_m
        for axis, k in numbers.items()
    )


def _rotations(stage: SpurStage) -> dict[str, float]:
    return {
        "theta_m": stage.motor_inertia_kg_m2,
        "theta_1": stage.pinion.inertia_kg_m2,
        "theta_2": stage.gear.inertia_kg_m2,
        "theta_l": stage.load_inertia_kg_m2,
    }


def _translations(stage: SpurStage) -> dict[str, float]:
    pinion, gear = stage.pinion.mass_kg, stage.gear.mass_kg
    return {"x_1": pinion, "y_1": pinion, "x_2": gear, "y_2": gear}


def _casing_inertias(casing: Casing) -> dict[str, float]:
    return {"x_c": casing.mass_kg, "y_c": casing.mass_kg, "phi_c": casing.inertia_kg_m2}


def _centre_distance_m(stage: SpurStage) -> float:
    radii = stage.pinion.base_radius_m + stage.gear.base_radius_m
    return float(radii / np.cos(stage.working_pressure_angle_rad))


def _axis(axis: str, angle_rad: float) -> Point:
    """Return the (x, y) components of the horizontal or the vertical unit vector."""
    sine, cosine = float(np.sin(angle_rad)), float(np.cos(angle_rad))
    return (cosine, -sine) if axis == "horizontal" else (sine, cosine)


def _on_casing(place_m: Point, axis: str, angle_rad: float) -> dict[str, float]:
    """Return the motion of a point of the casing along an axis: (x_c - Y φ_c, y_c + X φ_c) · u."""
    u, (h, v) = _axis(axis, angle_rad), place_m
    # Arm of the axis about the centre of gravity, X u_y - Y u_x; it does not depend on the frame.
    arm = -v if axis == "horizontal" else h
    return {"x_c": u[0], "y_c": u[1], "phi_c": arm}


def _bearings(index: str, name: str, rotor: Rotor, place_m: Point, angle_rad: float) -> dict[str, Element]:
    """Return place/axis -> the spring between a gear and its seat in the casing."""
    bearing = rotor.bearing
    numbers = {
        "vertical": (bearing.stiffness_y_n_per_m, bearing.damping_y_n_s_per_m),
        "horizontal": (bearing.stiffness_x_n_per_m, bearing.damping_x_n_s_per_m),
    }
    result = {}
    for axis, (stiffness, damping) in numbers.items():
        u = _axis(axis, angle_rad)
        seat = {key: -value for key, value in _on_casing(place_m, axis, angle_rad).items()}
        result[f"{name}/{axis}"] = Element({f"x_{index}": u[0], f"y_{index}": u[1], **seat}, stiffness, damping)
    return result


def _structure(
    stage: SpurStage,
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
        mesh_vector=vector(coordinates, {**rolling, **line_of_action}),
        sliding_vectors=sliding_vectors(coordinates, stage, across),
        torque_vector=vector(coordinates, {"theta_m": 1.0, "theta_l": -stage.ratio}),
        equivalent_mesh_mass_kg=stage.equivalent_mesh_mass_kg,
        motions=motions,
        bearing_forces={},
    )
