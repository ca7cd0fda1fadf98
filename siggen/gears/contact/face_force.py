r"""Force and moment across the face of one tooth pair at one position, from the approach and the tilt.

It is called while tables are made (`force_curve`, `contact_table`), where damage is a notch and a floor (`face_gaps`);
in the time loop `dynamics/mesh/contact_spring` reads what it found.

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

from typing import NamedTuple

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.gears.contact.covered_slice import CoveredSlice
from siggen.gears.contact.exponential_matrix import add_row_products, products
from siggen.gears.contact.face_slices import FaceSlices, contact_half_width, slice_of, slice_sink
from siggen.gears.contact.line_kernel import diagonal, strengths
from siggen.gears.contact.newton_matrix import Answers, SolverRoom, add_low_rank, solve_local
from siggen.gears.contact.own_width import MeanWidth, mean_width, own_law

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


@njit(cache=True, _nrt=False, error_model="numpy")
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
