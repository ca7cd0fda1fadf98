"""Motion: what a sensor, a bearing or a bolt sees of a housing; forces act on it by the same numbers.

A motion is a row of numbers for either half of the modes. The displacement is row · coordinates, the load of a unit
force the row itself, so forces and motions are reciprocal and the sum of works is right.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.housing.box import SIDES, Axis, Bolt, Seat, plane_axes
from siggen.dynamics.housing.box_energy import bolt_rows
from siggen.dynamics.housing.half_functions import HalfFunctions

RIM_POINTS = 16
"""Points around a bore; their means are exact for all that varies less than 16 times around it."""


class WallMotion(NamedTuple):
    """Rows (coordinates,) of both halves: walls that move alike, and against each other."""

    even: FloatArray
    odd: FloatArray

    def plus(self, other: WallMotion, factor: float = 1.0) -> WallMotion:
        """Return this motion and a multiple of another together: a pair of forces, a relative motion."""
        return WallMotion(self.even + factor * other.even, self.odd + factor * other.odd)


@dataclass(frozen=True, slots=True)
class PlatePlace:
    """A place on a plate, at distances [m] along its two axes in order, and the direction of motion."""

    plate: str
    first_m: float
    second_m: float
    direction: Axis


def motion_at(halves: tuple[HalfFunctions, HalfFunctions], place: PlatePlace) -> WallMotion:
    """Return the motion of a place of the middle surface.

    Raises
    ------
    ValueError
        If the place lies beyond the plate's edges.
    """
    axes = plane_axes(SIDES[place.plate][0])
    at = (place.first_m, place.second_m)
    size = tuple(halves[0].size_m[axis] for axis in axes)
    if not all(0.0 <= distance <= length for distance, length in zip(at, size, strict=True)):
        raise ValueError(f"{place.plate}: received a place at {at} m; allowed: 0 to {size} m")
    even, odd = (_at(half, place)[0] for half in halves)
    return WallMotion(even, odd)


def seat_motions(halves: tuple[HalfFunctions, HalfFunctions], seat: Seat, wall: str) -> dict[str, WallMotion]:
    """Return the motions of a bearing in its seat in the front or back wall: x, y, z and the slopes along x and y.

    The rim of the bore moves the bearing as its mean. Radial motion is that of the bearing's middle, which overhangs:
    its force has a moment about the wall. The force of a slope is a moment: `slope_x` turns about y.
    """
    found = [_seat_rows(half, seat, wall) for half in halves]
    return {name: WallMotion(found[0][name], found[1][name]) for name in found[0]}


def bolt_motions(halves: tuple[HalfFunctions, HalfFunctions], bolt: Bolt) -> dict[str, WallMotion]:
    """Return the motions along x, y, z of the floor at a bolt (front half) and at its mirror image."""
    even, odd = (bolt_rows(bolt, half) for half in halves)
    found = {}
    for axis in Axis:
        mirrored = [half.mirror_sign(axis) for half in halves]
        found[f"front/{axis.name.lower()}"] = WallMotion(even[axis], odd[axis])
        found[f"back/{axis.name.lower()}"] = WallMotion(mirrored[0] * even[axis], mirrored[1] * odd[axis])
    return found


def _at(half: HalfFunctions, place: PlatePlace) -> FloatArray:
    plate, sign = place.plate, 1.0
    if plate == "back":
        plate, sign = "front", half.mirror_sign(place.direction)
    tables = half.tables(plate, (np.array([place.first_m]), np.array([place.second_m])))
    return sign * half.rows(tables, place.direction)


def _seat_rows(half: HalfFunctions, seat: Seat, wall: str) -> dict[str, FloatArray]:
    angle = 2.0 * np.pi * (np.arange(RIM_POINTS) + 0.5) / RIM_POINTS
    cosine, sine, radius = np.cos(angle), np.sin(angle), seat.bore_radius_m
    places = seat.x_m + radius * cosine, seat.y_m + radius * sine
    tables = half.tables("front", places)
    signs = [half.mirror_sign(axis) if wall == "back" else 1.0 for axis in Axis]
    x, y, z = (sign * half.rows(tables, axis) for axis, sign in zip(Axis, signs, strict=True))
    # Plane through the rim by least squares: mean of w cos over that of cos², 1/2.
    slopes = [2.0 / radius * (share[:, None] * z).mean(axis=0) for share in (cosine, sine)]
    outwards = seat.overhang_m if wall == "back" else -seat.overhang_m
    return {
        "x": x.mean(axis=0) - outwards * slopes[0],
        "y": y.mean(axis=0) - outwards * slopes[1],
        "z": z.mean(axis=0),
        "slope_x": slopes[0],
        "slope_y": slopes[1],
    }
