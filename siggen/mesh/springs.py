"""Spring of one pair from the table of the contact across the face, compiled: the narrow function of the time loop.

Equations: `siggen.mesh.contact_table`. A monotone cubic in the approach at the two columns beside the
position, linear between them; where gears tilt, `tilted_spring`. Numbers of one node stand side by side: all that the
table says of a pair on a ray is read at once, eight of them.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.lanes import Lanes, extract, load, shuffle
from siggen.mesh import pair_law as layout
from siggen.mesh.contact_table import TILTING_VALUES
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.tilt_rays import HALF_RAYS, NEAR, UPRIGHT

# Spring of one tilted pair from the energy that the table of the contact holds along rays, compiled.
#
# Equations: `siggen.mesh.tilt_rays`. With the lift τ = θ h of the ends of the face, r = √(d² + τ²), φ the
# angle from no tilt, and h μ the moment,
#
#     F = cos φ W_r - sin φ W_φ/r,   μ = sin φ W_r + cos φ W_φ/r,   W_φ = ½ (1 + p²) W_p.
#
# Second derivatives are those of the same function, cut to what is positive semi-definite, as the true energy is
# convex: the damper, which is made of them, never gives work.

_slopes = shuffle(1, 0, 3, 2, 5, 4, 7, 6)
_FIRST, _SECOND, _THIRD, _LAST = HALF_RAYS[1:]
LEAST_M = 1e-15
"""Radius below which nothing touches: far below an atom, and above where its square is no number."""


class RayPlace(NamedTuple):
    """Where two columns begin at a node, the share of the upper one, the way behind the node and to the next [m]."""

    here: int
    there: int
    share: float
    over: float
    span: float
    ahead: int


class AlongRay(NamedTuple):
    """W [J], W_r [N], W_rr [N/m], W_p [J], W_pr [N], W_prr [N/m], shares of carrying and of damage.

    Then what the table holds beside the rays (`contact_table`): without tilt T [N/m] and T_r; by how much W [J] is more
    than at the node before; W of the ray without tilt at that node [J], of the rays beside it; W_rrr and T_rr.
    """

    energy: float
    radial: float
    radial_slope: float
    across: float
    across_slope: float
    across_bend: float
    carrying: float
    rough: float
    turning: float
    turning_slope: float
    gained: float
    beside: float
    radial_bend: float
    turning_bend: float


class TiltedAnswer(NamedTuple):
    """Force [N], stiffness [N/m], moment [N m], dM/dd [N], dM/dθ [N m], shares of carrying and of damage."""

    force: float
    stiffness: float
    moment: float
    cross: float
    turning: float
    carrying: float
    rough: float


class _Energy(NamedTuple):
    """W_r, W_p, W_rr, W_rp and W_pp."""

    radial: float
    across: float
    radial_slope: float
    mixed: float
    across_bend: float


NO_ANSWER = TiltedAnswer(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def ray_before(p: float) -> int:
    """Return the number of the last ray that does not lie beyond p, of those with one behind."""
    size = abs(p)
    beyond = (1 if size >= _FIRST else 0) + (1 if size >= _SECOND else 0) + (1 if size >= _THIRD else 0)
    return UPRIGHT + beyond if p >= 0.0 else UPRIGHT - 1 - beyond


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _ray(number: int) -> float:
    """Return p of a ray."""
    away = abs(number - UPRIGHT)
    size = 0.0
    if away == 1:
        size = _FIRST
    elif away == 2:
        size = _SECOND
    elif away == 3:
        size = _THIRD
    elif away == 4:
        size = _LAST
    return size if number >= UPRIGHT else -size


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _across(numbers: FloatArray, here: int, there: int, share: float) -> Lanes:
    """Return eight values between two columns."""
    low = load(numbers, here)
    return low + share * (load(numbers, there) - low)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def along_ray(numbers: FloatArray, place: RayPlace, ray: int) -> AlongRay:
    """Return what stands along a ray at a radius; beyond the last node slopes stay."""
    first = ray * TILTING_VALUES
    low = _across(numbers, place.here + first, place.there + first, place.share)
    high = _across(numbers, place.here + place.ahead + first, place.there + place.ahead + first, place.share)
    s_0, s_1, over, span = _slopes(low), _slopes(high), place.over, place.span
    rise = (high - low) * (1.0 / span)
    bend, twist = 3.0 * rise - 2.0 * s_0 - s_1, s_0 + s_1 - 2.0 * rise
    within = min(over, span)
    t = within / span
    value, slope = low + within * (s_0 + t * (bend + t * twist)), s_0 + t * (2.0 * bend + 3.0 * t * twist)
    second = (2.0 * bend + 6.0 * t * twist) * (1.0 / span)
    area = within * (low + within * (0.5 * s_0 + t * (bend / 3.0 + 0.25 * t * twist)))
    shares, beyond = low + t * (high - low), over - within
    gained = extract(area, 0)
    if beyond > 0.0:
        gained += beyond * (extract(value, 0) + 0.5 * beyond * extract(slope, 0))
        value, second = value + beyond * slope, second * 0.0
    return AlongRay(
        extract(low, 6) + gained, extract(value, 0), extract(slope, 0), extract(value, 4), extract(slope, 4),
        extract(second, 4), extract(shares, 2), extract(shares, 3), extract(value, 6), extract(slope, 6), gained,
        extract(low, 7), extract(second, 0), extract(second, 6),
    )  # fmt: skip


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _beside(upright: AlongRay, energy: float, p: float, radius: float) -> tuple[AlongRay, float]:
    """Return what stands at a small p beside the ray without tilt, to the second order, and W_pp.

    `energy` [J]: W without tilt at the node before.
    """
    force, stiffness, turning = upright.radial, upright.radial_slope, upright.turning
    bent = 4.0 * radius * (radius * turning - force)
    steeper = 4.0 * (radius * (2.0 * turning + radius * upright.turning_slope - stiffness) - force)
    growing = radius * (4.0 * upright.turning_slope + radius * upright.turning_bend - upright.radial_bend)
    curved, half = 4.0 * (2.0 * (turning - stiffness) + growing), 0.5 * p * p
    beside = AlongRay(
        energy + upright.gained + p * upright.across + half * bent,
        force + p * upright.across_slope + half * steeper,
        stiffness + p * upright.across_bend + half * curved,
        upright.across + p * bent,
        upright.across_slope + p * steeper,
        upright.across_bend + p * curved,
        upright.carrying, upright.rough, turning, upright.turning_slope, upright.gained, energy,
        upright.radial_bend, upright.turning_bend,
    )  # fmt: skip
    return beside, bent


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _between(low: AlongRay, high: AlongRay, width: float, x: float) -> _Energy:
    """Return the derivatives of Hermite's cubic in p between two rays, x of the width behind the first."""
    y = 1.0 - x
    h_1, g_0, g_1 = x * x * (3.0 - 2.0 * x), width * x * y * y, -width * x * x * y
    d_1, e_0, e_1 = 6.0 * x * y / width, y * (1.0 - 3.0 * x), x * (3.0 * x - 2.0)
    c_1, b_0, b_1 = 6.0 * (1.0 - 2.0 * x) / (width * width), (6.0 * x - 4.0) / width, (6.0 * x - 2.0) / width
    risen, pushed = high.energy - low.energy, high.radial - low.radial
    steepened = high.radial_slope - low.radial_slope
    return _Energy(
        low.radial + h_1 * pushed + g_0 * low.across_slope + g_1 * high.across_slope,
        d_1 * risen + e_0 * low.across + e_1 * high.across,
        low.radial_slope + h_1 * steepened + g_0 * low.across_bend + g_1 * high.across_bend,
        d_1 * pushed + e_0 * low.across_slope + e_1 * high.across_slope,
        c_1 * risen + b_0 * low.across + b_1 * high.across,
    )


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def tilted_answer(
    numbers: FloatArray, place: RayPlace, way: tuple[float, float, float], half_face: float
) -> TiltedAnswer:
    """Return force and moment with their derivatives.

    `way`: approach, lift of the ends and radius [m].
    """
    approach, lift, radius = way
    p = lift / (radius + approach)
    size = abs(p)
    ray = UPRIGHT if size < _FIRST else ray_before(p)
    low = along_ray(numbers, place, ray)
    carrying, rough = low.carrying, low.rough
    if size <= NEAR:
        low, bent = _beside(low, 0.0, p, radius)  # of the energy only derivatives are asked for
        found = _Energy(low.radial, low.across, low.radial_slope, low.across_slope, bent)
    else:
        behind, first = ray + 1, _ray(ray)
        if ray == UPRIGHT:
            behind, first = (ray + 1, NEAR) if p > 0.0 else (ray - 1, -NEAR)
        high, width = along_ray(numbers, place, behind), _ray(behind) - first
        if ray == UPRIGHT:
            low, _ = _beside(low, high.beside, first, radius)
        x = (p - first) / width
        found = _between(low, high, width, x)
        carrying += x * (high.carrying - carrying)
        rough += x * (high.rough - rough)
    cosine, sine, angle, inverse = approach / radius, lift / radius, 0.5 * (1.0 + p * p), 1.0 / radius
    turned = angle * found.across * inverse
    bend = angle * (angle * found.across_bend + p * found.across) * inverse * inverse
    h_rr = max(found.radial_slope, 0.0)
    h_pp = max(bend + found.radial * inverse, 0.0)
    most = sqrt(h_rr * h_pp)
    h_rp = min(max((angle * found.mixed - turned) * inverse, -most), most)
    force = cosine * found.radial - sine * turned
    if not force > 0.0:
        return NO_ANSWER
    twice = 2.0 * cosine * sine * h_rp
    return TiltedAnswer(
        force,
        cosine * cosine * h_rr - twice + sine * sine * h_pp,
        half_face * (sine * found.radial + cosine * turned),
        half_face * (cosine * sine * (h_rr - h_pp) + (cosine * cosine - sine * sine) * h_rp),
        half_face * half_face * (sine * sine * h_rr + twice + cosine * cosine * h_pp),
        carrying,
        rough,
    )


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
    place, half_face = _node_place(law, pair, radius), law.scalars[layout.CONTACT_HALF_FACE]
    force, stiffness, moment, cross, turning, carrying, rough = tilted_answer(
        law.numbers, place, (approach_m, lift, radius), half_face
    )
    return Spring(force, stiffness, stiffness, penetration_m, moment, cross, turning, carrying, rough)


# Springs of two pairs on one gear body, compiled.
#
# Derived: each pair deflects the other's body, p_i = d_i - c f_j(p_j) and back. f is monotone, so Newton's method ends
# after a few steps with the solution; it exists and is unique while the coupling c stays below a pair's own
# compliance, since then the energy is strictly convex. It starts from the forces and tangents of a state near by; the
# tangent of ΣN to the approach of all follows from the same system: (I + diag(k) c) y = k.

SMOOTH_CHANGE = 0.02
"""Of each force: Newton's error is the curvature times the square of this over ten, below 1e-4 of that force.

A share of the larger one would let a pair that hardly touches be wrong by all of its force, however short the step:
1.3e-3 of the accelerations at 0.9 Hz.
"""
EXACT_CHANGE = 1e-5
"""Of the larger force, what is settled in any case; where forces stand for themselves less than 1e-9 is left."""
MOST_STEPS = 8


class Before(NamedTuple):
    """Force and stiffness of a pair in a state near by, and how far its depth by itself changed since."""

    force: float
    stiffness: float
    change: float


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def alone_spring(law: PairLaw, pair: PairPlace, tilt: float) -> Spring:
    """Return the spring of a pair at its own depth."""
    return _pushed(pair_spring(law, pair, tilt, pair.depth))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def two_springs(
    law: PairLaw, coupling: float, tilt: float, settled: float, pair_i: PairPlace, pair_j: PairPlace,
    before: tuple[Before, Before],
) -> tuple[Spring, Spring, bool]:  # fmt: skip
    """Return the springs of two drive flanks, and whether they settled to a share of their force, or near enough.

    Parameters
    ----------
    law : PairLaw
    coupling : float
        Deflection at one pair per unit force at the other [m/N].
    tilt : float
        [rad]
    settled : float
        SMOOTH_CHANGE or EXACT_CHANGE.
    pair_i, pair_j : PairPlace
    before : (Before, Before)
        Zeros where another pair was there.
    """
    c, (f_i, k_i, d_i), (f_j, k_j, d_j) = coupling, before[0], before[1]
    inverse = 1.0 / (1.0 - k_i * k_j * c * c)
    f_i, f_j = f_i + k_i * (d_i - c * k_j * d_j) * inverse, f_j + k_j * (d_j - c * k_i * d_i) * inverse
    near = settled >= SMOOTH_CHANGE
    at_i, at_j = NO_SPRING, NO_SPRING
    for _ in range(MOST_STEPS):
        at_i = pair_spring(law, pair_i, tilt, pair_i.depth - c * f_j)
        at_j = pair_spring(law, pair_j, tilt, pair_j.depth - c * f_i)
        k_i, k_j = at_i.stiffness, at_j.stiffness
        inverse = 1.0 / (1.0 - k_i * k_j * c * c)
        d_i = (at_i.force - f_i - k_i * c * (at_j.force - f_j)) * inverse
        d_j = (at_j.force - f_j - k_j * c * (at_i.force - f_i)) * inverse
        f_i, f_j = f_i + d_i, f_j + d_j
        least = EXACT_CHANGE * max(abs(f_i), abs(f_j))
        if abs(d_i) <= max(settled * abs(f_i), least) and abs(d_j) <= max(settled * abs(f_j), least):
            near = True
            break
    sprung_i = _settled(at_i, f_i, pair_i.depth - c * f_j, k_i * (1.0 - c * k_j) * inverse)
    return sprung_i, _settled(at_j, f_j, pair_j.depth - c * f_i, k_j * (1.0 - c * k_i) * inverse), near


NO_SPRING = Spring(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _pushed(spring: Spring) -> Spring:
    """Return a spring without stiffness where it has no force."""
    stiffness = spring.stiffness if spring.force != 0.0 else 0.0
    return Spring(
        spring.force, stiffness, stiffness, spring.penetration, spring.moment, spring.cross, spring.turning,
        spring.carrying, spring.rough,
    )  # fmt: skip


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _settled(last: Spring, force: float, penetration_m: float, yielding: float) -> Spring:
    """Return the spring at the solution, of the last one that was asked for."""
    force = max(force, 0.0)
    moment = last.moment + last.cross * (penetration_m - last.penetration)
    stiffness = last.stiffness if force != 0.0 else 0.0
    return Spring(
        force, stiffness, yielding, penetration_m, moment, last.cross, last.turning, last.carrying, last.rough
    )


# Where the load of a helical pair lies about the pitch point, compiled (derived: `siggen.gears.face_shares`).


class LoadPart(NamedTuple):
    """Share of the load of a pair, and the mean of its places [m]."""

    share: float
    place: float


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def spread(law: PairLaw, position_m: float) -> tuple[LoadPart, LoadPart]:
    """Return the load before and behind the pitch point of a pair whose middle of the face is at a position [m]."""
    scalars, numbers, points = law.scalars, law.numbers, law.places[layout.POINTS]
    along = (position_m - scalars[layout.START_M]) / scalars[layout.PITCH_M] * scalars[layout.PER_PITCH]
    along = min(max(along, 0.0), points - 1.0)
    cell = min(int(along), points - 2)
    weight = along - cell
    first = law.places[layout.SPREAD_AT] + cell
    share = numbers[first] + weight * (numbers[first + 1] - numbers[first])
    first += points
    before = numbers[first] + weight * (numbers[first + 1] - numbers[first])
    first += points
    behind = numbers[first] + weight * (numbers[first + 1] - numbers[first])
    return LoadPart(share, position_m + before), LoadPart(1.0 - share, position_m + behind)
