"""Body: what carries the bearings, as coordinates: those of a rigid casing, or the lowest modes of a box of plates.

Directions are horizontal (from gear to pinion) and vertical (along the pitch-line velocity of the pinion at the mesh).
Derived. Of a box, the modes below some frequency are coordinates of modal mass 1; what all others give way at the seats
lies in series with the bearings (`casing_structure`). A base under the bolts moves every mode at rest by
g_r = φ_rᵀ K_b t/ω_r², t the base's motion at the bolts, so that a mode's spring acts between η_r and g_r: a base that
moves slowly takes the whole box along.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.structure import MODE, Element

Point = tuple[float, float]
"""Horizontal and vertical distance from the casing's centre of gravity [m]."""
Row = Mapping[str, float]
"""Coordinate -> what it moves."""
DIRECTIONS = ("vertical", "horizontal")
BASE = ("x_b", "y_b", "phi_b")


@dataclass(frozen=True, slots=True)
class Body:
    """A body that carries the bearings.

    Attributes
    ----------
    inertias : coordinate -> inertia
    supports : springs between the body and what it stands on
    seats : place/axis of every bearing -> motion of its seat
    motions : place/axis -> motion of what else is seen
    entries : name -> motion of where other forces press on it
    base : coordinate -> its motion with a base (`BASE`) that moves slowly
    flexibility_m_per_n : (seats, seats) what seats give way beyond the coordinates; None: nothing
    """

    inertias: Mapping[str, float]
    supports: tuple[Element, ...]
    seats: Mapping[str, Row]
    motions: Mapping[str, Row]
    entries: Mapping[str, Row]
    base: Mapping[str, Row]
    flexibility_m_per_n: FloatArray | None = None


@dataclass(frozen=True, slots=True)
class Bolts:
    """Bolts between casing and ground: horizontal stiffness by shear, vertical by the bolt's axis.

    All are alike, but the first has a share of its stiffness left where it is loose: softer, and never off the ground.
    """

    shear_stiffness_n_per_m: float
    axial_stiffness_n_per_m: float
    damping_ratio: float
    places_m: tuple[Point, ...]
    loose_share: float = 1.0


@dataclass(frozen=True, slots=True)
class Casing:
    """A rigid casing, and where pinion and sensors stand on it."""

    mass_kg: float
    inertia_kg_m2: float
    bolts: Bolts
    pinion_place_m: Point
    sensor_places_m: Mapping[str, Point] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ModalBody:
    """The lowest modes (n,) of a box, modal mass 1; shapes are rows (n,) [kg^-1/2].

    `bolts` are (place, axis) -> stiffness [N/m] and shape, places from the middle between both shafts.
    """

    frequency_hz: FloatArray
    damping_ratio: FloatArray
    seats: Mapping[str, FloatArray]
    motions: Mapping[str, FloatArray]
    entries: Mapping[str, FloatArray]
    bolts: tuple[tuple[Point, str, float, FloatArray], ...]
    flexibility_m_per_n: FloatArray


def rigid_body(casing: Casing, places_m: Mapping[str, Point], angle_rad: float) -> Body:
    """Return a casing with the translations x_c along, y_c across and the rocking φ_c, turned by an angle.

    `places_m`: bearings of every shaft -> where it stands, that of the first pinion as `casing` has it.
    x_c and y_c run as the gears' x and y; a force on the casing beside its bearings acts at its centre of gravity.
    """
    seats = _motions({"pinion_bearing": casing.pinion_place_m, **places_m}, angle_rad)
    sensors = {f"casing_{name}": place for name, place in casing.sensor_places_m.items()}
    return Body(
        inertias={"x_c": casing.mass_kg, "y_c": casing.mass_kg, "phi_c": casing.inertia_kg_m2},
        supports=bolt_elements(casing, angle_rad),
        seats=seats,
        motions={**seats, **_motions(sensors, angle_rad)},
        entries=_motions({"auxiliary_drive": (0.0, 0.0)}, angle_rad),
        base={name: {base: 1.0} for name, base in zip(("x_c", "y_c", "phi_c"), BASE, strict=True)},
    )


def modal_body(modal: ModalBody, angle_rad: float) -> Body:
    """Return the lowest modes of a box as coordinates η_1 ... η_n."""
    names = tuple(f"{MODE}{r + 1}" for r in range(modal.frequency_hz.size))
    omega = 2.0 * np.pi * modal.frequency_hz
    supports = (
        Element({name: 1.0}, float(w * w), float(2.0 * ratio * w))
        for name, w, ratio in zip(names, omega, modal.damping_ratio, strict=True)
    )

    def rows(shapes: Mapping[str, FloatArray]) -> dict[str, Row]:
        return {place: dict(zip(names, shape.tolist(), strict=True)) for place, shape in shapes.items()}

    taken = np.zeros((len(names), len(BASE)))
    for place, axis, stiffness, shape in modal.bolts:
        motion = on_body(place, axis, angle_rad, BASE)
        taken += np.outer(stiffness * shape / (omega * omega), [motion[name] for name in BASE])
    return Body(
        inertias=dict.fromkeys(names, 1.0),
        supports=tuple(supports),
        seats=rows(modal.seats),
        motions=rows(modal.motions),
        entries=rows(modal.entries),
        base={name: dict(zip(BASE, row.tolist(), strict=True)) for name, row in zip(names, taken, strict=True)},
        flexibility_m_per_n=modal.flexibility_m_per_n,
    )


def renamed(body: Body, names: Mapping[str, str]) -> Body:
    """Return a body with other names of its coordinates."""

    def row(entries: Row) -> Row:
        return {names.get(name, name): value for name, value in entries.items()}

    def rows(named: Mapping[str, Row]) -> Mapping[str, Row]:
        return {key: row(one) for key, one in named.items()}

    return replace(
        body,
        inertias=row(body.inertias),
        supports=tuple(replace(one, direction=row(one.direction)) for one in body.supports),
        seats=rows(body.seats),
        motions=rows(body.motions),
        entries=rows(body.entries),
        base={names.get(name, name): one for name, one in body.base.items()},
    )


def bolt_elements(casing: Casing, angle_rad: float) -> tuple[Element, ...]:
    """Return the bolts as springs on the casing; c = 2 ζ √(k m_c/bolts)."""
    bolts = casing.bolts
    numbers = {"horizontal": bolts.shear_stiffness_n_per_m, "vertical": bolts.axial_stiffness_n_per_m}
    share = casing.mass_kg / len(bolts.places_m)
    left = (bolts.loose_share, *(1.0 for _ in bolts.places_m[1:]))
    return tuple(
        Element(on_body(place, axis, angle_rad), part * k, float(2.0 * bolts.damping_ratio * np.sqrt(part * k * share)))
        for place, part in zip(bolts.places_m, left, strict=True)
        for axis, k in numbers.items()
    )


def axis_vector(axis: str, angle_rad: float) -> Point:
    """Return the (x, y) components of the horizontal or the vertical unit vector."""
    sine, cosine = float(np.sin(angle_rad)), float(np.cos(angle_rad))
    return (cosine, -sine) if axis == "horizontal" else (sine, cosine)


def on_body(
    place_m: Point, axis: str, angle_rad: float, names: tuple[str, str, str] = ("x_c", "y_c", "phi_c")
) -> dict[str, float]:
    """Return the motion of a point of a rigid body along an axis: (x - Y φ, y + X φ) · u."""
    u, (h, v) = axis_vector(axis, angle_rad), place_m
    # Arm of the axis about the centre of gravity, X u_y - Y u_x; it does not depend on the frame.
    arm = -v if axis == "horizontal" else h
    return dict(zip(names, (u[0], u[1], arm), strict=True))


def _motions(places_m: Mapping[str, Point], angle_rad: float) -> dict[str, Row]:
    return {
        f"{name}/{axis}": on_body(place, axis, angle_rad) for name, place in places_m.items() for axis in DIRECTIONS
    }
