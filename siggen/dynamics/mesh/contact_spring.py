"""Spring of one pair from the table of the contact across the face, compiled: the narrow function of the time loop.

Equations: `siggen.gears.contact.contact_table`. A monotone cubic in the approach at the two columns beside the
position, linear between them; where gears tilt, `tilted_spring`. Numbers of one node stand side by side: all that the
table says of a pair on a ray is read at once, eight of them.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.mesh.tilted_spring import LEAST_M, RayPlace, along_ray, ray_before, tilted_answer
from siggen.gears.contact.tilt_rays import HALF_RAYS
from siggen.lanes import Lanes, extract, load, shuffle

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


@entry(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def pair_spring(law: PairLaw, pair: PairPlace, tilt: float, penetration_m: float) -> Spring:
    """Return the spring of the drive flank of a pair at a tilt [rad] and at an approach beyond missing material [m]."""
    nodes, values = law.places[layout.CONTACT_NODES], law.places[layout.CONTACT_VALUES]
    if nodes == 0:
        return flat_spring(pair.whole, penetration_m, 1.0)
    approach = penetration_m - pair.touch
    if values > 4:
        return _tilted_spring(law, pair, tilt, approach, penetration_m)
    if not approach > 0.0:  # a motion that diverges is no number in the end: it may not become a place in the table
        return Spring(0.0, 0.0, 0.0, penetration_m, 0.0, 0.0, 0.0, 1.0, 0.0)
    place = _node_place(law, pair, approach)
    low = _across(law.numbers, place.here, place.there, pair.share)
    high = _next_node(low)  # behind four values that of the next node follows in the same register
    s_0, s_1, over, span = _slopes(low), _slopes(high), place.over, place.span
    per_span = 1.0 / span
    t = over * per_span
    if t > 1.0:  # beyond the last node the slope stays
        value, slope = high + s_1 * (over - 1.0 / per_span), s_1
    else:
        rise = (high - low) * per_span
        bend, twist = 3.0 * rise - 2.0 * s_0 - s_1, s_0 + s_1 - 2.0 * rise
        value, slope = low + over * (s_0 + t * (bend + t * twist)), s_0 + t * (2.0 * bend + 3.0 * t * twist)
    shares = low + min(t, 1.0) * (high - low)
    force, stiffness = extract(value, 0), extract(slope, 0)
    carrying, rough = extract(shares, 2), extract(shares, 3)
    return Spring(force, stiffness, stiffness, penetration_m, 0.0, 0.0, 0.0, carrying, rough)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _node_place(law: PairLaw, pair: PairPlace, way: float) -> RayPlace:
    """Return where the node before a way [m] stands in both columns."""
    nodes, values = law.places[layout.CONTACT_NODES], law.places[layout.CONTACT_VALUES]
    unit_m = law.scalars[layout.CONTACT_UNIT]
    root = sqrt(way / unit_m)
    node = int(root) if root < nodes - 1.0 else nodes - 2  # the last but one from there on, however far
    here = int(pair.curves) + node * values
    over, span = way - unit_m * (node * node), unit_m * (2.0 * node + 1.0)
    return RayPlace(here, here + nodes * values, pair.share, over, span, values)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _tilted_spring(law: PairLaw, pair: PairPlace, tilt: float, approach_m: float, penetration_m: float) -> Spring:
    """Return the spring of a face whose ends may lift before all of it touches."""
    lift = tilt * law.scalars[layout.CONTACT_HALF_FACE]
    radius = sqrt(approach_m * approach_m + lift * lift)
    if not (radius > LEAST_M and abs(lift) < HALF_RAYS[-1] * (radius + approach_m)):
        return Spring(0.0, 0.0, 0.0, penetration_m, 0.0, 0.0, 0.0, 1.0, 0.0)
    ray = ray_before(lift / (radius + approach_m))
    place = _node_place(law, pair, radius)
    low, high = along_ray(law.numbers, place, ray), along_ray(law.numbers, place, ray + 1)
    way, half_face = (approach_m, lift, radius), law.scalars[layout.CONTACT_HALF_FACE]
    force, stiffness, moment, cross, turning, carrying, rough = tilted_answer(low, high, ray, way, half_face)
    return Spring(force, stiffness, stiffness, penetration_m, moment, cross, turning, carrying, rough)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _across(numbers: FloatArray, here: int, there: int, share: float) -> Lanes:
    """Return eight values between two columns."""
    low = load(numbers, here)
    return low + share * (load(numbers, there) - low)
