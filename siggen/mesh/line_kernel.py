r"""Displacement of a line contact across the face: the kernel K and its form as a sum of exponentials.

Derived. A line load q(y) on two half spaces displaces the line, relative to the points at the depth h below it, by

    u(y) = κ Σ_j K_ij q_j,   K = ½ [f(t + w/2) - f(t - w/2)],   t = y_i - y_j,   κ = 2/(π E*)
    f(t) = arsinh(t/ε) - arsinh(t/h) - t/(2 (1 - ν) √(t² + h²)),   ε = a/(2 √e)

for cells of width w: Boussinesq's solution at the surface, with a width ε that gives an endless line exactly the
secant compliance of Weber and Banaschek, ln(2 h/a) - ν/(2 (1 - ν)); their depth h takes away the rest. Cells are part
of the model: from w = 0.7 to 3 a the losses of pair stiffness are those of the contact in three dimensions to 0.9
points (`tests/gears/contact/test_face_force.py`); narrower cells let the short waves become too soft.

The law of a is written as an energy (`face_force`): ½ u·K u with a of the load itself gives Weber and Banaschek's
secant only with ε e^-¼ in place of ε, since a grows with the load that does the work. `diagonal` and `strengths`
hold that ε.

K between different cells is a sum of `EXPONENTIALS` decaying exponentials, so that a product or a solution of n cells
takes n steps (`exponential_matrix`). Fitted error: 1e-3 κ at most on each entry, 5e-3 κ on the sum of a row, against
4 κ (20 mm, w = 0.1 mm).
"""

from __future__ import annotations

from functools import lru_cache
from math import asinh, exp, expm1, log, sinh, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import entry, njit
from siggen.lanes import LANES, Lanes, extract, insert, load, shuffle, splat, store

# Product and solution of a symmetric matrix that is a diagonal plus sums of decaying terms of the distance.
#
# A_ij = d_i for i = j, Σ_m s_m r_m^|i-j| + p_i Π_{j < k <= i} q_k for i > j: exponentials of the distance, and one
# term whose strength p and decay q belong to the rows (free ends make them so, see `tooth_kernel`). Product and
# solution take a number of steps proportional to the size: such a matrix is semiseparable, and its factors L D Lᵀ stay
# so (Foreman-Mackey et al. 2017, Astron. J. 154, 220, section 5.1, for real exponentials). Rows that are not chosen
# are left out; distances count through them.
#
# Terms, and right sides, are lanes of one register: what is not used of them stays 0.

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


SHORTEST_CELLS, LONGEST_DEPTHS = 0.5, 1.8
"""Decay lengths of the exponentials: geometric from half a cell to 1.8 h."""
ENERGY_WIDTH = 0.5 * exp(-0.75)
"""ε e^-¼ over a."""
POWERS = 4
"""Coefficients are a polynomial in t = x²/(x² + 1/4), x = ε e^-¼/w: short-range softness of a wide contact."""
WIDEST_EXACT, WIDEST = 1.5, 3.0
"""See `reckoned_width`, in cells."""
LARGEST_WIDTH = 1.0
"""Largest x of the fit; a wider contact keeps it off the diagonal."""


class LineKernel(NamedTuple):
    """K of equal cells at one position (a named tuple, since compiled code takes no dataclass).

    `decay` (m,): of each exponential from cell to cell; `near` (POWERS, m): polynomial of their strengths in t;
    `below` (m,), `below_diagonal`: what the depth takes away; `cell_m`: w; `depth_m`: h; `bracket`: ν/(2 (1 - ν));
    `coupled`: whether cells act on each other; if not every cell is a plane contact after Weber and Banaschek.
    """

    decay: FloatArray
    near: FloatArray
    below: FloatArray
    below_diagonal: float
    cell_m: float
    depth_m: float
    bracket: float
    coupled: bool


class KernelFamily(NamedTuple):
    """What kernels of all positions with equal cells share: `decay` (m,), `near` (POWERS, m), `fit` (m, n - 1)."""

    decay: FloatArray
    near: FloatArray
    fit: FloatArray
    cell_m: float


@lru_cache(maxsize=8)
def kernel_family(cells: int, cell_m: float, depth_m: float) -> KernelFamily:
    """Return the exponentials of a face of equal cells; `depth_m` is a typical h, which sets the longest decay."""
    lengths = np.geomspace(SHORTEST_CELLS, max(LONGEST_DEPTHS * depth_m / cell_m, 2.0), EXPONENTIALS)
    decay = np.exp(-1.0 / lengths)
    offset = np.arange(1, cells)
    fit = np.asarray(np.linalg.pinv(decay[None, :] ** offset[:, None]), dtype=np.float64)
    widths = np.linspace(0.02, LARGEST_WIDTH, 60)
    t = widths**2 / (widths**2 + 0.25)
    at_widths = np.stack([fit @ _near(offset, x) for x in widths])
    near = np.linalg.lstsq(t[:, None] ** np.arange(POWERS), at_widths, rcond=None)[0]
    family = KernelFamily(decay, np.array(near, dtype=np.float64), fit, cell_m)
    for array in family[:3]:
        array.setflags(write=False)
    return family


def line_kernel(family: KernelFamily, depth_m: float, poisson_ratio: float, *, coupled: bool = True) -> LineKernel:
    """Return the kernel at a position with Weber and Banaschek's depth h = √(h₁ h₂) [m]."""
    (kernel,) = line_kernels(family, np.array([depth_m]), poisson_ratio, coupled=coupled)
    return kernel


def line_kernels(
    family: KernelFamily, depth_m: FloatArray, poisson_ratio: float, *, coupled: bool = True
) -> list[LineKernel]:
    """Return the kernels at positions with depths (k,) [m]."""
    offset = np.arange(family.fit.shape[1] + 1)
    taken = _below(offset * family.cell_m, family.cell_m, depth_m[:, np.newaxis], poisson_ratio)
    return [
        LineKernel(
            decay=family.decay,
            near=family.near,
            below=family.fit @ below[1:],
            below_diagonal=float(below[0]),
            cell_m=family.cell_m,
            depth_m=depth,
            bracket=poisson_ratio / (2.0 * (1.0 - poisson_ratio)),
            coupled=coupled,
        )
        for depth, below in zip(depth_m.tolist(), taken, strict=True)
    ]


def _near(offset: NDArray[np.int64], width: float) -> FloatArray:
    return np.asarray(0.5 * (np.arcsinh((offset + 0.5) / width) - np.arcsinh((offset - 0.5) / width)))


def _below(t: FloatArray, cell_m: float, depth_m: float | FloatArray, poisson_ratio: float) -> FloatArray:
    def integral(y: FloatArray) -> FloatArray:
        return np.arcsinh(y / depth_m) + y / (2.0 * (1.0 - poisson_ratio) * np.hypot(y, depth_m))

    return 0.5 * (integral(t + 0.5 * cell_m) - integral(t - 0.5 * cell_m))


@entry(cache=True, _nrt=False, error_model="numpy")
def reckoned_width(half_width_m: float, cell_m: float) -> tuple[float, float, float]:
    """Return the half width that K reckons with, and the first and second derivative of its logarithm to ln a.

    It is a itself up to `WIDEST_EXACT` cells. A contact much wider than its cells would make the energy's short waves
    unstable; from there on the width grows more slowly, and stops at `WIDEST` cells, with a continuous slope.
    """
    if half_width_m <= WIDEST_EXACT * cell_m:
        return half_width_m, 1.0, 0.0
    span = log(WIDEST / WIDEST_EXACT)
    over = log(half_width_m / (WIDEST_EXACT * cell_m))
    if over >= span:
        return WIDEST_EXACT * cell_m * exp(0.5 * span), 0.0, 0.0
    return WIDEST_EXACT * cell_m * exp(over - 0.5 * over * over / span), 1.0 - over / span, -1.0 / span


@entry(cache=True, _nrt=False, error_model="numpy")
def diagonal(kernel: LineKernel, half_width_m: float) -> tuple[float, float]:
    """Return K_ii of the energy and its derivative to ln a."""
    if not kernel.coupled:
        return log(2.0 * kernel.depth_m / half_width_m) - kernel.bracket + 0.25, -1.0
    x = 0.5 * kernel.cell_m / (ENERGY_WIDTH * half_width_m)
    return asinh(x) - kernel.below_diagonal, -x / sqrt(1.0 + x * x)


@entry(cache=True, _nrt=False, error_model="numpy")
def strengths(kernel: LineKernel, half_width_m: float, strength: FloatArray, slope: FloatArray) -> None:
    """Write the strengths (m,) of the exponentials and their derivatives to ln a."""
    if not kernel.coupled:
        strength[:] = 0.0
        slope[:] = 0.0
        return
    x = ENERGY_WIDTH * half_width_m / kernel.cell_m
    t = x * x / (x * x + 0.25)
    # d t/d ln a
    t_slope = 2.0 * t * (1.0 - t)
    if x > LARGEST_WIDTH:
        t, t_slope = LARGEST_WIDTH**2 / (LARGEST_WIDTH**2 + 0.25), 0.0
    for m in range(strength.size):
        value, rise = 0.0, 0.0
        for p in range(POWERS - 1, -1, -1):
            rise = rise * t + value
            value = value * t + kernel.near[p, m]
        strength[m] = value - kernel.below[m]
        slope[m] = rise * t_slope


# ToothKernel: how the teeth of a pair give way across the face, on equal slices.
#
# Derived. A tooth bends and shears under a line load q(y), and a load at y' also deflects the tooth at y:
#
#     t(y) = C b ∫ G(y, y') q(y') dy',   G = cosh(y_</l) cosh((b - y_>)/l)/(l sinh(b/l)),   y from one end of the face
# b
#
# G is Green's function of t - l² t'' = C b q with free ends t' = 0: a tooth whose slices hang together by a moment
# that resists twisting. ∫ G dy' = 1 at every y, so that an even load deflects the tooth evenly by C F, as if it were
# rigid across the face; l → ∞ is the rigid tooth for every load. Averaged over the cells, T_ij = w G_ij has rows of
# sum 1 exactly and the same form, p_i Π q_k (`exponential_matrix`), so that a solution takes steps in proportion to n.

RIGID = 1e-9
"""b/l below which a tooth counts as rigid: T differs from 1/n by 1e-19."""


class ToothKernel(NamedTuple):
    """γ T, γ = C b/κ, on n slices (a named tuple, since compiled code takes no dataclass).

    `strength`, `decay` (n,): γ p and q; `diagonal` (n,): of γ T; `sum`: γ, the sum of a row.
    """

    strength: FloatArray
    decay: FloatArray
    diagonal: FloatArray
    sum: float


def unit_tooth(slices: int, face_width_m: float, length_m: float) -> ToothKernel:
    """Return T itself for n slices of a face b [m] and a length l [m], which may be infinite."""
    return ToothKernel(*_free_ends(slices, face_width_m / (slices * length_m)), 1.0)


def tooth_kernel(unit: ToothKernel, compliance_m_per_n: float, face_width_m: float, kappa_per_pa: float) -> ToothKernel:
    """Return γ T of teeth whose compliance C [m/N] bends across a face b [m]; κ is what line loads are counted in."""
    gamma = compliance_m_per_n * face_width_m / kappa_per_pa
    return ToothKernel(gamma * unit.strength, unit.decay, gamma * unit.diagonal, gamma)


def tooth_matrix(kernel: ToothKernel) -> FloatArray:
    """Return the kernel as a full matrix (n, n), for checks."""
    matrix = np.diag(kernel.diagonal)
    for j in range(kernel.diagonal.size):
        matrix[j + 1 :, j] = matrix[j, j + 1 :] = kernel.strength[j + 1 :] * np.cumprod(kernel.decay[j + 1 :])
    return matrix


@entry(cache=True)
def _free_ends(count: int, cell: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return p, q and the diagonal (n,) for cells of the width w/l."""
    strength, decay, diagonal = np.zeros(count), np.ones(count), np.ones(count)
    cell = max(cell, RIGID / count)
    # mean of cosh over a cell over its middle's; two cells
    mean = (sinh(0.5 * cell) / (0.5 * cell)) ** 2 if cell < 100.0 else 0.0
    for i in range(count):
        # cosh(y/l) times 2 exp(-y/l), and from the other end
        end, other = 1.0 + exp(-cell * (2 * i + 1)), 1.0 + exp(-cell * (2 * (count - i) - 1))
        strength[i] = 0.5 * cell * mean * end * other / -expm1(-2.0 * cell * count)
        if i > 0:
            decay[i] = exp(-cell) * (1.0 + exp(-cell * (2 * i - 1))) / end
    # the diagonal is what the others lack to 1
    below, above = 0.0, 0.0
    for i in range(1, count):
        below = decay[i] * (below + 1.0)
        diagonal[i] -= strength[i] * below
        j = count - i
        above = decay[j] * (above + strength[j])
        diagonal[j - 1] -= above
    return strength, decay, diagonal
