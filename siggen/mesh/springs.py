"""Spring of one pair from the table of the contact across the face, compiled: the narrow function of the time loop.

Equations: `siggen.mesh.contact_table`. A monotone cubic in the approach at the two columns beside the
position, linear between them; where gears tilt, `tilted_answer`. Numbers of one node stand side by side: all that the
table says of a pair on a ray is read at once, eight of them. Springs are numbers, or lanes of pairs.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from numba.extending import overload

from siggen.compiled import entry, njit
from siggen.lanes import (
    Choice,
    Lanes,
    Whole,
    any_of,
    as_doubles,
    extract,
    gather_between,
    gather_pairs,
    larger,
    load,
    magnitude,
    select,
    shuffle,
    smaller,
    square_root,
    truncated,
)
from siggen.lanes.kinds import LanesType
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
Value = Lanes
"""A number, or lanes of numbers."""


_COMPILED: Any = {"_nrt": False, "error_model": "numpy", "forceinline": True}
"""How numba compiles what depends on the kind of its values."""


class RayPlace(NamedTuple):
    """Where two columns begin at a node, the share of the upper one, the way behind the node and to the next [m]."""

    here: Whole
    there: Whole
    share: Value
    over: Value
    span: Value


class Cubic(NamedTuple):
    """Value, slope and second derivative of a cubic, and its integral from the node on."""

    value: Value
    slope: Value
    bend: Value
    area: Value


class AlongRay(NamedTuple):
    """W [J], W_r [N], W_rr [N/m], W_p [J], W_pr [N], W_prr [N/m], shares of carrying and of damage.

    Then what the table holds beside the rays (`contact_table`): without tilt T [N/m] and T_r; by how much W [J] is more
    than at the node before; W of the ray without tilt at that node [J], of the rays beside it; W_rrr and T_rr.
    """

    energy: Value
    radial: Value
    radial_slope: Value
    across: Value
    across_slope: Value
    across_bend: Value
    carrying: Value
    rough: Value
    turning: Value
    turning_slope: Value
    gained: Value
    beside: Value
    radial_bend: Value
    turning_bend: Value


class TiltedAnswer(NamedTuple):
    """Force [N], stiffness [N/m], moment [N m], dM/dd [N], dM/dθ [N m], shares of carrying and of damage."""

    force: Value
    stiffness: Value
    moment: Value
    cross: Value
    turning: Value
    carrying: Value
    rough: Value


NO_ANSWER = TiltedAnswer(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


class _Energy(NamedTuple):
    """W_r, W_p, W_rr, W_rp and W_pp."""

    radial: Value
    across: Value
    radial_slope: Value
    mixed: Value
    across_bend: Value


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _ray_before(p: Value) -> Value:
    """Return the number of the last ray that does not lie beyond p, of those with one behind."""
    size = magnitude(p)
    if not any_of(size >= _FIRST):
        return select(size < _FIRST, float(UPRIGHT), 0.0)
    beyond = select(size >= _FIRST, 1.0, 0.0) + select(size >= _SECOND, 1.0, 0.0) + select(size >= _THIRD, 1.0, 0.0)
    return select(size < _FIRST, float(UPRIGHT), select(p >= 0.0, UPRIGHT + beyond, UPRIGHT - 1.0 - beyond))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _ray(number: Value) -> Value:
    """Return p of a ray."""
    away = magnitude(number - UPRIGHT)
    size = select(away >= 1.0, select(away >= 2.0, select(away >= 3.0, select(away >= 4.0, _LAST, _THIRD), _SECOND),
        _FIRST), 0.0)  # fmt: skip
    return select(number >= UPRIGHT, size, size * -1.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _cubic(place: RayPlace, low: Value, slope_low: Value, high: Value, slope_high: Value) -> Cubic:
    """Return Hermite's cubic between two nodes; beyond the last one its slope stays."""
    over, span = place.over, place.span
    per_span, within = 1.0 / span, smaller(over, span)
    rise, t, beyond = (high - low) * per_span, within / span, over - within
    bend, twist = 3.0 * rise - 2.0 * slope_low - slope_high, slope_low + slope_high - 2.0 * rise
    value = low + within * (slope_low + t * (bend + t * twist))
    slope = slope_low + t * (2.0 * bend + 3.0 * t * twist)
    second = (2.0 * bend + 6.0 * t * twist) * per_span
    area = within * (low + within * (0.5 * slope_low + t * (bend / 3.0 + 0.25 * t * twist)))
    area = area + beyond * (value + 0.5 * beyond * slope)
    return Cubic(value + beyond * slope, slope, select(beyond > 0.0, 0.0, second), area)


def _along_ray(law: PairLaw, place: RayPlace, ray: Value) -> AlongRay:  # noqa: ARG001 - what compiled code calls
    """Return what stands along a ray at a radius; beyond the last node slopes stay."""
    raise TypeError("rays are read by compiled code")


@overload(_along_ray, strict=False, jit_options=_COMPILED)
def _along_ray_of(law: Any, place: Any, ray: Any) -> Any:  # noqa: ARG001 - names as those of the function
    found = _of_lanes if isinstance(ray, LanesType) else _of_row
    return lambda law, place, ray: found(law, place, ray)  # noqa: PLW0108 - numba takes no compiled function here


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _of_lanes(law: PairLaw, place: RayPlace, ray: Value) -> AlongRay:
    first, numbers = truncated(ray * TILTING_VALUES), law.numbers
    ahead = first + law.places[layout.CONTACT_VALUES]
    low = gather_between(numbers, place.here + first, place.there + first, place.share)
    high = gather_between(numbers, place.here + ahead, place.there + ahead, place.share)
    radial = _cubic(place, low[0], low[1], high[0], high[1])
    across = _cubic(place, low[4], low[5], high[4], high[5])
    turning = _cubic(place, low[6], low[7], high[6], high[7])
    t = smaller(place.over, place.span) / place.span
    return AlongRay(
        low[6] + radial.area, radial.value, radial.slope, across.value, across.slope, across.bend,
        low[2] + t * (high[2] - low[2]), low[3] + t * (high[3] - low[3]), turning.value, turning.slope, radial.area,
        low[7], radial.bend, turning.bend,
    )  # fmt: skip


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _of_row(law: PairLaw, place: RayPlace, ray: Value) -> AlongRay:
    # A number's eight values fill a register: one cubic does for all of them.
    first, numbers, share = truncated(ray * TILTING_VALUES), law.numbers, place.share
    ahead = first + law.places[layout.CONTACT_VALUES]
    low, high = load(numbers, place.here + first), load(numbers, place.here + ahead)
    low = low + share * (load(numbers, place.there + first) - low)
    high = high + share * (load(numbers, place.there + ahead) - high)
    cubic = _cubic(place, low, _slopes(low), high, _slopes(high))
    shares = low + smaller(place.over, place.span) / place.span * (high - low)
    value, slope, bend, area = cubic.value, cubic.slope, cubic.bend, extract(cubic.area, 0)
    return AlongRay(
        extract(low, 6) + area, extract(value, 0), extract(slope, 0), extract(value, 4), extract(slope, 4),
        extract(bend, 4), extract(shares, 2), extract(shares, 3), extract(value, 6), extract(slope, 6), area,
        extract(low, 7), extract(bend, 0), extract(bend, 6),
    )  # fmt: skip


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _beside(upright: AlongRay, energy: Value, p: Value, radius: Value) -> tuple[AlongRay, Value]:
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
def _between(low: AlongRay, high: AlongRay, width: Value, x: Value) -> _Energy:
    """Return the derivatives of Hermite's cubic in p between two rays, x of the width behind the first."""
    y = 1.0 - x
    h_1, g_0, g_1 = x * x * (3.0 - 2.0 * x), width * x * y * y, width * x * x * y * -1.0
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
def _chosen_ray(chosen: Choice, left: AlongRay, right: AlongRay) -> AlongRay:
    """Return the left one where chosen, of what `_between` asks for."""
    return AlongRay(
        select(chosen, left.energy, right.energy), select(chosen, left.radial, right.radial),
        select(chosen, left.radial_slope, right.radial_slope), select(chosen, left.across, right.across),
        select(chosen, left.across_slope, right.across_slope), select(chosen, left.across_bend, right.across_bend),
        right.carrying, right.rough, right.turning, right.turning_slope, right.gained, right.beside,
        right.radial_bend, right.turning_bend,
    )  # fmt: skip


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def tilted_answer(law: PairLaw, place: RayPlace, way: tuple[Value, Value, Value], touches: Choice) -> TiltedAnswer:
    """Return force and moment with their derivatives, of use where something touches.

    `way`: approach, lift of the ends and radius [m].
    """
    approach, lift, radius = way
    half_face = law.scalars[layout.CONTACT_HALF_FACE]
    p = lift / (radius + approach)
    ray = _ray_before(p)
    low = _along_ray(law, place, ray)
    carrying, rough = low.carrying, low.rough
    # Of the energy only derivatives are asked for.
    beside, bent = _beside(low, 0.0, p, radius)
    found = _Energy(beside.radial, beside.across, beside.radial_slope, beside.across_slope, bent)
    far = touches & (magnitude(p) > NEAR)
    if any_of(far):
        upright, ahead = ray == UPRIGHT, select(p > 0.0, 1.0, -1.0)
        behind = ray + select(upright, ahead, 1.0)
        first = select(upright, ahead * NEAR, _ray(ray))
        high, width = _along_ray(law, place, behind), _ray(behind) - first
        edge, _ = _beside(low, high.beside, first, radius)
        x = (p - first) / width
        between = _between(_chosen_ray(upright, edge, low), high, width, x)
        found = _Energy(
            select(far, between.radial, found.radial), select(far, between.across, found.across),
            select(far, between.radial_slope, found.radial_slope), select(far, between.mixed, found.mixed),
            select(far, between.across_bend, found.across_bend),
        )  # fmt: skip
        carrying = select(far, carrying + x * (high.carrying - carrying), carrying)
        rough = select(far, rough + x * (high.rough - rough), rough)
    cosine, sine, angle, inverse = approach / radius, lift / radius, 0.5 * (1.0 + p * p), 1.0 / radius
    turned = angle * found.across * inverse
    bend = angle * (angle * found.across_bend + p * found.across) * inverse * inverse
    h_rr = larger(found.radial_slope, 0.0)
    h_pp = larger(bend + found.radial * inverse, 0.0)
    most = square_root(h_rr * h_pp)
    h_rp = smaller(larger((angle * found.mixed - turned) * inverse, most * -1.0), most)
    twice = 2.0 * cosine * sine * h_rp
    return TiltedAnswer(
        cosine * found.radial - sine * turned,
        cosine * cosine * h_rr - twice + sine * sine * h_pp,
        half_face * (sine * found.radial + cosine * turned),
        half_face * (cosine * sine * (h_rr - h_pp) + (cosine * cosine - sine * sine) * h_rp),
        half_face * half_face * (sine * sine * h_rr + twice + cosine * cosine * h_pp),
        carrying,
        rough,
    )


class PairPlace(NamedTuple):
    """Where a pair is, for its spring: penetration by itself, its first touch, where its columns begin, their share.

    `whole`: stiffness of the whole face, all that a law without a table of the contact knows [N/m].
    """

    depth: Value
    touch: Value
    curves: Value
    share: Value
    whole: Value


class Spring(NamedTuple):
    """What a pair answers with at a penetration; fields are numbers, or lanes of them.

    Force [N], stiffness [N/m] and that to the approach of all pairs, 0 where nothing touches; penetration [m]; moment
    across the face [N m], dM/dd = dF/dθ [N] and dM/dθ [N m]; carrying share of the face and share of the load on
    damage.
    """

    force: Value
    stiffness: Value
    yielding: Value
    penetration: Value
    moment: Value
    cross: Value
    turning: Value
    carrying: Value
    rough: Value


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
    if law.places[layout.CONTACT_NODES] == 0:
        return flat_spring(pair.whole, penetration_m, 1.0)
    return contact_spring(law, pair, tilt, penetration_m)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def contact_spring(law: PairLaw, pair: PairPlace, tilt: Value, penetration_m: Value) -> Spring:
    """Return the same, or lanes of it, of a law with a table of the contact."""
    approach, half_face = penetration_m - pair.touch, law.scalars[layout.CONTACT_HALF_FACE]
    # A motion that diverges is no number in the end: it may not become a place in the table.
    if law.places[layout.CONTACT_VALUES] > 4:
        lift = tilt * half_face
        radius = square_root(approach * approach + lift * lift)
        touches = (radius > LEAST_M) & (magnitude(lift) < _LAST * (radius + approach))
        if not any_of(touches):
            return _where(touches, NO_ANSWER, penetration_m)
        radius = select(touches, radius, half_face)
        way = select(touches, approach, half_face), select(touches, lift, 0.0), radius
        found = tilted_answer(law, _node_place(law, pair, radius), way, touches)
        touches = touches & (found.force > 0.0)
        return _where(touches, found, penetration_m)
    touches = approach > 0.0
    if not any_of(touches):
        return _where(touches, NO_ANSWER, penetration_m)
    place = _node_place(law, pair, select(touches, approach, half_face))
    # Behind four values those of the next node follow in the same register.
    both = gather_between(law.numbers, place.here, place.there, pair.share)
    force, t = _cubic(place, both[0], both[1], both[4], both[5]), smaller(place.over, place.span) / place.span
    shares = both[2] + t * (both[6] - both[2]), both[3] + t * (both[7] - both[3])
    found = TiltedAnswer(force.value, force.slope, 0.0, 0.0, 0.0, shares[0], shares[1])
    return _where(touches, found, penetration_m)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _where(touches: Choice, found: TiltedAnswer, penetration_m: Value) -> Spring:
    """Return the spring of what touches, and none elsewhere."""
    stiffness = select(touches, found.stiffness, 0.0)
    return Spring(
        select(touches, found.force, 0.0), stiffness, stiffness, penetration_m, select(touches, found.moment, 0.0),
        select(touches, found.cross, 0.0), select(touches, found.turning, 0.0), select(touches, found.carrying, 1.0),
        select(touches, found.rough, 0.0),
    )  # fmt: skip


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _node_place(law: PairLaw, pair: PairPlace, way: Value) -> RayPlace:
    """Return where the node before a way [m] stands in both columns: the last but one from there on, however far."""
    nodes, values = law.places[layout.CONTACT_NODES], law.places[layout.CONTACT_VALUES]
    unit_m = law.scalars[layout.CONTACT_UNIT]
    node = truncated(smaller(square_root(way / unit_m), nodes - 2.0))
    before, here = as_doubles(node), truncated(pair.curves) + node * values
    over, span = way - unit_m * (before * before), unit_m * (2.0 * before + 1.0)
    return RayPlace(here, here + nodes * values, pair.share, over, span)


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
LEAST_CHANGE = 1e-5
"""Of the larger force, below which a light pair need not come."""
EXACT_CHANGE = 1e-8
"""Where forces stand for themselves: less than 1e-8 is left. Tangents that are cut to be convex leave 3e-8 at 1e-5."""
MOST_STEPS = 8


class Before(NamedTuple):
    """Force and stiffness of a pair in a state near by, and how far its depth by itself changed since."""

    force: float
    stiffness: float
    change: float


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
        least = min(settled, LEAST_CHANGE) * max(abs(f_i), abs(f_j))
        if abs(d_i) <= max(settled * abs(f_i), least) and abs(d_j) <= max(settled * abs(f_j), least):
            near = True
            break
    sprung_i = settled_spring(at_i, f_i, pair_i.depth - c * f_j, k_i * (1.0 - c * k_j) * inverse)
    return sprung_i, settled_spring(at_j, f_j, pair_j.depth - c * f_i, k_j * (1.0 - c * k_i) * inverse), near


NO_SPRING = Spring(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def settled_spring(last: Spring, force: Value, penetration_m: Value, yielding: Value) -> Spring:
    """Return the spring at the solution, of the last one that was asked for."""
    force = larger(force, 0.0)
    moment = last.moment + last.cross * (penetration_m - last.penetration)
    stiffness = select(force != 0.0, last.stiffness, 0.0)
    return Spring(
        force, stiffness, yielding, penetration_m, moment, last.cross, last.turning, last.carrying, last.rough
    )


# Where the load of a helical pair lies about the pitch point, compiled (derived: `siggen.gears.face_shares`).


class LoadPart(NamedTuple):
    """Share of the load of a pair, and the mean of its places [m]; numbers, or lanes of them."""

    share: Value
    place: Value


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def spread(law: PairLaw, position_m: Value) -> tuple[LoadPart, LoadPart]:
    """Return the load before and behind the pitch point of a pair whose middle of the face is at a position [m]."""
    scalars, points = law.scalars, law.places[layout.POINTS]
    along = (position_m - scalars[layout.START_M]) / scalars[layout.PITCH_M] * scalars[layout.PER_PITCH]
    along = smaller(larger(along, 0.0), points - 1.0)
    cell = smaller(truncated(along), points - 2)
    weight, first = along - as_doubles(cell), cell + law.places[layout.SPREAD_AT]
    share, before = _risen(law, first, weight), _risen(law, first + points, weight)
    behind = _risen(law, first + 2 * points, weight)
    return LoadPart(share, position_m + before), LoadPart(1.0 - share, position_m + behind)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _risen(law: PairLaw, first: Whole, weight: Value) -> Value:
    low, high = gather_pairs(law.numbers, first)
    return low + weight * (high - low)
