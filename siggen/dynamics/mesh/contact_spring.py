"""Spring of one pair from the table of the contact across the face, compiled: the narrow function of the time loop.

Equations: `siggen.gears.contact.contact_table`. A monotone cubic in the approach at the two columns beside the
position, linear between them; an expansion in the tilt. Numbers of one node stand side by side: all that the table says
of a pair is read at once, eight of them.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.lanes import LANES, Lanes, extract, load, shuffle, splat

_slopes = shuffle(1, 0, 3, 2, 5, 4, 7, 6)
_next_node = shuffle(4, 5, 6, 7, 4, 5, 6, 7)


class PairPlace(NamedTuple):
    """Where a pair is, for its spring: penetration by itself, its first touch, where its columns begin, their share.

    `whole`: stiffness of the whole face, all that a law without a table of the contact knows [N/m].
    """

    depth: float
    touch: float
    curves: float
    share: float
    whole: float


class Spring(NamedTuple):
    """What a pair answers with at a penetration; fields are numbers, or lanes of them.

    Force [N], stiffness [N/m] and that to the approach of all pairs, 0 where nothing touches; penetration [m]; moment
    across the face [N m], dM/dd = dF/dθ [N] and dM/dθ [N m]; carrying share of the face and share of the load on
    damage.
    """

    force: float
    stiffness: float
    yielding: float
    penetration: float
    moment: float
    cross: float
    turning: float
    carrying: float
    rough: float


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def flat_spring(stiffness: float, penetration_m: float, side: float) -> Spring:
    """Return the spring of a face that touches as a whole; `side` is -1 for the back flank, which pushes back."""
    if not side * penetration_m > 0.0:
        return Spring(0.0, 0.0, 0.0, penetration_m, 0.0, 0.0, 0.0, 1.0, 0.0)
    force = stiffness * penetration_m
    return Spring(force, stiffness, stiffness, penetration_m, 0.0, 0.0, 0.0, 1.0, 0.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def pair_spring(law: PairLaw, pair: PairPlace, tilt: float, penetration_m: float) -> Spring:
    """Return the spring of the drive flank of a pair at a tilt [rad] and at an approach beyond missing material [m]."""
    nodes, values = law.places[layout.CONTACT_NODES], law.places[layout.CONTACT_VALUES]
    if nodes == 0:
        return flat_spring(pair.whole, penetration_m, 1.0)
    approach = penetration_m - pair.touch
    if not approach > 0.0:  # a motion that diverges is no number in the end: it may not become a place in the table
        return Spring(0.0, 0.0, 0.0, penetration_m, 0.0, 0.0, 0.0, 1.0, 0.0)
    unit_m = law.scalars[layout.CONTACT_UNIT]
    root = sqrt(approach / unit_m)
    node = int(root) if root < nodes - 1.0 else nodes - 2  # the last but one from there on, however far
    span = unit_m * (2.0 * node + 1.0)
    over = approach - unit_m * (node * node)
    per_span = 1.0 / span
    t = over * per_span
    here = int(pair.curves) + node * values
    there = here + nodes * values
    low = _across(law.numbers, here, there, pair.share)
    high = _next_node(low)  # behind four values that of the next node follows in the same register
    if values > 4:
        high = _across(law.numbers, here + LANES, there + LANES, pair.share)
    # Cubics of force, moment and what turns it in lanes 0, 4 and 6, whose slopes stand beside them; shares in 2 and 3.
    s_0, s_1 = _slopes(low), _slopes(high)
    if t > 1.0:  # beyond the last node the slope stays
        value, slope, second = high + s_1 * (over - 1.0 / per_span), s_1, splat(0.0)
    else:
        rise = (high - low) * per_span
        bend, twist = 3.0 * rise - 2.0 * s_0 - s_1, s_0 + s_1 - 2.0 * rise
        value, slope = low + over * (s_0 + t * (bend + t * twist)), s_0 + t * (2.0 * bend + 3.0 * t * twist)
        second = (2.0 * bend + 6.0 * t * twist) * per_span
    shares = low + min(t, 1.0) * (high - low)
    carrying, rough = extract(shares, 2), extract(shares, 3)
    force, stiffness = extract(value, 0), extract(slope, 0)
    if values == 4:
        return Spring(force, stiffness, stiffness, penetration_m, 0.0, 0.0, 0.0, carrying, rough)
    force += tilt * (extract(slope, 4) + 0.5 * tilt * extract(slope, 6))
    stiffness += tilt * (extract(second, 4) + 0.5 * tilt * extract(second, 6))
    moment, cross = extract(value, 4) + extract(value, 6) * tilt, extract(slope, 4) + extract(slope, 6) * tilt
    force, stiffness = max(force, 0.0), max(stiffness, 0.0)
    return Spring(force, stiffness, stiffness, penetration_m, moment, cross, extract(value, 6), carrying, rough)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _across(numbers: FloatArray, here: int, there: int, share: float) -> Lanes:
    """Return eight values between two columns."""
    low = load(numbers, here)
    return low + share * (load(numbers, there) - low)
