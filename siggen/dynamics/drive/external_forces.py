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
    return _on_shaft(structure, bearing_direction(structure, place, axis))


def turning_sense(structure: Structure, place: str) -> float:
    """Return +1 if the shaft at a bearing turns from horizontal to vertical, -1 if back (derived).

    With g along the line of action and w the direction in which flanks slide positively, both in the plane of the
    coordinates, a point of the pinion's flank at arm s slides by s Ω along w: so w is g turned by a quarter in the
    sense of the pinion. Every shaft behind turns the other way than the one in front.
    """
    rows = [structure.coordinates.index(name) for name in ("x_1", "y_1")]
    along, across = structure.mesh.vector[rows], structure.mesh.sliding[0][rows]
    first, *_ = places = list(dict.fromkeys(name.split("/")[0] for name in structure.bearing_directions))
    horizontal, vertical = shaft_directions(structure, first)[:, rows]
    pinion = np.sign(_cross(along, across)) * np.sign(_cross(horizontal, vertical))
    return float(-pinion if places.index(place) % 2 else pinion)


def _cross(first: FloatArray, second: FloatArray) -> float:
    return float(first[0] * second[1] - first[1] * second[0])


def _on_shaft(structure: Structure, values: FloatArray) -> FloatArray:
    """Return a vector (n,) with its entries at shifts of gears alone."""
    at_rotor = [name[:2] in {"x_", "y_"} and name[2:].isdigit() for name in structure.coordinates]
    return np.where(at_rotor, values, 0.0)
