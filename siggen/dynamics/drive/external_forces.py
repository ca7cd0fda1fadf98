"""External forces on any body that come with the rotation: unbalance.

Equations: centrifugal and tangential inertia of an eccentric mass, -m d²/dt² [e (cos Θ, sin Θ)] (derived). Angles are
those of the pinion times an order, so the gear's shaft has the order z_1/z_2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.drive.drive import Turning
from siggen.dynamics.drive.excitation import InputSource
from siggen.dynamics.structure.drivetrain import PLANE, Place
from siggen.dynamics.structure.structure import Structure


@dataclass(frozen=True, slots=True)
class Unbalance(InputSource):
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
    return np.array([shaft_direction(structure, f"{place}/{axis}") for axis in PLANE])


def shaft_direction(structure: Structure, name: str) -> FloatArray:
    """Return the generalised force (n,) of 1 N on the rotor at a bearing along an axis, by place/axis."""
    place, axis = name.split("/")
    bearing_direction(structure, place, axis)
    gears = structure.drivetrain.held[place]
    rows = [structure.drivetrain.row(Place(gear), axis) for gear in gears]
    return np.asarray(np.add.reduce(rows) / len(gears))


def bearing_places(structure: Structure) -> tuple[str, ...]:
    """Return what the bearings of each shaft that turns are called, in the order of power; a planet's pin is none."""
    machine = structure.drivetrain
    return tuple(place for place, gears in machine.held.items() if machine.turning[gears[0]] != 0.0)


def gear_directions(structure: Structure, gear: str) -> FloatArray:
    """Return the generalised forces (2, n) of 1 N on one gear, horizontal and vertical."""
    return np.array([structure.drivetrain.row(Place(gear), axis) for axis in PLANE])


def shaft_mass(structure: Structure, place: str) -> tuple[float, FloatArray]:
    """Return the mass [kg] that moves with a shaft at a bearing, and 1 N (2, n) that acts on each gear by its share."""
    rows = [gear_directions(structure, gear) for gear in structure.drivetrain.held[place]]
    masses = [float(row[0] @ structure.mass @ row[0]) for row in rows]
    whole = sum(masses)
    return whole, np.add.reduce([mass / whole * row for mass, row in zip(masses, rows, strict=True)])


def turning_sense(structure: Structure, place: str) -> float:
    """Return 1 if the shaft at a bearing turns from horizontal to vertical, -1 if back."""
    machine = structure.drivetrain
    gear = machine.held[place][0]
    return float(np.sign(machine.rigid(gear).sense * machine.turning[gear]))
