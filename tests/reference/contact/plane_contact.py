"""Plane contact of a rigid parabola with an interrupted elastic surface, by pressure cells and a convex programme.

Independent of `siggen.mesh`: piecewise constant pressures, displacements averaged over the cells (so that the
influence matrix is symmetric), and the least complementary energy under "pressures never pull", found by an active set.
Nothing is assumed about where the contact ends or how the pressure grows towards an edge.

Lengths may have any unit; pressures times κ = 2/(π E*) are dimensionless. A plane displacement has no datum: the
approach is counted from the length `DATUM`, and the sink is its difference to Hertz's contact with the same force.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log, sqrt

import numpy as np

DATUM = 1e3
"""Length in half widths at which displacements count as zero; drops out of every sink."""
FAR = 30.0
"""Cells further apart than this many widths act by their moments: exact differences would lose digits there."""


@dataclass(frozen=True, slots=True)
class PlaneContact:
    """Solution: approach and the load of every cell, both times κ, and the cells' ends [same unit]."""

    approach: float
    load: np.ndarray
    ends: np.ndarray

    def share(self, side: np.ndarray) -> float:
        """Return the part of the force on the cells of a mask."""
        return float(self.load[side].sum() / self.load.sum())


def log_influence(ends: np.ndarray, datum: float) -> np.ndarray:
    """Return mean displacements (k, k) of cells (k, 2) under unit loads on others, times 1/κ: means of ln(datum/r)."""
    low, high = ends[:, 0], ends[:, 1]
    width, middle = high - low, 0.5 * (low + high)
    r = np.abs(middle[:, None] - middle[None, :])
    widest = np.maximum(width[:, None], width[None, :])
    near = r < FAR * widest
    safe = np.where(near, 1.0, r)
    mean = np.log(safe) - (width[:, None] ** 2 + width[None, :] ** 2) / (24.0 * safe**2)
    i, j = np.nonzero(near)
    exact = (
        _second(high[i] - low[j]) - _second(low[i] - low[j]) - _second(high[i] - high[j]) + _second(low[i] - high[j])
    )
    mean[i, j] = exact / (width[i] * width[j])
    return log(datum) - mean


def _second(t: np.ndarray) -> np.ndarray:
    """Second antiderivative of ln|t|."""
    square = t * t
    return 0.5 * square * np.log(np.where(t == 0.0, 1.0, np.abs(t))) - 0.75 * square


def least_energy(matrix: np.ndarray, gap: np.ndarray, force: float) -> tuple[float, np.ndarray]:
    """Return approach and loads (k,) >= 0 of sum `force` with least ½ p·A p + p·gap.

    Raises
    ------
    RuntimeError
        If the active set does not settle.
    """
    active = np.ones(gap.size, dtype=bool)
    for _ in range(500):
        index = np.flatnonzero(active)
        block = np.ones((index.size + 1, index.size + 1))
        block[:-1, :-1] = matrix[np.ix_(index, index)]
        block[-1, -1] = 0.0
        block[:-1, -1] = -1.0
        solution = np.linalg.solve(block, np.append(-gap[index], force))
        load = np.zeros(gap.size)
        load[index] = solution[:-1]
        approach = float(solution[-1])
        pulling = load < 0.0
        if pulling.any():
            # all at once: what leaves too early comes back by its overlap
            active &= ~pulling
            continue
        overlap = approach - gap - matrix @ load
        entering = ~active & (overlap > 1e-12 * abs(approach))
        if not entering.any():
            return approach, load
        active |= entering
    raise RuntimeError("the active set did not settle within 500 passes")


def land_cells(edge: float, reach: float, finest: float, widest: float, growth: float = 1.15) -> np.ndarray:
    """Return cells (k, 2) from an edge to `edge + reach` (to the left if negative), growing from `finest`."""
    widths = [finest]
    while sum(widths) < abs(reach):
        widths.append(min(widths[-1] * growth, widest))
    marks = np.concatenate([[0.0], np.cumsum(widths)])
    if reach > 0:
        return edge + np.column_stack([marks[:-1], marks[1:]])
    return (edge - np.column_stack([marks[1:], marks[:-1]]))[::-1]


def cells_beside_gap(offset: float, length: float, half_width: float, *, right: bool, left: bool = True) -> np.ndarray:
    """Return the cells (k, 2) on the lands beside a gap from -length/2 to length/2 for a normal at `offset`."""
    finest, widest = 1e-5 * half_width, half_width / 40.0
    parts = []
    if left:
        parts.append(land_cells(-0.5 * length, -(max(-0.5 * length - offset, 0.0) + 1.5 * half_width), finest, widest))
    if right:
        parts.append(land_cells(0.5 * length, max(offset - 0.5 * length, 0.0) + 1.5 * half_width, finest, widest))
    return np.vstack(parts)


def solve_cells(
    ends: np.ndarray,
    offset: float,
    radius: float,
    load_kappa: float,
    extra: np.ndarray | None = None,
    rounding: np.ndarray | None = None,
) -> PlaneContact:
    """Return the contact of a parabola of `radius` with its normal at `offset` on cells (k, 2).

    `load_kappa` is κF; `extra` (k, k) adds to the influence of the half planes (times 1/κ); `rounding` (k,) to the gap.
    """
    half_width = sqrt(2.0 * radius * load_kappa)
    unit = ends / half_width
    matrix = log_influence(unit, DATUM)
    if extra is not None:
        matrix = matrix + extra
    low, high = unit[:, 0] - offset / half_width, unit[:, 1] - offset / half_width
    # mean of x²/(2R) over a cell, over κF = a²/(2R)
    gap = (low * low + low * high + high * high) / 3.0
    if rounding is not None:
        gap = gap + rounding / load_kappa
    approach, load = least_energy(matrix, gap, 1.0)
    return PlaneContact(approach * load_kappa, load * load_kappa, ends)


def sink(contact: PlaneContact) -> float:
    """Return the approach less Hertz's at the same force and datum (same unit as the cells)."""
    load_kappa = float(contact.load.sum())
    # Johnson, Contact Mechanics, section 5.6; the datum is counted in half widths
    return contact.approach - load_kappa * (log(2.0 * DATUM) + 0.5)


def gap_sink(offset: float, length: float, radius: float, load_kappa: float) -> tuple[float, float]:
    """Return the sink at `offset` from the middle of a gap, and the share of the left edge."""
    half_width = sqrt(2.0 * radius * load_kappa)
    contact = solve_cells(cells_beside_gap(offset, length, half_width, right=True), offset, radius, load_kappa)
    return sink(contact), contact.share(contact.ends[:, 1] <= 0.0)


def edge_sink(beyond: float, radius: float, load_kappa: float) -> float:
    """Return the sink of a contact whose land ends at the distance `beyond` (negative: before the normal)."""
    half_width = sqrt(2.0 * radius * load_kappa)
    ends = cells_beside_gap(-beyond, 0.0, half_width, right=False)
    return sink(solve_cells(ends, -beyond, radius, load_kappa))
