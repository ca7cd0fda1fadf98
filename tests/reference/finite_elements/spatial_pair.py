"""One tooth pair in three dimensions at a force: extruded finite-element teeth, pressure cells for their contact.

The teeth are those of `face_compliance`, the contact is that of a cylinder on half spaces (`reference.contact`); both
know the same datum, the tooth's centre line, so their deflections add. Nothing of `siggen.mesh` is used.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import radians, sqrt

import numpy as np

from siggen.gears.gear_pair import GearPair, SpurGear
from tests.reference.contact.face_contact import FaceCase, _gradients, _Operator

REACH = 8.0
"""Half width of the grid in Hertz half widths of the whole face."""


@dataclass(frozen=True, slots=True)
class SpatialPair:
    """Approach [m], moment about the middle of the face [N m], and line load (k,) [N/m] of a pair at a force."""

    approach_m: float
    moment_nm: float
    line_load: np.ndarray


def bench_pair() -> GearPair:
    """Return the 18/47 pair of bench without errors."""
    gears = [SpurGear(z, 3e-3, radians(20.0), 0.0, 1.0, 0.25, b, body_ratio=1.0) for z, b in ((18, 10e-3), (47, 15e-3))]
    return GearPair(gears[0], gears[1], face_width_m=0.02, youngs_modulus_pa=206e9, poisson_ratio=0.3)


class _TeethOperator(_Operator):
    """Contact and teeth together; `teeth` (columns, columns) [m/N] from cell to cell across the face."""

    def __init__(self, case: FaceCase, dx: float, rows: int, teeth: np.ndarray) -> None:
        super().__init__(case, dx, rows, len(teeth))
        self.teeth = teeth

    def __call__(self, load: np.ndarray) -> np.ndarray:
        return super().__call__(load) + (self.teeth @ load.sum(axis=0))[None, :]


def spatial_pair(
    case: FaceCase,
    teeth: np.ndarray,
    land: np.ndarray,
    lead: np.ndarray,
    force_n: float,
    radius_m: np.ndarray | None = None,
) -> SpatialPair:
    """Return the pair of which the cells `land` (k,) carry and lack `lead` (k,) [m] of material.

    Parameters
    ----------
    case : FaceCase
        Contact and grid.
    teeth : (k, k) array
        How both teeth give way from cell to cell, without their contact [m/N].
    land : (k,) bool array
        Cells across the face that carry.
    lead : (k,) array
        Missing material [m].
    force_n : float
        Normal force of the pair.
    radius_m : (k,) array, optional
        Relative radii of curvature of the cells instead of the case's one [m].

    Raises
    ------
    RuntimeError
        If the gradients do not converge, or the pressure reaches the grid's rim.
    """
    width = sqrt(2.0 * case.radius_m * case.kappa * force_n / case.face_width_m)
    dx = width / case.cells_per_width
    count = 2 * int(REACH * case.cells_per_width) + 1
    x = (np.arange(count) - count // 2) * dx
    gap = (x * x)[:, None] / (2.0 * (case.radius_m if radius_m is None else radius_m)) + lead[None, :]
    operator = _TeethOperator(case, dx, count, teeth)
    load = _gradients(operator, gap, np.broadcast_to(land[None, :], gap.shape), force_n)
    if load[0].any() or load[-1].any():
        raise RuntimeError(f"pressure reaches the rim of the grid; allowed: a REACH above {REACH}")
    touched = load > 0.0
    across = load.sum(axis=0)
    y = (np.arange(land.size) + 0.5) * case.cell_m - 0.5 * case.face_width_m
    return SpatialPair(float(np.mean((operator(load) + gap)[touched])), float(across @ y), across / case.cell_m)
