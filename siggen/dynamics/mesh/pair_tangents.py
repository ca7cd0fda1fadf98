"""Elastic forces of all tooth pairs with their tangents, compiled: what an implicit step needs of the pair law.

The springs are those of `pair_forces`. With coupling, two pairs that carry solve p_n = d_n - c f_m by Newton's method
in closed form, from the forces and tangents of a state near by; the tangent of ΣN to the approach follows from the same
system (derived): (I + diag(k) c) y = k. More pairs, or back flanks, are left to `share_coupled`.
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
    ROUGH,
    STIFFNESS,
    TURNING,
    WHOLE,
    YIELD,
)
from siggen.dynamics.mesh.pair_places import engage_pair, place_pair
from siggen.dynamics.mesh.pair_springs import share_coupled, spring_of_flank

SMOOTH_CHANGE = 0.02
"""Of the larger force: Newton's error is the curvature times the square of this over ten, below 1e-6 of the force."""
MOST_STEPS = 8


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
) -> int:
    """Write elastic force, its own stiffness, its stiffness to the approach, carrying share and flank of every slot.

    The slots are the rows of `pairs` from `base` on; those from `before` on hold a state near by, for a first guess.
    Forces stand in NORMAL, stiffness in STIFFNESS and YIELD, 0 where nothing touches. Returns which slots touch, one
    digit to the base 3 per slot: 0 none, 1 drive flank, 2 back flank.
    """
    for i in range(base, base + slots):
        pairs[i, WHOLE] = 0.0
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
            pairs[i, YIELD] = 0.0
    digit_1, digit_2 = 3 ** (first - base), 3 ** (second - base)
    _write_two(scalars, numbers, index, pairs, first, second, before - base)
    return (digit_1 if pairs[first, FLANK] > 0.0 else 0) + (digit_2 if pairs[second, FLANK] > 0.0 else 0)


@njit(cache=True, _nrt=False, error_model="numpy")
def _write_many(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, base: int, before: int, slots: int
) -> int:
    """Write the springs of more than two pairs, or with a back flank, without what others take from a tangent."""
    for i in range(slots):
        pairs[base + i, NORMAL] = pairs[before + i, NORMAL]
    share_coupled(scalars, numbers, index, pairs[base : base + slots])
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
            elastic, tangent = _spring(scalars, numbers, index, pairs, i, pairs[i, PENETRATION])
        _write(pairs, i, elastic, tangent)
        pairs[i, YIELD] = pairs[i, STIFFNESS]
        if elastic != 0.0:
            touching += digit if elastic > 0.0 else 2 * digit
        digit *= 3
    return touching


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _spring(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, penetration_m: float
) -> tuple[float, float]:
    """Return force and stiffness of slot i; write its moment, its carrying share and its share on damage."""
    if index[layout.CONTACT_NODES] > 0 and pairs[i, FLANK] >= 0.0:
        (
            force, slope, pairs[i, MOMENT], pairs[i, CROSS], pairs[i, TURNING], pairs[i, CARRYING], pairs[i, ROUGH],
        ) = contact_state(scalars, numbers, index, pairs, i, penetration_m)  # fmt: skip
        return force, slope
    pairs[i, MOMENT], pairs[i, CROSS], pairs[i, TURNING] = 0.0, 0.0, 0.0
    pairs[i, CARRYING] = 1.0
    return spring_of_flank(scalars, numbers, index, pairs, i, penetration_m)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write(pairs: FloatArray, i: int, elastic: float, tangent: float) -> None:
    pairs[i, NORMAL] = elastic
    pairs[i, STIFFNESS] = tangent if elastic != 0.0 else 0.0
    pairs[i, FLANK] = 1.0 if elastic > 0.0 else (-1.0 if elastic < 0.0 else 0.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write_two(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, j: int, back: int
) -> None:
    """Write the springs of two drive flanks on one gear body."""
    # Row i is that of the pair that entered later, the older one is j.
    away = int(pairs[i, PAIR] - pairs[j, PAIR])
    c = pairs[i, COUPLED + away - 1] if away <= min(index[layout.APART], MOST_APART) else 0.0
    alone_i, alone_j = pairs[i, PENETRATION], pairs[j, PENETRATION]
    f_i, k_i, d_i = _state_before(pairs, i, i + back)
    f_j, k_j, d_j = _state_before(pairs, j, j + back)
    inverse = 1.0 / (1.0 - k_i * k_j * c * c)
    f_i, f_j = f_i + k_i * (d_i - c * k_j * d_j) * inverse, f_j + k_j * (d_j - c * k_i * d_i) * inverse
    p_i, p_j = alone_i, alone_j
    for _ in range(MOST_STEPS):
        p_i, p_j = alone_i - c * f_j, alone_j - c * f_i
        g_i, k_i = _spring(scalars, numbers, index, pairs, i, p_i)
        g_j, k_j = _spring(scalars, numbers, index, pairs, j, p_j)
        inverse = 1.0 / (1.0 - k_i * k_j * c * c)
        d_i = (g_i - f_i - k_i * c * (g_j - f_j)) * inverse
        d_j = (g_j - f_j - k_j * c * (g_i - f_i)) * inverse
        f_i, f_j = f_i + d_i, f_j + d_j
        if max(abs(d_i), abs(d_j)) <= SMOOTH_CHANGE * max(abs(f_i), abs(f_j)):
            break
    pairs[i, PENETRATION], pairs[j, PENETRATION] = alone_i - c * f_j, alone_j - c * f_i
    pairs[i, MOMENT] += pairs[i, CROSS] * (pairs[i, PENETRATION] - p_i)
    pairs[j, MOMENT] += pairs[j, CROSS] * (pairs[j, PENETRATION] - p_j)
    _write(pairs, i, max(f_i, 0.0), k_i)
    _write(pairs, j, max(f_j, 0.0), k_j)
    pairs[i, YIELD] = k_i * (1.0 - c * k_j) * inverse
    pairs[j, YIELD] = k_j * (1.0 - c * k_i) * inverse


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _state_before(pairs: FloatArray, i: int, before: int) -> tuple[float, float, float]:
    """Return force, stiffness and change of the penetration by itself since a state near by; zeros of another pair."""
    if pairs[before, PAIR] != pairs[i, PAIR]:
        return 0.0, 0.0, 0.0
    return pairs[before, NORMAL], pairs[before, STIFFNESS], pairs[i, ALONE] - pairs[before, ALONE]
