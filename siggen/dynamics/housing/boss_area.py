"""Points over bosses and bores of a wall, for sums over their areas.

Gauss's rule along every ray from a shaft's middle, even steps around. A ray ends where another boss begins, so that
every sum converges as fast as that over one ring. What a bore takes away must not exceed what the wall has there for
any motion: with too few points it does, and the wall is no body any more.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.dynamics.housing.box import Seat
from siggen.dynamics.housing.line_functions import gauss_points
from siggen.dynamics.housing.plate_energy import Area


def bore_area(seat: Seat, points_per_m: float) -> Area:
    """Return points of a bore; `points_per_m` are what a line of the wall needs for the square of a function."""
    return _ring(seat, 0.0, seat.bore_radius_m, (), points_per_m)


def boss_area(seat: Seat, others: Iterable[Seat], points_per_m: float) -> Area:
    """Return points of a boss; where bosses meet, each point belongs to the one whose middle is relatively nearer."""
    return _ring(seat, seat.bore_radius_m, seat.boss_radius_m, tuple(others), points_per_m)


def _ring(seat: Seat, inner_m: float, outer_m: float, others: tuple[Seat, ...], points_per_m: float) -> Area:
    angles, radii = (2 + int(np.ceil(points_per_m * way)) for way in (2.0 * np.pi * outer_m, outer_m - inner_m))
    angle = 2.0 * np.pi * (np.arange(angles) + 0.5) / angles
    shared = [border for other in others for border in _borders(seat, other, angle)]
    ends = np.sort(np.clip([np.full(angles, inner_m), *shared, np.full(angles, outer_m)], inner_m, outer_m), axis=0)
    place, share = gauss_points(0.0, 1.0, radii)
    length = np.diff(ends, axis=0)[..., None]
    radius, weight = ends[:-1, :, None] + length * place, length * share * 2.0 * np.pi / angles
    first, second = seat.x_m + radius * np.cos(angle)[:, None], seat.y_m + radius * np.sin(angle)[:, None]
    own = (weight > 0.0) & _nearest(seat, others, first, second)
    return Area(first[own], second[own], (weight * radius)[own])


def _nearest(seat: Seat, others: tuple[Seat, ...], x_m: FloatArray, y_m: FloatArray) -> NDArray[np.bool_]:
    def distance(of: Seat) -> FloatArray:
        return np.asarray(np.hypot(x_m - of.x_m, y_m - of.y_m) / of.boss_radius_m)

    own, nearest = distance(seat), np.full(x_m.shape, True)
    for other in others:
        nearest &= own <= distance(other)
    return nearest


def _borders(seat: Seat, other: Seat, angle: FloatArray) -> FloatArray:
    """Return where rays from a seat are relatively as near to another, (2, angles); infinite: nowhere.

    r² / R² = (r² - 2 b r + d²) / R'², with b the part of the distance d along the ray.
    """
    x, y = other.x_m - seat.x_m, other.y_m - seat.y_m
    along, apart = x * np.cos(angle) + y * np.sin(angle), x * x + y * y
    a = (other.boss_radius_m / seat.boss_radius_m) ** 2 - 1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        # a r² + 2 b r - d² = 0, in the form that holds for bosses alike (a = 0) too.
        root = np.sqrt(along * along + a * apart)
        radii = np.array([apart / (along + root), apart / (along - root)])
    return np.where(np.isfinite(radii) & (radii > 0.0), radii, np.inf)
