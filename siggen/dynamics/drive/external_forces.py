"""External forces on any body that come with the rotation: unbalance.

Equations: centrifugal and tangential inertia of an eccentric mass, -m d²/dt² [e (cos Θ, sin Θ)] (derived). Angles are
those of the pinion times an order, so the gear's shaft has the order z_1/z_2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.drive.drive import Turning
from siggen.dynamics.drive.excitation import Source
from siggen.dynamics.structure.structure import Structure

OF_SET = {"sun_bearing": "s", "carrier_bearing": "c"}
"""Bearings of the shafts of a planetary set, and how the coordinates of what they hold end."""


@dataclass(frozen=True, slots=True)
class Unbalance(Source):
    """An eccentric mass m e [kg m] on a shaft that turns at `order` times the pinion.

    `directions` (2, n) are unit forces along two axes at right angles; the shaft turns from the first to the second, or
    back if `order` is negative. At angle 0 the mass stands at `phase_rad` from the first.
    """

    directions: FloatArray
    moment_kg_m: float
    order: float
    phase_rad: float

    @property
    def vectors(self) -> FloatArray:
        """The directions (2, n)."""
        return self.directions

    def inputs(self, turning: Turning) -> FloatArray:
        """Return the forces (k, 2) [N]."""
        angle = self.order * turning.angle_rad + self.phase_rad
        outward = self.moment_kg_m * (self.order * turning.speed_rad_s) ** 2
        backward = self.moment_kg_m * self.order * turning.acceleration_rad_s2
        cosine, sine = np.cos(angle), np.sin(angle)
        return np.stack([outward * cosine + backward * sine, outward * sine - backward * cosine], axis=1)


def bearing_direction(structure: Structure, place: str, axis: str) -> FloatArray:
    """Return the generalised force (n,) of 1 N between a shaft and its seat: on the shaft along the axis, and back.

    Raises
    ------
    ValueError
        If the structure has no such bearing.
    """
    key = f"{place}/{axis}"
    if key not in structure.bearing_directions:
        allowed = ", ".join(structure.bearing_directions) or "none in a model of rotations alone"
        raise ValueError(f"bearing: received {key}; allowed are {allowed}")
    return structure.bearing_directions[key]


def shaft_directions(structure: Structure, place: str) -> FloatArray:
    """Return the generalised forces (2, n) of 1 N on the rotor at a bearing, horizontal and vertical."""
    return np.array([shaft_direction(structure, f"{place}/{axis}") for axis in ("horizontal", "vertical")])


def shaft_direction(structure: Structure, name: str) -> FloatArray:
    """Return the generalised force (n,) of 1 N on the rotor at a bearing along an axis, by place/axis."""
    place, axis = name.split("/")
    return _on_shaft(structure, place, bearing_direction(structure, place, axis))


def bearing_places(structure: Structure) -> tuple[str, ...]:
    """Return what the bearings of each shaft are called, in the order of power; of a planetary set sun and carrier."""
    if structure.frame:
        return tuple(OF_SET)
    return ("pinion_bearing", "gear_bearing", *(f"{mesh.name}_bearing" for mesh in structure.meshes[1:]))


def gear_directions(structure: Structure, place: str, gear: str) -> FloatArray:
    """Return the generalised forces (2, n) of 1 N on one gear of the shaft at a bearing, horizontal and vertical.

    Gears are counted from the first pinion, "1", in the order of power; an idler is one gear.
    """
    along = shaft_directions(structure, place)
    if len(_gears(structure, place)) == 1:
        return along
    own = [name in (f"x_{gear}", f"y_{gear}") for name in structure.coordinates]
    along = np.where(own, along, 0.0)
    return np.asarray(along / np.sqrt((along**2).sum(axis=1))[:, None])


def shaft_mass(structure: Structure, place: str) -> tuple[float, FloatArray]:
    """Return the mass [kg] of all gears of the shaft at a bearing, and 1 N (2, n) that acts on each by its share."""
    gears = _gears(structure, place)
    masses = [float(structure.mass[(structure.coordinates.index(f"x_{gear}"),) * 2]) for gear in gears]
    whole = sum(masses)
    shares = [m / whole * gear_directions(structure, place, gear) for m, gear in zip(masses, gears, strict=True)]
    return whole, np.add.reduce(shares)


def turning_sense(structure: Structure, place: str) -> float:
    """Return +1 if the shaft at a bearing turns from horizontal to vertical, -1 if back (derived).

    With g along the line of action and w the direction in which flanks slide positively, both in the plane of the
    coordinates, a point of the driving flank at arm s slides by s Ω along w: so w is g turned by a quarter in the
    sense of the driving gear. The driven gear turns the other way.
    """
    gear = _gears(structure, place)[0]
    mesh = next(one for one in structure.meshes if f"theta_{gear}" in one.turning)
    rows = [structure.coordinates.index(f"{axis}_{gear}") for axis in "xy"]
    along, across = mesh.vector[rows], mesh.sliding[0][rows]
    horizontal, vertical = shaft_directions(structure, place)[:, rows]
    driving = np.sign(_cross(along, across)) * np.sign(_cross(horizontal, vertical))
    return float(driving if f"theta_{gear}" == mesh.turning[0] else -driving)


def _cross(first: FloatArray, second: FloatArray) -> float:
    return float(first[0] * second[1] - first[1] * second[0])


def _gears(structure: Structure, place: str) -> tuple[str, ...]:
    """Return the gears on the shaft at a bearing: between two meshes a driven and a driving one; a carrier is one."""
    if structure.frame:
        return (OF_SET[place],)
    shaft, meshes = bearing_places(structure).index(place), structure.meshes
    driven = meshes[shaft - 1].turning[1:] if shaft > 0 else ()
    driving = meshes[shaft].turning[:1] if shaft < len(meshes) else ()
    return tuple(dict.fromkeys(gear_number(name) for name in (*driven, *driving)))


def gear_number(rotation: str) -> str:
    """Return the number of a gear by the coordinate in which it turns."""
    return rotation.removeprefix("theta_")


def _on_shaft(structure: Structure, place: str, values: FloatArray) -> FloatArray:
    """Return a vector (n,) with its entries at the gears of a shaft alone."""
    own = {f"{axis}_{gear}" for gear in _gears(structure, place) for axis in "xyz"}
    return np.where([name in own for name in structure.coordinates], values, 0.0)
