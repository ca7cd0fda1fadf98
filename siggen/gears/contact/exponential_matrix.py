"""Product and solution of a symmetric matrix that is a diagonal plus sums of decaying terms of the distance.

A_ij = d_i for i = j, Σ_m s_m r_m^|i-j| + p_i Π_{j < k <= i} q_k for i > j: exponentials of the distance, and one term
whose strength p and decay q belong to the rows (free ends make them so, see `tooth_kernel`). Product and solution take
a number of steps proportional to the size: such a matrix is semiseparable, and its factors L D Lᵀ stay so
(Foreman-Mackey et al. 2017, Astron. J. 154, 220, section 5.1, for real exponentials). Rows that are not chosen are
left out; distances count through them.

Terms, and right sides, are lanes of one register: what is not used of them stays 0.
"""

from __future__ import annotations

from typing import NamedTuple

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import entry, njit
from siggen.lanes import LANES, Lanes, extract, insert, load, shuffle, splat, store

EXPONENTIALS = 5
TERMS = EXPONENTIALS + 1
"""With the term whose strength and decay belong to the rows, the last one."""
INVERSE = TERMS
"""Where the inverse of the pivot stands beside the factors."""
_by_four, _by_two, _by_one = (shuffle(*((lane ^ k) for lane in range(LANES))) for k in (4, 2, 1))


@entry(cache=True, _nrt=False, error_model="numpy", fastmath={"contract"})
def products(
    decay: FloatArray,
    strength: FloatArray,
    slope: FloatArray,
    vector: FloatArray,
    out: FloatArray,
    slope_out: FloatArray,
) -> None:
    """Write the off-diagonal products of the exponentials with `strength` and with `slope` (m,) as s, (n,) each."""
    count, decays, strengths, slopes = vector.size, _five(decay), _five(strength), _five(slope)
    run = (0.0, 0.0, 0.0, 0.0, 0.0)
    out[0] = 0.0
    slope_out[0] = 0.0
    for i in range(1, count):
        run = _passed(decays, run, vector[i - 1])
        out[i] = _scalar(strengths, run)
        slope_out[i] = _scalar(slopes, run)
    run = (0.0, 0.0, 0.0, 0.0, 0.0)
    for i in range(count - 2, -1, -1):
        run = _passed(decays, run, vector[i + 1])
        out[i] += _scalar(strengths, run)
        slope_out[i] += _scalar(slopes, run)


Five = tuple[float, float, float, float, float]
"""A number of every exponential, in a register each."""


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _five(values: FloatArray) -> Five:
    return values[0], values[1], values[2], values[3], values[4]


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _passed(decay: Five, run: Five, value: float) -> Five:
    """Return the sums of all rows before the next one, behind a row with a value."""
    return (
        decay[0] * (run[0] + value), decay[1] * (run[1] + value), decay[2] * (run[2] + value),
        decay[3] * (run[3] + value), decay[4] * (run[4] + value),
    )  # fmt: skip


@njit(cache=True, _nrt=False, error_model="numpy", fastmath={"contract"}, forceinline=True)
def _scalar(left: Five, right: Five) -> float:
    """Return the scalar product, one after the other: the first sum is with 0, so that all are contracted alike."""
    total = 0.0
    total += left[0] * right[0]
    total += left[1] * right[1]
    total += left[2] * right[2]
    total += left[3] * right[3]
    total += left[4] * right[4]
    return total


@entry(cache=True, _nrt=False, error_model="numpy", fastmath={"contract", "reassoc"})
def add_row_products(row_strength: FloatArray, row_decay: FloatArray, vector: FloatArray, out: FloatArray) -> None:
    """Add the off-diagonal products of the term of the rows, p and q (n,), to `out` (n,)."""
    count = vector.size
    run = 0.0
    for i in range(1, count):
        run = row_decay[i] * (run + vector[i - 1])
        out[i] += row_strength[i] * run
    run = 0.0
    for i in range(count - 2, -1, -1):
        run = row_decay[i + 1] * (run + row_strength[i + 1] * vector[i + 1])
        out[i] += run


class RowMatrix(NamedTuple):
    """A matrix by its terms: decays and strengths of the exponentials (EXPONENTIALS,), of the rows (n,), its diagonal.

    `row_strength`, `row_decay` (n,): p and q of the term of the rows; `diagonal` (n,).
    """

    decay: FloatArray
    strength: FloatArray
    row_strength: FloatArray
    row_decay: FloatArray
    diagonal: FloatArray


@entry(cache=True, _nrt=False, error_model="numpy")
def solve_rows(
    matrix: RowMatrix, rows: IntArray, count: int, right: FloatArray, steps: FloatArray, work: FloatArray
) -> bool:
    """Solve A x = b for the chosen rows, in place of `right`; False if A is not positive definite.

    Parameters
    ----------
    matrix : RowMatrix
    rows : (>= count,)
        The chosen rows, ascending.
    right : (n, LANES)
        b at the chosen rows; x afterwards.
    steps : (n, LANES)
        Room: decay from the row before.
    work : (n, LANES)
        Room: the factors, and the pivots' inverse.
    """
    decay, strength, row_strength, row_decay, diagonal = matrix
    decays, own = _of_terms(decay), _of_terms(strength)
    own_0, own_1, own_2, own_3, own_4 = strength[0], strength[1], strength[2], strength[3], strength[4]
    # The sums of all rows before, `inner` of the matrix and `run` of the right sides, a row of lanes for each term.
    none = splat(0.0)
    inner_0, inner_1, inner_2, inner_3, inner_4, inner_5 = none, none, none, none, none, none
    run_0, run_1, run_2, run_3, run_4, run_5 = none, none, none, none, none, none
    w, b, last = none, none, 0.0  # of the row before
    for n in range(count):
        i = rows[n]
        own_5 = row_strength[i]
        if n > 0:
            step = insert(decays, EXPONENTIALS, row_decay[i])
            for k in range(rows[n - 1] + 1, i):
                step = step * insert(decays, EXPONENTIALS, row_decay[k])
            store(steps, i * LANES, step)
            added = last * w
            inner_0 = extract(step, 0) * (step * (inner_0 + extract(added, 0) * w))
            inner_1 = extract(step, 1) * (step * (inner_1 + extract(added, 1) * w))
            inner_2 = extract(step, 2) * (step * (inner_2 + extract(added, 2) * w))
            inner_3 = extract(step, 3) * (step * (inner_3 + extract(added, 3) * w))
            inner_4 = extract(step, 4) * (step * (inner_4 + extract(added, 4) * w))
            inner_5 = extract(step, 5) * (step * (inner_5 + extract(added, 5) * w))
            run_0 = extract(step, 0) * (run_0 + extract(w, 0) * b)
            run_1 = extract(step, 1) * (run_1 + extract(w, 1) * b)
            run_2 = extract(step, 2) * (run_2 + extract(w, 2) * b)
            run_3 = extract(step, 3) * (run_3 + extract(w, 3) * b)
            run_4 = extract(step, 4) * (run_4 + extract(w, 4) * b)
            run_5 = extract(step, 5) * (run_5 + extract(w, 5) * b)
        product = (own_0 * inner_0 + own_1 * inner_1) + (own_2 * inner_2 + own_3 * inner_3)
        product = product + (own_4 * inner_4 + own_5 * inner_5)
        behind = (own_0 * run_0 + own_1 * run_1) + (own_2 * run_2 + own_3 * run_3)
        b = load(right, i * LANES) - (behind + (own_4 * run_4 + own_5 * run_5))
        pivot = diagonal[i] - _sum(insert(own, EXPONENTIALS, own_5) * product)
        if pivot <= 0.0:
            return False
        last = pivot
        # No term holds anything in the lane behind the last one: there stands the inverse of the pivot.
        w = (1.0 - product) * (1.0 / pivot)
        store(work, i * LANES, w)
        store(right, i * LANES, b)
    _substitute(strength, row_strength, rows, count, right, steps, work)
    return True


@njit(cache=True, _nrt=False, error_model="numpy", inline="always")
def _of_terms(values: FloatArray) -> Lanes:
    """Return the numbers (EXPONENTIALS,) of the exponentials in lanes, 0 in the others."""
    lanes = splat(0.0)
    lanes = insert(lanes, 0, values[0])
    lanes = insert(lanes, 1, values[1])
    lanes = insert(lanes, 2, values[2])
    lanes = insert(lanes, 3, values[3])
    return insert(lanes, 4, values[4])


@njit(cache=True, _nrt=False, error_model="numpy", inline="always")
def _sum(lanes: Lanes) -> float:
    """Return the sum of all lanes."""
    lanes = lanes + _by_four(lanes)
    lanes = lanes + _by_two(lanes)
    total: float = extract(lanes + _by_one(lanes), 0)
    return total


@njit(cache=True, _nrt=False, error_model="numpy", inline="always")
def _substitute(
    strength: FloatArray,
    row_strength: FloatArray,
    rows: IntArray,
    count: int,
    right: FloatArray,
    steps: FloatArray,
    work: FloatArray,
) -> None:
    """Go back from the last row to the first."""
    own_0, own_1, own_2, own_3, own_4 = strength[0], strength[1], strength[2], strength[3], strength[4]
    none = splat(0.0)
    run_0, run_1, run_2, run_3, run_4, run_5 = none, none, none, none, none, none
    ahead, after = none, 0
    for n in range(count - 1, -1, -1):
        i = rows[n]
        factor = load(work, i * LANES)
        x = extract(factor, INVERSE) * load(right, i * LANES)
        if n < count - 1:
            step = load(steps, after * LANES)
            run_0 = extract(step, 0) * (run_0 + own_0 * ahead)
            run_1 = extract(step, 1) * (run_1 + own_1 * ahead)
            run_2 = extract(step, 2) * (run_2 + own_2 * ahead)
            run_3 = extract(step, 3) * (run_3 + own_3 * ahead)
            run_4 = extract(step, 4) * (run_4 + own_4 * ahead)
            run_5 = extract(step, 5) * (run_5 + row_strength[after] * ahead)
            taken = extract(factor, 0) * run_0 + extract(factor, 1) * run_1
            taken = taken + (extract(factor, 2) * run_2 + extract(factor, 3) * run_3)
            x = x - (taken + (extract(factor, 4) * run_4 + extract(factor, 5) * run_5))
        store(right, i * LANES, x)
        ahead, after = x, i
