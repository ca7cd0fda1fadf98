"""Elastic forces of all tooth pairs at an angle, compiled: any number of slots, one pair after the other.

How two pairs on one gear body share the load says `two_springs`. More of them, or back flanks, are solved as one system
(derived: Newton's method on all forces), without what others take from a tangent.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.contact_spring import PairPlace, Spring, flat_spring, pair_spring
from siggen.dynamics.mesh.pair_columns import (
    ALONE,
    CARRYING,
    COLUMNS,
    COLUMNS_AT,
    COUPLED,
    CROSS,
    CURVES,
    FLANK,
    MISSED_1_AT,
    MISSED_2_AT,
    MOMENT,
    MOST_APART,
    NORMAL,
    OFFSET,
    PAIR,
    PENETRATION,
    POSITION,
    ROUGH,
    ROW,
    SHARE,
    SPRUNG,
    STIFFNESS,
    STIFFNESS_AT,
    TILT,
    TOUCH,
    TOUCH_AT,
    TURNING,
    WHOLE,
    YIELD,
)
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.mesh.pair_places import Engaged, between, engaged, placed, placed_contact
from siggen.dynamics.mesh.two_springs import EXACT_CHANGE, NO_SPRING, Before, two_springs

FORCE, SLOPE, RIGHT, MATRIX = range(4)
"""Columns of the solution of many pairs: force, slope, right side; the matrix, and behind it the coupling."""
MOST_SHARES = 50
"""Beyond half of these, pairs are solved one at a time; Newton's method was never seen to need more than 5."""


@njit(cache=True, _nrt=False, error_model="numpy")
def write_springs(
    law: PairLaw, approach_m: float, pitches: float, pairs: FloatArray, base: int, before: int, slots: int,
    settled: float,
) -> int:  # fmt: skip
    """Write elastic force, its own stiffness, its stiffness to the approach, carrying share and flank of every slot.

    The slots are the rows of `pairs` from `base` on; those from `before` on hold a state near by, for a first guess.
    Pairs on one gear body are settled to a share of their force (SMOOTH_CHANGE or EXACT_CHANGE). Forces stand in
    NORMAL, stiffness in STIFFNESS and YIELD, 0 where nothing touches. Returns which slots touch, one digit to the base
    3 per slot: 0 none, 1 drive flank, 2 back flank.
    """
    for i in range(base, base + slots):
        pairs[i, WHOLE], pairs[i, POSITION], pairs[i, PENETRATION] = 0.0, 0.0, 0.0
    first, second, near, back = -1, -1, 0, False
    lift = abs(pairs[base, TILT]) * law.scalars[layout.CONTACT_HALF_FACE]  # how far one end of the face is ahead
    pair = int(np.floor(pitches + law.scalars[layout.REACH_BEFORE]))
    while pitches - pair < law.scalars[layout.CONTACT_RATIO] + law.scalars[layout.REACH_AFTER]:
        i = base + pair % slots
        gap = _place_pair(law, pairs, i, pair, pitches - pair)
        pair -= 1
        depth, flank = approach_m - gap, 0.0
        behind = 2.0 * (approach_m - pairs[i, OFFSET]) - depth + law.scalars[layout.BACKLASH_M]
        if depth <= 0.0 and behind < 0.0:
            depth, flank, back = behind, -1.0, True
        pairs[i, PENETRATION], pairs[i, ALONE], pairs[i, FLANK] = depth, depth, flank
        if depth + lift > 0.0 or flank < 0.0:
            near += 1
            first, second = (i, second) if first < 0 else (first, i)
    if law.places[layout.APART] == 0 or near < 2:
        return _write_alone(law, pairs, base, slots)
    if near > 2 or back or not _write_two(law, pairs, first, second, before - base, settled):
        return _write_many(law, pairs, base, before, slots)
    for i in range(base, base + slots):
        if i not in (first, second):
            _write(pairs, i, NO_SPRING)
    digit_1, digit_2 = 3 ** (first - base), 3 ** (second - base)
    return (digit_1 if pairs[first, FLANK] > 0.0 else 0) + (digit_2 if pairs[second, FLANK] > 0.0 else 0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _place_pair(law: PairLaw, pairs: FloatArray, i: int, pair: int, place: float) -> float:
    """Write what depends on the angle alone, `place` pitches behind the entry of a pair; return its missing material.

    That counts with the place of its teeth [m].
    """
    if pairs[i, PAIR] != pair:
        engage(law, pairs, i, pair)
    kept = Engaged(
        pairs[i, ROW], pairs[i, STIFFNESS_AT], pairs[i, TOUCH_AT], pairs[i, COLUMNS_AT], pairs[i, MISSED_1_AT],
        pairs[i, MISSED_2_AT], pairs[i, OFFSET],
    )  # fmt: skip
    position, cell, weight, gap = placed(law, kept, place)
    missing: float = gap
    pairs[i, POSITION], pairs[i, WHOLE] = position, between(law, int(kept.stiffness) + cell, weight)
    if law.places[layout.CONTACT_NODES] > 0:
        pairs[i, TOUCH], pairs[i, CURVES], pairs[i, SHARE] = placed_contact(law, kept.touch, kept.columns, cell, weight)
    for a in range(min(law.places[layout.APART], MOST_APART)):
        first = law.places[layout.COUPLING_AT] + a * law.places[layout.POINTS]
        pairs[i, COUPLED + a] = between(law, first + cell, weight)
    return missing


@njit(cache=True, _nrt=False, error_model="numpy")
def engage(law: PairLaw, pairs: FloatArray, i: int, pair: int) -> None:
    """Write what stays during the engagement of a pair."""
    pairs[i, PAIR] = pair
    (
        pairs[i, ROW], pairs[i, STIFFNESS_AT], pairs[i, TOUCH_AT], pairs[i, COLUMNS_AT], pairs[i, MISSED_1_AT],
        pairs[i, MISSED_2_AT], pairs[i, OFFSET],
    ) = engaged(law, pair)  # fmt: skip


@njit(cache=True, _nrt=False, error_model="numpy")
def _write_many(law: PairLaw, pairs: FloatArray, base: int, before: int, slots: int) -> int:
    """Write the springs of more than two pairs, or with a back flank, without what others take from a tangent."""
    for i in range(slots):
        pairs[base + i, NORMAL] = pairs[before + i, SPRUNG]
    _share(law, pairs[base : base + slots])
    return _write_alone(law, pairs, base, slots)


@njit(cache=True, _nrt=False, error_model="numpy")
def _write_alone(law: PairLaw, pairs: FloatArray, base: int, slots: int) -> int:
    """Write the springs at the penetrations in the table."""
    touching, digit = 0, 1
    for i in range(base, base + slots):
        spring = NO_SPRING
        if pairs[i, WHOLE] > 0.0:
            spring = _spring(law, pairs, i, pairs[i, PENETRATION])
        _write(pairs, i, spring)
        if spring.force != 0.0:
            touching += digit if spring.force > 0.0 else 2 * digit
        digit *= 3
    return touching


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _place(pairs: FloatArray, i: int) -> PairPlace:
    return PairPlace(pairs[i, ALONE], pairs[i, TOUCH], pairs[i, CURVES], pairs[i, SHARE], pairs[i, WHOLE])


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _spring(law: PairLaw, pairs: FloatArray, i: int, penetration_m: float) -> Spring:
    """Return the spring of the flank of slot i; the back flank has no damage."""
    if pairs[i, FLANK] < 0.0:
        return flat_spring(pairs[i, WHOLE], penetration_m, -1.0)
    return pair_spring(law, _place(pairs, i), pairs[i, TILT], penetration_m)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write(pairs: FloatArray, i: int, spring: Spring) -> None:
    touches = spring.force != 0.0
    pairs[i, NORMAL], pairs[i, STIFFNESS] = spring.force, spring.stiffness if touches else 0.0
    pairs[i, SPRUNG] = spring.force
    pairs[i, YIELD], pairs[i, MOMENT] = spring.yielding if touches else 0.0, spring.moment
    pairs[i, CROSS], pairs[i, TURNING] = spring.cross, spring.turning
    pairs[i, CARRYING], pairs[i, ROUGH] = spring.carrying, spring.rough
    pairs[i, FLANK] = 1.0 if spring.force > 0.0 else (-1.0 if touches else 0.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write_two(law: PairLaw, pairs: FloatArray, i: int, j: int, offset: int, settled: float) -> bool:
    """Write the springs of two drive flanks on one gear body, i entered later; return whether that is settled.

    The state before stands `offset` rows on.
    """
    away = int(pairs[i, PAIR] - pairs[j, PAIR])
    c = pairs[i, COUPLED + away - 1] if away <= min(law.places[layout.APART], MOST_APART) else 0.0
    before = _before(pairs, i, i + offset), _before(pairs, j, j + offset)
    spring_i, spring_j, near = two_springs(law, c, pairs[i, TILT], settled, _place(pairs, i), _place(pairs, j), before)
    if near:
        pairs[i, PENETRATION], pairs[j, PENETRATION] = spring_i.penetration, spring_j.penetration
        _write(pairs, i, spring_i)
        _write(pairs, j, spring_j)
    return near


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _before(pairs: FloatArray, i: int, before: int) -> Before:
    """Return the spring in a state near by; zeros of another pair."""
    if pairs[before, PAIR] != pairs[i, PAIR]:
        return Before(0.0, 0.0, 0.0)
    return Before(pairs[before, SPRUNG], pairs[before, STIFFNESS], pairs[i, ALONE] - pairs[before, ALONE])


@njit(cache=True, _nrt=False)
def coupling_of(law: PairLaw, pairs: FloatArray, apart: int, i: int, j: int) -> float:
    """Return c of two slots [m/N]."""
    away = int(np.round((pairs[i, POSITION] - pairs[j, POSITION]) / law.scalars[layout.PITCH_M]))
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
def _share(law: PairLaw, pairs: FloatArray) -> None:
    """Replace the penetration of every pair by itself with that under the forces of the others."""
    slots, apart = pairs.shape[0], min(law.places[layout.APART], MOST_APART)
    coupling = MATRIX + slots
    work = pairs[:, COLUMNS:]  # of the table itself: code that allocates nothing need not count references
    for i in range(slots):
        for column in range(coupling + slots):
            work[i, column] = 0.0
    _prepare(law, pairs, work, apart)
    for step in range(MOST_SHARES):
        settled = True
        for i in range(slots):
            found, tangent = 0.0, 0.0
            if pairs[i, WHOLE] > 0.0:
                pairs[i, PENETRATION] = _under_others(pairs, work, coupling, i)
                spring = _spring(law, pairs, i, pairs[i, PENETRATION])
                found, tangent = spring.force, spring.stiffness
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
def _prepare(law: PairLaw, pairs: FloatArray, work: FloatArray, apart: int) -> None:
    """Write first guesses and couplings."""
    slots = pairs.shape[0]
    for i in range(slots):
        work[i, SLOPE] = -1.0
        if pairs[i, WHOLE] == 0.0:
            continue
        work[i, FORCE] = pairs[i, NORMAL]  # of the evaluation before, a near guess
        for j in range(slots):
            if i != j and pairs[j, WHOLE] > 0.0:
                work[i, MATRIX + slots + j] = coupling_of(law, pairs, apart, i, j)


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
