r"""Force and moment across the face of one tooth pair at one position, from the approach and the tilt.

It is called while tables are made (`force_curve`, `contact_table`), where damage is a notch and a floor (`face_gaps`);
in the time loop `siggen.mesh.springs` reads what it found.

The face is cut into equal slices that carry the line loads q_j = u_j/κ >= 0. Derived: the complementary energy

    Ψ = (w/κ) [½ u·(K(a) + T) u + Σ_j ∫ e_j du] + ½ C F²,   F = w Σ q_j,   a² = 2 R √(w Σ u²/L)

holds the elastic line with its neighbours (`line_kernel`), the teeth that bend across the face (`tooth_kernel`), the
sink e_j of a slice at the edges of missing material (`two_edges`) and the compliance C of everything else, rigid across
the face. Its least value over u >= 0 at a given approach d and tilt θ solves

    δ_j = d + θ y_j - lead_j = C F + ((K + T) u)_j + β u_j + e_j(u_j),   β = ¼ u·(dK/d ln a)u/u·u,

a half width a that belongs to the load that is carried: the mean square over the length L. For an even load on the
whole face it is Weber and Banaschek's secant law exactly, and β = -¼ makes good for the energy's ε. Force F and moment
M = w Σ q y are the derivatives of the stored energy W = w Σ q δ - Ψ to d and θ, so that no closed loop in (d, θ) does
work. K + β is positive definite (`line_kernel.reckoned_width`), so F and dF/dd > 0 are continuous; from first touch on
dF/dd grows from 0.

Solved by Newton's method on the slices that touch; the matrix takes a number of steps proportional to the slices.
"""

from __future__ import annotations

from math import log, sqrt
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import entry, njit
from siggen.lanes import LANES, extract, load, splat
from siggen.mesh.contact_edges import NO_EDGE, largest_edge_pressure
from siggen.mesh.face_slices import CoveredSlice, FaceSlices, contact_half_width, load_apart, slice_of, slice_sink
from siggen.mesh.line_kernel import EXPONENTIALS, RowMatrix, add_row_products, diagonal, products, solve_rows, strengths

# Half width of a slice under its own load, where the kernel across the face reckons with one for all slices.
#
# Derived. `line_kernel` holds ½ u·K(a) u with the half width a of the mean square of the loads. A load that changes
# slowly across the face makes each place as wide as it is loaded: the energy lacks
#
#     -½ Σ u_j² [λ(u_j) - λ(u_m)],   λ = ln ρ(√(2 R u)),   u_m² = w Σ u²/L,
#
# which is 0 for an even load and takes ½ from the compliance of waves. It is exact where they are long beside a: a
# strip that sinks with the wave sin ky has ln(4/ka) - γ, K alone ½ more. Without it a face gives way to a tilt by 10 %
# more than in three dimensions. In λ(u_j) stands the radius of the slice: those of helical teeth differ. ρ is a up to
# `EXACT` cells and stops at `WIDEST`, with two continuous derivatives: the short waves of K, whose eigenvalue falls to
# ½ at one cell, could not bear more.

EXACT, WIDEST = 0.5, 3.0
"""In cells: what the shortest wave meets stays above 0.05 κ at any mean width, for loads to five times the mean."""
SPAN = log(WIDEST / EXACT)


class OwnWidth(NamedTuple):
    """λ of a load, counted from the width `EXACT`, and its first and second derivative to ln a."""

    logarithm: float
    growth: float
    bend: float


class MeanWidth(NamedTuple):
    """What slices share: a² over the load and `EXACT`² [1/m], whether slices act on each other, and λ of the mean load.

    Slices that do not act on each other have no widest width.
    """

    scale_per_m: float
    coupled: bool
    mean: OwnWidth


@njit(cache=True, _nrt=False, error_model="numpy")
def own_width(load_m: float, scale_per_m: float, coupled: bool) -> OwnWidth:
    """Return λ of a load κq > 0 [m]."""
    over = 0.5 * log(scale_per_m * load_m)
    if over <= 0.0 or not coupled:
        return OwnWidth(over, 1.0, 0.0)
    if over >= SPAN:
        return OwnWidth(0.5 * SPAN, 0.0, 0.0)
    x = over / SPAN
    return OwnWidth(over * (1.0 - x * x * (1.0 - 0.5 * x)), 1.0 - x * x * (3.0 - 2.0 * x), 6.0 * x * (x - 1.0) / SPAN)


@entry(cache=True, _nrt=False, error_model="numpy")
def mean_width(slices: FaceSlices, square: float) -> MeanWidth:
    """Return what slices share under loads with the sum of squares `square` > 0."""
    cell = slices.kernel.cell_m
    scale, coupled = 2.0 * slices.radius_m / (EXACT * cell) ** 2, slices.kernel.coupled
    return MeanWidth(scale, coupled, own_width(sqrt(cell * square / slices.carrying_m), scale, coupled))


@entry(cache=True, _nrt=False, error_model="numpy")
def own_law(load_m: float, radius_share: float, shared: MeanWidth) -> tuple[float, float]:
    """Return what the own width of a slice under κq > 0 [m] adds to its approach over the load, and to the slope.

    `radius_share`: its radius over that of the pair.
    """
    own = own_width(load_m, radius_share * shared.scale_per_m, shared.coupled)
    factor = shared.mean.logarithm - own.logarithm + 0.25 * (shared.mean.growth - own.growth)
    return factor, factor - 0.5 * own.growth - 0.125 * own.bend


# The matrix of Newton's method for the slices: a diagonal, decaying terms of the distance, and three vectors.


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


TOLERANCE = 1e-5
"""Of the last Newton step over the largest load. Steps are squared from pass to pass (measured 1e-3, 1e-7), so loads
are good to 1e-9."""
LARGEST_PASSES = 80
DAMPING = 0.3
"""First addition to the diagonal, in κ, after a step from where the matrix is not positive definite (wild guesses)."""
RETURNS = 4
"""How often a slice may lose touch before its load is cut down step by step instead."""


class FaceForce(NamedTuple):
    """What the pair answers to an approach and a tilt.

    `force_n`: F; `moment_n_m`: M, positive with the load at positive y; `stiffness_n_per_m`: dF/dd to 0.2 %;
    `turning_n`: dM/dd = dF/dθ; `tilting_n_m`: dM/dθ; `carrying_m`: (Σ q)² w/Σ q², the length that carries; `on_rough`:
    share of the load on rough land; `passes` of the solver, -1: not solved.
    """

    force_n: float
    moment_n_m: float
    stiffness_n_per_m: float
    turning_n: float
    tilting_n_m: float
    carrying_m: float
    on_rough: float
    passes: int


class _Laws(NamedTuple):
    """What slices share within a pass: β, widths, and what is added to the diagonal."""

    beta: float
    width: MeanWidth
    damping: float


@entry(cache=True, _nrt=False, error_model="numpy")
def face_force(
    slices: FaceSlices,
    approach_m: float,
    tilt_rad: float,
    loads_m: FloatArray,
    room: SolverRoom,
    tolerance: float = TOLERANCE,
) -> FaceForce:
    """Return the answer to an approach and a tilt.

    Parameters
    ----------
    slices : FaceSlices
    approach_m, tilt_rad : d and θ
    loads_m : (n,) κq [m]
        A guess, which comes out solved; that of a neighbouring approach or position saves passes, zeros are allowed.
    room : SolverRoom
    tolerance : float
        Of the last Newton step over the largest load.
    """
    keep_rigid_sinks(slices, room)
    return solved_force(slices, approach_m, tilt_rad, loads_m, room, tolerance)


@entry(cache=True, _nrt=False, error_model="numpy")
def keep_rigid_sinks(slices: FaceSlices, room: SolverRoom) -> None:
    """Put the sinks of slices without load into the room: all solutions of one position need them."""
    for i in range(room.rigid_m.size):
        room.rigid_m[i] = slice_sink(slice_of(slices, i), 0.0).sink_m


@njit(cache=True, _nrt=False, error_model="numpy")
def solved_force(
    slices: FaceSlices, approach_m: float, tilt_rad: float, loads_m: FloatArray, room: SolverRoom, tolerance: float
) -> FaceForce:
    """Return what `face_force` does, in a room that has the rigid sinks of the slices."""
    room.losses[:] = 0
    _first_guess(slices, approach_m, tilt_rad, loads_m, room)
    damping = 0.0
    for passes in range(1, LARGEST_PASSES + 1):
        square = 0.0
        for i in range(loads_m.size):
            square += loads_m[i] * loads_m[i]
        if square == 0.0 and passes > 1:  # a guess far too large let go of every slice: begin anew
            _first_guess(slices, approach_m, tilt_rad, loads_m, room)
            for i in range(loads_m.size):
                square += loads_m[i] * loads_m[i]
        if square == 0.0:
            return FaceForce(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, passes)
        work, bend = _prepare(slices, loads_m, square, room)
        laws = _Laws(0.25 * work / square, mean_width(slices, square), damping)
        chosen, settled = _assemble(slices, approach_m, tilt_rad, loads_m, laws, room)
        if not solve_local(slices, room, chosen):
            damping = max(2.0 * damping, DAMPING)
            continue
        slope = work / square - laws.width.mean.growth - 0.25 * laws.width.mean.bend
        answers = add_low_rank(slices, room, chosen, loads_m, square, slope, bend / square)
        largest, kept = _move(loads_m, room, chosen)
        if settled and kept and answers.step_m <= tolerance * largest:
            return _answer(slices, loads_m, answers, passes)
        damping = 0.5 * damping if damping > 0.1 * DAMPING else 0.0
    return FaceForce(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1)


@njit(cache=True, _nrt=False, error_model="numpy")
def _first_guess(slices: FaceSlices, approach: float, tilt: float, loads: FloatArray, room: SolverRoom) -> None:
    """Put loads on the slices that the approach reaches if none carries yet."""
    for i in range(loads.size):
        if loads[i] > 0.0:
            return
    own = 4.0 + slices.teeth.sum + slices.compliance_m_per_n * slices.carrying_m / slices.kappa_per_pa
    for i in range(loads.size):
        loads[i] = max(approach + tilt * slices.face_m[i] - slices.lead_m[i] - room.rigid_m[i], 0.0) / own


@njit(cache=True, _nrt=False, error_model="numpy")
def _prepare(slices: FaceSlices, loads: FloatArray, square: float, room: SolverRoom) -> tuple[float, float]:
    """Fill (K + T) u and (dK/d ln a) u into the room; return u·(dK/d ln a) u and what the bend of a adds."""
    width, growth, bend = contact_half_width(slices, square)
    own, own_slope = diagonal(slices.kernel, width)
    strengths(slices.kernel, width, room.strength, room.strength_slope)
    products(slices.kernel.decay, room.strength, room.strength_slope, loads, room.product, room.growth)
    add_row_products(slices.teeth.strength, slices.teeth.decay, loads, room.product)
    work = 0.0
    for i in range(loads.size):
        room.diagonal[i] = own + slices.teeth.diagonal[i]
        room.product[i] += room.diagonal[i] * loads[i]
        room.growth[i] = growth * (room.growth[i] + own_slope * loads[i])
        work += loads[i] * room.growth[i]
    return work, work * bend / growth if bend != 0.0 else 0.0


@njit(cache=True, _nrt=False, error_model="numpy")
def _assemble(
    slices: FaceSlices,
    approach: float,
    tilt: float,
    loads: FloatArray,
    laws: _Laws,
    room: SolverRoom,
) -> tuple[int, bool]:
    """Fill matrix and right sides; return how many slices carry, and whether none of them is new."""
    per_load = slices.kernel.cell_m / slices.kappa_per_pa
    total = 0.0
    for i in range(loads.size):
        total += loads[i]
    rest = slices.compliance_m_per_n * per_load * total
    chosen, settled = 0, True
    # Arrays one by one: to hand over all slices costs more than the sink.
    left, right, notch, floor = slices.left_m, slices.right_m, slices.notch_m, slices.floor_m
    covered, tips, spread = slices.covered, slices.tips_m, slices.spread
    radii, rounding = slices.radii_m, slices.rounding_m
    for i in range(loads.size):
        own = room.diagonal[i]
        wanted = approach + tilt * slices.face_m[i] - slices.lead_m[i] - rest - room.product[i]
        if loads[i] == 0.0:
            if wanted <= room.rigid_m[i]:
                continue
            settled = False
            # small beside the neighbours but not 0, where sinks are infinitely soft
            loads[i] = min((wanted - room.rigid_m[i]) / (own + 4.0), 0.05 * total / loads.size + 1e-15)
            wanted -= own * loads[i]
        gaps, edges = (left[i], right[i], notch[i], floor[i]), (tips[i, 0], tips[i, 1])
        one = CoveredSlice(gaps, edges, covered[i], spread, (radii[i], rounding))
        gap = slice_sink(one, loads[i])
        factor, slope = own_law(loads[i], radii[i] / slices.radius_m, laws.width)
        residual = wanted - (laws.beta + factor) * loads[i] - gap.sink_m
        room.rows[chosen] = i
        chosen += 1
        room.diagonal[i] = own + laws.beta + slope + gap.slope + laws.damping
        room.right[i, 0] = residual
        room.right[i, 1] = 1.0
        room.right[i, 2] = loads[i]
        room.right[i, 3] = room.growth[i]
        room.right[i, 4] = slices.face_m[i]
    return chosen, settled


@njit(cache=True, _nrt=False, error_model="numpy")
def _move(loads: FloatArray, room: SolverRoom, chosen: int) -> tuple[float, bool]:
    """Take the step; return the largest load, and whether every slice keeps touch."""
    largest, kept = 0.0, True
    for n in range(chosen):
        i = room.rows[n]
        largest = max(largest, loads[i])
        moved = loads[i] + room.right[i, 0]
        if moved > 0.0:
            loads[i] = moved
            continue
        kept = False
        room.losses[i] += 1
        loads[i] = 0.0 if room.losses[i] <= RETURNS else 0.2 * loads[i]
    return largest, kept


@njit(cache=True, _nrt=False, error_model="numpy")
def _answer(slices: FaceSlices, loads: FloatArray, answers: Answers, passes: int) -> FaceForce:
    total = square = moment = on_rough = 0.0
    for i in range(loads.size):
        total += loads[i]
        square += loads[i] * loads[i]
        moment += loads[i] * slices.face_m[i]
        on_rough += loads[i] * slices.rough[i]
    per_load = slices.kernel.cell_m / slices.kappa_per_pa
    length = slices.kernel.cell_m * total * total / square
    return FaceForce(
        per_load * total,
        per_load * moment,
        answers.stiffness_n_per_m,
        answers.turning_n,
        answers.tilting_n_m,
        length,
        on_rough / total,
        passes,
    )


# Loads of the slices of a face under a given force and tilt: the approach is what is looked for (derived).

CLOSE = 1e-6
"""Error of the force that is left, over the force."""
MOST_STEPS = 60


def loads_under_force(slices: FaceSlices, force_n: float, tilt_rad: float = 0.0) -> FloatArray:
    """Return the loads κq (n,) [m] that add up to a force; 0 for no force.

    Raises
    ------
    ValueError
        If no approach gives the force.
    """
    loads, room = np.zeros(slices.face_m.size), solver_room(slices.face_m.size)
    if force_n <= 0.0:
        return loads
    # First touch by rigid flanks, then as if the whole pair were linear: both ends of a bracket, stretched if needed.
    keep_rigid_sinks(slices, room)
    low = float((room.rigid_m + slices.lead_m - tilt_rad * slices.face_m).min())
    teeth = slices.teeth.sum * slices.kappa_per_pa / (slices.kernel.cell_m * loads.size)
    high, step = np.inf, 2.0 * (slices.compliance_m_per_n + teeth) * force_n + 1e-7
    approach = low + step
    for _ in range(MOST_STEPS):
        found = face_force(slices, approach, tilt_rad, loads, room)
        if found.passes < 0:
            loads[:] = 0.0
            found = face_force(slices, approach, tilt_rad, loads, room)
        missing = force_n - found.force_n
        if found.passes > 0 and abs(missing) <= CLOSE * force_n:
            return loads
        low, high = (approach, high) if missing > 0.0 else (low, approach)
        wanted = approach + missing / found.stiffness_n_per_m if found.stiffness_n_per_m > 0.0 else low
        if not low < wanted < high:
            wanted = 0.5 * (low + high) if np.isfinite(high) else approach + 2.0 * step
        approach = wanted
    raise ValueError(f"force_n: received {force_n:.6g}; allowed: a force that the face carries")


# SlicePressures: line load and largest elastic pressures of the slices of a loaded face.
#
# Derived. A slice away from damage has Hertz's pressure 2q/(πa) of its own load, a² = 2Rκq. Where it meets a gap of
# the damage its load rests on the edges in the shares of `two_edges`, each with the pressure of `edge_pressure`,
# unless the floor of the gap carries. Tips count as plain: their corners have no radius in the model.


class SlicePressures(NamedTuple):
    """Of every slice (n,): load per length [N/m], and largest pressure [Pa], Hertz's or that at edges of damage.

    `at_edge` (n,): 1 where edges of damage carry more than Hertz's pressure, else 0.
    """

    line_load_n_per_m: FloatArray
    pressure_pa: FloatArray
    at_edge: FloatArray


def slice_pressures(slices: FaceSlices, loads_m: FloatArray) -> SlicePressures:
    """Return loads and pressures of slices that carry κq = `loads_m` (n,) [m].

    Edges need a radius (`rounding_m` > 0): the pressure at a sharp one is infinite, and is given as such.
    """
    pressure, at_edge = _pressures(slices, np.ascontiguousarray(loads_m))
    return SlicePressures(loads_m / slices.kappa_per_pa, pressure, at_edge)


@entry(cache=True)
def _pressures(slices: FaceSlices, loads: FloatArray) -> tuple[FloatArray, FloatArray]:
    kappa, rounding = slices.kappa_per_pa, slices.rounding_m
    pressure, at_edge = np.zeros(loads.size), np.zeros(loads.size)
    for i in range(loads.size):
        load, radius = loads[i], slices.radii_m[i]
        if load <= 0.0:
            continue
        one = slice_of(slices, i)
        gap = slice_sink(one, load)
        land = load
        if 0.0 < slices.covered[i] < 1.0:
            apart = load_apart(one, load)
            land, load = load + slices.covered[i] * apart, load - (1.0 - slices.covered[i]) * apart
        pressure[i] = np.sqrt(2.0 * max(land, load) / radius) / (np.pi * kappa)
        left, right = slices.left_m[i], slices.right_m[i]
        on_floor = slices.floor_m[i] > 0.0 and gap.sink_m >= slices.floor_m[i]
        if load <= 0.0 or slices.notch_m[i] <= 0.0 or on_floor or max(left, right) < -0.5 * NO_EDGE:
            continue
        for ahead, share in ((-left, gap.left_share), (-right, 1.0 - gap.left_share)):
            if share <= 1e-6 or ahead >= np.sqrt(2.0 * radius * load * share):
                continue
            found = np.inf
            if rounding > 0.0:
                found = largest_edge_pressure(ahead, radius, rounding, load * share / kappa, kappa)
            if found > pressure[i]:
                pressure[i], at_edge[i] = found, 1.0
    return pressure, at_edge
