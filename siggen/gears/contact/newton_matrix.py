"""The matrix of Newton's method for the slices: a diagonal, decaying terms of the distance, and three vectors."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import njit
from siggen.gears.contact.exponential_matrix import EXPONENTIALS, RowMatrix, solve_rows
from siggen.gears.contact.face_slices import FaceSlices
from siggen.lanes import LANES, extract, load, splat


class SolverRoom(NamedTuple):
    """Arrays that the solver reuses, made by `solver_room`.

    `rows` (n,): slices that carry; `losses` (n,): how often a slice lost touch; `product`, `growth` (n,): K u and
    v = (dK/d ln a) u; `diagonal` (n,); `right` (n, LANES): right sides residual, 1, u, v, y, then the solutions;
    `rigid_m` (n,): sinks without load; `steps`, `factors`: of `solve_rows`; `strength`, `strength_slope` (m,): of the
    kernel; `matrix`, `sides` (3, 3): of the three vectors; `loads`, `before` (n,): of a curve, at two places of it.
    """

    rows: IntArray
    losses: IntArray
    product: FloatArray
    diagonal: FloatArray
    right: FloatArray
    growth: FloatArray
    rigid_m: FloatArray
    steps: FloatArray
    factors: FloatArray
    strength: FloatArray
    strength_slope: FloatArray
    matrix: FloatArray
    sides: FloatArray
    loads: FloatArray
    before: FloatArray


def solver_room(slices: int) -> SolverRoom:
    """Return room for faces of so many slices."""
    return SolverRoom(
        rows=np.zeros(slices, np.int64),
        losses=np.zeros(slices, np.int64),
        product=np.zeros(slices),
        diagonal=np.zeros(slices),
        right=np.zeros((slices, LANES)),
        growth=np.zeros(slices),
        rigid_m=np.zeros(slices),
        steps=np.zeros((slices, LANES)),
        factors=np.zeros((slices, LANES)),
        strength=np.zeros(EXPONENTIALS),
        strength_slope=np.zeros(EXPONENTIALS),
        matrix=np.zeros((3, 3)),
        sides=np.zeros((3, 3)),
        loads=np.zeros(slices),
        before=np.zeros(slices),
    )


@njit(cache=True, _nrt=False, error_model="numpy")
def solve_local(slices: FaceSlices, room: SolverRoom, chosen: int) -> bool:
    """Solve for the five right sides with the matrix but for its three vectors; False if not positive definite."""
    teeth = slices.teeth
    matrix = RowMatrix(slices.kernel.decay, room.strength, teeth.strength, teeth.decay, room.diagonal)
    return solve_rows(matrix, room.rows, chosen, room.right, room.steps, room.factors)


class Answers(NamedTuple):
    """Largest step of a load [m], dF/dd [N/m], dM/dd = dF/dθ [N] and dM/dθ [N m]."""

    step_m: float
    stiffness_n_per_m: float
    turning_n: float
    tilting_n_m: float


@njit(cache=True, _nrt=False, error_model="numpy")
def add_low_rank(
    slices: FaceSlices, room: SolverRoom, chosen: int, loads: FloatArray, square: float, slope: float, bend: float
) -> Answers:
    """Add what C and the growth of a with the load do to the solution; return the step and what answers to d and θ.

    With v = (dK/d ln a) u the matrix gains c 1 1ᵀ + p (v uᵀ + u vᵀ) - p (s - ¼ s') u uᵀ, p = 1/(2 u·u), s = u·v/u·u
    (`slope`), s' = u·(d²K/d(ln a)²)u/u·u, of which `bend` is all but a part that an even load does not have.
    """
    per_load = slices.kernel.cell_m / slices.kappa_per_pa
    c = slices.compliance_m_per_n * per_load
    p = 0.5 / square
    ones, by_load, by_growth, along = splat(0.0), splat(0.0), splat(0.0), splat(0.0)
    rows, right, growth, face = room.rows, room.right, room.growth, slices.face_m
    for n in range(chosen):
        i = rows[n]
        sides = load(right, i * LANES)
        ones = ones + sides
        by_load = by_load + loads[i] * sides
        by_growth = by_growth + growth[i] * sides
        along = along + face[i] * sides
    # x = z_b - z_1 c (1·x) - z_u (p (v·x) - p s (u·x)) - z_v p (u·x); unknown are 1·x, u·x, v·x
    matrix, sides = room.matrix, room.sides
    for j, sums in enumerate((ones, by_load, by_growth)):
        matrix[j, 0] = c * extract(sums, 1)
        matrix[j, 1] = p * (extract(sums, 3) - (slope - 0.25 * bend) * extract(sums, 2))
        matrix[j, 2] = p * extract(sums, 2)
        matrix[j, j] += 1.0
        # first the step, then the answers to a unit approach and to a unit tilt
        sides[j, 0], sides[j, 1], sides[j, 2] = extract(sums, 0), extract(sums, 1), extract(sums, 4)
    _solve_three(matrix, sides)
    weights = matrix  # of no use any more
    for k in range(3):
        weights[0, k] = c * sides[0, k]
        weights[1, k] = p * (sides[2, k] - (slope - 0.25 * bend) * sides[1, k])
        weights[2, k] = p * sides[1, k]
    largest = 0.0
    for n in range(chosen):
        i = rows[n]
        right[i, 0] -= weights[0, 0] * right[i, 1] + weights[1, 0] * right[i, 2] + weights[2, 0] * right[i, 3]
        largest = max(largest, abs(right[i, 0]))
    of_1, of_u, of_v = extract(along, 1), extract(along, 2), extract(along, 3)
    turning = of_1 - weights[0, 1] * of_1 - weights[1, 1] * of_u - weights[2, 1] * of_v
    tilting = extract(along, 4) - weights[0, 2] * of_1 - weights[1, 2] * of_u - weights[2, 2] * of_v
    return Answers(largest, per_load * sides[0, 1], per_load * turning, per_load * tilting)


@njit(cache=True, _nrt=False, error_model="numpy")
def _solve_three(matrix: FloatArray, sides: FloatArray) -> None:
    """Solve three equations for three right sides in place, by elimination with pivots (LAPACK would cost more)."""
    for j in range(3):
        best = j
        for k in range(j + 1, 3):
            if abs(matrix[k, j]) > abs(matrix[best, j]):
                best = k
        for k in range(3):
            matrix[j, k], matrix[best, k] = matrix[best, k], matrix[j, k]
        for k in range(3):
            sides[j, k], sides[best, k] = sides[best, k], sides[j, k]
        for i in range(3):
            if i != j:
                ratio = matrix[i, j] / matrix[j, j]
                for k in range(j, 3):
                    matrix[i, k] -= ratio * matrix[j, k]
                for k in range(3):
                    sides[i, k] -= ratio * sides[j, k]
    for j in range(3):
        for k in range(3):
            sides[j, k] /= matrix[j, j]
