"""The matrix of Newton's method for the slices: a diagonal, exponentials of the distance, and three vectors."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from siggen.arrays import FloatArray, IntArray
from siggen.gears.contact.exponential_matrix import EXPONENTIALS, SIDES, solve_rows
from siggen.gears.contact.face_slices import FaceSlices


class SolverRoom(NamedTuple):
    """Arrays that the solver reuses, made by `solver_room`.

    `rows` (n,): slices that carry; `losses` (n,): how often a slice lost touch; `product`, `growth` (n,): K u and
    v = (dK/d ln a) u; `diagonal` (n,); `right` (n, 4): right sides residual, 1, u, v, then the solutions; `steps`,
    `factors`: of `solve_rows`; `strength`, `strength_slope` (m,): of the kernel.
    """

    rows: IntArray
    losses: IntArray
    product: FloatArray
    diagonal: FloatArray
    right: FloatArray
    growth: FloatArray
    steps: FloatArray
    factors: FloatArray
    strength: FloatArray
    strength_slope: FloatArray


def solver_room(slices: int) -> SolverRoom:
    """Return room for faces of so many slices."""
    return SolverRoom(
        rows=np.zeros(slices, np.int64),
        losses=np.zeros(slices, np.int64),
        product=np.zeros(slices),
        diagonal=np.zeros(slices),
        right=np.zeros((slices, SIDES)),
        growth=np.zeros(slices),
        steps=np.zeros((slices, EXPONENTIALS)),
        factors=np.zeros((slices, EXPONENTIALS + 1)),
        strength=np.zeros(EXPONENTIALS),
        strength_slope=np.zeros(EXPONENTIALS),
    )


@njit(cache=True)
def solve_local(slices: FaceSlices, room: SolverRoom, chosen: int) -> bool:
    """Solve for the four right sides with the local part of the matrix."""
    if slices.kernel.coupled:
        return solve_rows(
            slices.kernel.decay, room.strength, room.diagonal, room.rows, chosen, room.right, room.steps, room.factors
        )
    for n in range(chosen):
        i = room.rows[n]
        if room.diagonal[i] <= 0.0:
            return False
        for side in range(SIDES):
            room.right[i, side] /= room.diagonal[i]
    return True


@njit(cache=True)
def add_low_rank(
    slices: FaceSlices, room: SolverRoom, chosen: int, loads: FloatArray, square: float, slope: float, bend: float
) -> tuple[float, float, float]:
    """Add what C and the growth of a with the load do to the solution; return the largest step, dF/dd and dM/dd.

    With v = (dK/d ln a) u the matrix gains c 1 1ᵀ + p (v uᵀ + u vᵀ) - p (s - ¼ s') u uᵀ, p = 1/(2 u·u), s = u·v/u·u
    (`slope`), s' = u·(d²K/d(ln a)²)u/u·u, of which `bend` is all but a part that an even load does not have.
    """
    per_load = slices.kernel.cell_m / slices.kappa_per_pa
    c = slices.compliance_m_per_n * per_load
    p = 0.5 / square
    gram = np.zeros((3, SIDES))
    for n in range(chosen):
        i = room.rows[n]
        for side in range(SIDES):
            gram[0, side] += room.right[i, side]
            gram[1, side] += loads[i] * room.right[i, side]
            gram[2, side] += room.growth[i] * room.right[i, side]
    # x = z_b - z_1 c (1·x) - z_u (p (v·x) - p s (u·x)) - z_v p (u·x); unknown are 1·x, u·x, v·x
    matrix = np.zeros((3, 3))
    sides = np.zeros((3, 2))
    for j in range(3):
        matrix[j, 0] = c * gram[j, 1]
        matrix[j, 1] = p * (gram[j, 3] - (slope - 0.25 * bend) * gram[j, 2])
        matrix[j, 2] = p * gram[j, 2]
        matrix[j, j] += 1.0
        sides[j, 0] = gram[j, 0]
        sides[j, 1] = gram[j, 1]
    _solve_three(matrix, sides)
    # first the step, then the answer to a unit approach
    weights = np.zeros((3, 2))
    for k in range(2):
        weights[0, k] = c * sides[0, k]
        weights[1, k] = p * (sides[2, k] - (slope - 0.25 * bend) * sides[1, k])
        weights[2, k] = p * sides[1, k]
    largest, turning = 0.0, 0.0
    for n in range(chosen):
        i = room.rows[n]
        one, load, growth = room.right[i, 1], room.right[i, 2], room.right[i, 3]
        room.right[i, 0] -= weights[0, 0] * one + weights[1, 0] * load + weights[2, 0] * growth
        largest = max(largest, abs(room.right[i, 0]))
        turning += slices.face_m[i] * ((1.0 - weights[0, 1]) * one - weights[1, 1] * load - weights[2, 1] * growth)
    return largest, per_load * sides[0, 1], per_load * turning


@njit(cache=True)
def _solve_three(matrix: FloatArray, sides: FloatArray) -> None:
    """Solve three equations for two right sides in place, by elimination with pivots (LAPACK would cost more)."""
    for j in range(3):
        best = j
        for k in range(j + 1, 3):
            if abs(matrix[k, j]) > abs(matrix[best, j]):
                best = k
        for k in range(3):
            matrix[j, k], matrix[best, k] = matrix[best, k], matrix[j, k]
        for k in range(2):
            sides[j, k], sides[best, k] = sides[best, k], sides[j, k]
        for i in range(3):
            if i != j:
                ratio = matrix[i, j] / matrix[j, j]
                for k in range(j, 3):
                    matrix[i, k] -= ratio * matrix[j, k]
                for k in range(2):
                    sides[i, k] -= ratio * sides[j, k]
    for j in range(3):
        for k in range(2):
            sides[j, k] /= matrix[j, j]
