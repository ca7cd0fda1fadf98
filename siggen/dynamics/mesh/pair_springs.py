"""Elastic forces of all tooth pairs with their tangents, compiled: the spring of each, and how pairs share the load.

With coupling the penetrations solve p_n = d_n - Σ c_nm f_m(p_m) (derived): f is monotone, so Newton's method ends after
a few steps with the solution; it exists and is unique while the coupling of a pair stays below its own compliance,
since then the energy is strictly convex. Two drive flanks that carry are solved in closed form, from the forces and
tangents of a state near by; the tangent of ΣN to the approach follows from the same system: (I + diag(k) c) y = k. More
pairs, or back flanks, are solved as one system, without what others take from a tangent.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.contact_spring import contact_state
from siggen.dynamics.mesh.pair_columns import (
    ALONE,
    CARRYING,
    COLUMNS,
    COUPLED,
    CROSS,
    FLANK,
    GAP,
    MOMENT,
    MOST_APART,
    NORMAL,
    OFFSET,
    PAIR,
    PENETRATION,
    POSITION,
    ROUGH,
    STIFFNESS,
    TURNING,
    WHOLE,
    YIELD,
)
from siggen.dynamics.mesh.pair_places import engage_pair, place_pair

SMOOTH_CHANGE = 0.02
"""Of the larger force: Newton's error is the curvature times the square of this over ten, below 1e-6 of the force."""
EXACT_CHANGE = 1e-5
"""The same where a force stands for itself: less than 1e-9 of it is left."""
MOST_STEPS = 8
FORCE, SLOPE, RIGHT, MATRIX = range(4)
"""Columns of the solution of many pairs: force, slope, right side; the matrix, and behind it the coupling."""
MOST_SHARES = 50
"""Beyond half of these, pairs are solved one at a time; Newton's method was never seen to need more than 5."""


@njit(cache=True, _nrt=False, error_model="numpy")
def write_springs(
    scalars: FloatArray,
    numbers: FloatArray,
    index: IntArray,
    approach_m: float,
    pitches: float,
    pairs: FloatArray,
    base: int,
    before: int,
    slots: int,
    settled: float,
) -> int:
    """Write elastic force, its own stiffness, its stiffness to the approach, carrying share and flank of every slot.

    The slots are the rows of `pairs` from `base` on; those from `before` on hold a state near by, for a first guess.
    Pairs on one gear body are settled to a share of their force (SMOOTH_CHANGE or EXACT_CHANGE). Forces stand in
    NORMAL, stiffness in STIFFNESS and YIELD, 0 where nothing touches. Returns which slots touch, one digit to the base
    3 per slot: 0 none, 1 drive flank, 2 back flank.
    """
    for i in range(base, base + slots):
        pairs[i, WHOLE], pairs[i, POSITION], pairs[i, PENETRATION] = 0.0, 0.0, 0.0
    first, second, near, back = -1, -1, 0, False
    pair = int(np.floor(pitches + scalars[layout.REACH_BEFORE]))
    while pitches - pair < scalars[layout.CONTACT_RATIO] + scalars[layout.REACH_AFTER]:
        i = base + pair % slots
        if pairs[i, PAIR] != pair:
            engage_pair(numbers, index, pairs, i, pair)
        place_pair(scalars, numbers, index, pairs, i, pitches - pair)
        pair -= 1
        depth, flank = approach_m - pairs[i, GAP], 0.0
        if depth <= 0.0 and approach_m - pairs[i, OFFSET] < -scalars[layout.BACKLASH_M]:
            depth, flank, back = approach_m - pairs[i, OFFSET] + scalars[layout.BACKLASH_M], -1.0, True
        pairs[i, PENETRATION], pairs[i, ALONE], pairs[i, FLANK] = depth, depth, flank
        if depth > 0.0 or flank < 0.0:
            near += 1
            first, second = (i, second) if first < 0 else (first, i)
    if index[layout.APART] == 0 or near < 2:
        return _write_alone(scalars, numbers, index, pairs, base, slots)
    if near > 2 or back:
        return _write_many(scalars, numbers, index, pairs, base, before, slots)
    for i in range(base, base + slots):
        if i not in (first, second):
            _write(pairs, i, 0.0, 0.0)
            pairs[i, YIELD], pairs[i, MOMENT] = 0.0, 0.0
    digit_1, digit_2 = 3 ** (first - base), 3 ** (second - base)
    if not _write_two(scalars, numbers, index, pairs, first, second, before - base, settled):
        return _write_many(scalars, numbers, index, pairs, base, before, slots)
    return (digit_1 if pairs[first, FLANK] > 0.0 else 0) + (digit_2 if pairs[second, FLANK] > 0.0 else 0)


@njit(cache=True, _nrt=False, error_model="numpy")
def _write_many(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, base: int, before: int, slots: int
) -> int:
    """Write the springs of more than two pairs, or with a back flank, without what others take from a tangent."""
    for i in range(slots):
        pairs[base + i, NORMAL] = pairs[before + i, NORMAL]
    _share(scalars, numbers, index, pairs[base : base + slots])
    return _write_alone(scalars, numbers, index, pairs, base, slots)


@njit(cache=True, _nrt=False, error_model="numpy")
def _write_alone(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, base: int, slots: int
) -> int:
    """Write the springs at the penetrations in the table."""
    touching, digit = 0, 1
    for i in range(base, base + slots):
        elastic, tangent = 0.0, 0.0
        if pairs[i, WHOLE] > 0.0:
            elastic, tangent = spring_of(scalars, numbers, index, pairs, i, pairs[i, PENETRATION])
        _write(pairs, i, elastic, tangent)
        pairs[i, YIELD] = pairs[i, STIFFNESS]
        if elastic != 0.0:
            touching += digit if elastic > 0.0 else 2 * digit
        digit *= 3
    return touching


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def spring_of(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, penetration_m: float
) -> tuple[float, float]:
    """Return force and stiffness of slot i; write its moment, its carrying share and its share on damage.

    The back flank has no damage and pushes the other way, as stiff as the whole face; so does a law without a contact.
    """
    if index[layout.CONTACT_NODES] > 0 and pairs[i, FLANK] >= 0.0:
        (
            force, slope, pairs[i, MOMENT], pairs[i, CROSS], pairs[i, TURNING], pairs[i, CARRYING], pairs[i, ROUGH],
        ) = contact_state(scalars, numbers, index, pairs, i, penetration_m)  # fmt: skip
        return force, slope
    pairs[i, MOMENT], pairs[i, CROSS], pairs[i, TURNING] = 0.0, 0.0, 0.0
    pairs[i, CARRYING], pairs[i, ROUGH] = 1.0, 0.0
    side = -1.0 if pairs[i, FLANK] < 0.0 else 1.0
    if side * penetration_m <= 0.0:
        return 0.0, 0.0
    return pairs[i, WHOLE] * penetration_m, pairs[i, WHOLE]


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write(pairs: FloatArray, i: int, elastic: float, tangent: float) -> None:
    pairs[i, NORMAL] = elastic
    pairs[i, STIFFNESS] = tangent if elastic != 0.0 else 0.0
    pairs[i, FLANK] = 1.0 if elastic > 0.0 else (-1.0 if elastic < 0.0 else 0.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write_two(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, j: int, back: int,
    settled: float,
) -> bool:  # fmt: skip
    """Write the springs of two drive flanks on one gear body; return whether that is settled, or near enough."""
    # Row i is that of the pair that entered later, the older one is j.
    away = int(pairs[i, PAIR] - pairs[j, PAIR])
    c = pairs[i, COUPLED + away - 1] if away <= min(index[layout.APART], MOST_APART) else 0.0
    alone_i, alone_j = pairs[i, PENETRATION], pairs[j, PENETRATION]
    f_i, k_i, d_i = _state_before(pairs, i, i + back)
    f_j, k_j, d_j = _state_before(pairs, j, j + back)
    inverse = 1.0 / (1.0 - k_i * k_j * c * c)
    f_i, f_j = f_i + k_i * (d_i - c * k_j * d_j) * inverse, f_j + k_j * (d_j - c * k_i * d_i) * inverse
    p_i, p_j = alone_i, alone_j
    near = settled >= SMOOTH_CHANGE
    for _ in range(MOST_STEPS):
        p_i, p_j = alone_i - c * f_j, alone_j - c * f_i
        g_i, k_i = spring_of(scalars, numbers, index, pairs, i, p_i)
        g_j, k_j = spring_of(scalars, numbers, index, pairs, j, p_j)
        inverse = 1.0 / (1.0 - k_i * k_j * c * c)
        d_i = (g_i - f_i - k_i * c * (g_j - f_j)) * inverse
        d_j = (g_j - f_j - k_j * c * (g_i - f_i)) * inverse
        f_i, f_j = f_i + d_i, f_j + d_j
        if max(abs(d_i), abs(d_j)) <= settled * max(abs(f_i), abs(f_j)):
            near = True
            break
    pairs[i, PENETRATION], pairs[j, PENETRATION] = alone_i - c * f_j, alone_j - c * f_i
    pairs[i, MOMENT] += pairs[i, CROSS] * (pairs[i, PENETRATION] - p_i)
    pairs[j, MOMENT] += pairs[j, CROSS] * (pairs[j, PENETRATION] - p_j)
    _write(pairs, i, max(f_i, 0.0), k_i)
    _write(pairs, j, max(f_j, 0.0), k_j)
    pairs[i, YIELD] = k_i * (1.0 - c * k_j) * inverse
    pairs[j, YIELD] = k_j * (1.0 - c * k_i) * inverse
    return near


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _state_before(pairs: FloatArray, i: int, before: int) -> tuple[float, float, float]:
    """Return force, stiffness and change of the penetration by itself since a state near by; zeros of another pair."""
    if pairs[before, PAIR] != pairs[i, PAIR]:
        return 0.0, 0.0, 0.0
    return pairs[before, NORMAL], pairs[before, STIFFNESS], pairs[i, ALONE] - pairs[before, ALONE]


@njit(cache=True, _nrt=False)
def coupling_of(scalars: FloatArray, pairs: FloatArray, apart: int, i: int, j: int) -> float:
    """Return c of two slots [m/N]."""
    away = int(np.round((pairs[i, POSITION] - pairs[j, POSITION]) / scalars[layout.PITCH_M]))
    if away == 0 or abs(away) > apart:
        return 0.0
    # The pair that entered later has the smaller s.
    coupling: float = pairs[j, COUPLED + away - 1] if away > 0 else pairs[i, COUPLED - away - 1]
    return coupling


@njit(cache=True, _nrt=False)
def _solve(work: FloatArray) -> None:
    """Write the solution of the system in the first columns into column RIGHT; dominant diagonal, without pivoting."""
    n = work.shape[0]
    for k in range(n):
        for i in range(k + 1, n):
            factor = work[i, MATRIX + k] / work[k, MATRIX + k]
            for j in range(k + 1, n):
                work[i, MATRIX + j] -= factor * work[k, MATRIX + j]
            work[i, RIGHT] -= factor * work[k, RIGHT]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            work[k, RIGHT] -= work[k, MATRIX + j] * work[j, RIGHT]
        work[k, RIGHT] /= work[k, MATRIX + k]


@njit(cache=True, _nrt=False)
def _share(scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray) -> None:
    """Replace the penetration of every pair by itself with that under the forces of the others."""
    slots, apart = pairs.shape[0], min(index[layout.APART], MOST_APART)
    coupling = MATRIX + slots
    work = pairs[:, COLUMNS:]  # of the table itself: code that allocates nothing need not count references
    for i in range(slots):
        for column in range(coupling + slots):
            work[i, column] = 0.0
    _prepare(scalars, pairs, work, apart)
    for step in range(MOST_SHARES):
        settled = True
        for i in range(slots):
            found, tangent = 0.0, 0.0
            if pairs[i, WHOLE] > 0.0:
                pairs[i, PENETRATION] = _under_others(pairs, work, coupling, i)
                found, tangent = spring_of(scalars, numbers, index, pairs, i, pairs[i, PENETRATION])
            settled = settled and tangent == work[i, SLOPE]
            work[i, SLOPE], work[i, RIGHT] = tangent, found - work[i, FORCE]
            if step > MOST_SHARES // 2:
                # Pieces that alternate, which strong couplings could make: one pair at a time always ends.
                work[i, FORCE], work[i, RIGHT] = found, 0.0
        # One at a time, the same pieces twice are no proof: all steps are taken, each far nearer than the one before.
        if settled and step <= MOST_SHARES // 2:
            return
        if _newton_step(work, coupling) <= EXACT_CHANGE:
            for i in range(slots):
                pairs[i, PENETRATION] = _under_others(pairs, work, coupling, i)
            return


@njit(cache=True, _nrt=False, inline="always")
def _prepare(scalars: FloatArray, pairs: FloatArray, work: FloatArray, apart: int) -> None:
    """Write first guesses and couplings."""
    slots = pairs.shape[0]
    for i in range(slots):
        work[i, SLOPE] = -1.0
        if pairs[i, WHOLE] == 0.0:
            continue
        work[i, FORCE] = pairs[i, NORMAL]  # of the evaluation before, a near guess
        for j in range(slots):
            if i != j and pairs[j, WHOLE] > 0.0:
                work[i, MATRIX + slots + j] = coupling_of(scalars, pairs, apart, i, j)


@njit(cache=True, _nrt=False, inline="always")
def _newton_step(work: FloatArray, coupling: int) -> float:
    """Add Newton's step to the forces; return the largest step over the largest force."""
    slots = work.shape[0]
    for i in range(slots):
        for j in range(slots):
            work[i, MATRIX + j] = work[i, SLOPE] * work[i, coupling + j]
        work[i, MATRIX + i] += 1.0
    _solve(work)
    change, force = 0.0, 1e-300
    for i in range(slots):
        work[i, FORCE] += work[i, RIGHT]
        change, force = max(change, abs(work[i, RIGHT])), max(force, abs(work[i, FORCE]))
    return change / force


@njit(cache=True, _nrt=False, inline="always")
def _under_others(pairs: FloatArray, work: FloatArray, coupling: int, i: int) -> float:
    """Return the penetration of a slot under the forces of the others [m]."""
    left: float = pairs[i, ALONE]
    others = 0.0
    for j in range(work.shape[0]):
        others += work[i, coupling + j] * work[j, FORCE]
    return left - others
