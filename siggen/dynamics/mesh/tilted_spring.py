r"""Spring of one tilted pair from the energy that the table of the contact holds along rays, compiled.

Equations: `siggen.gears.contact.tilt_rays`. With the lift τ = θ h of the ends of the face, r = √(d² + τ²), φ the angle
from no tilt, and h μ the moment,

    F = cos φ W_r - sin φ W_φ/r,   μ = sin φ W_r + cos φ W_φ/r,   W_φ = ½ (1 + p²) W_p.

Second derivatives are those of the same function, cut to what is positive semi-definite, as the true energy is convex:
the damper, which is made of them, never gives work.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.gears.contact.table_columns import TILTING_VALUES
from siggen.gears.contact.tilt_rays import HALF_RAYS, UPRIGHT
from siggen.lanes import Lanes, extract, load, shuffle

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
    """W [J], W_r [N], W_rr [N/m], W_p [J], W_pr [N], W_prr [N/m], shares of carrying and of damage."""

    energy: float
    radial: float
    radial_slope: float
    across: float
    across_slope: float
    across_bend: float
    carrying: float
    rough: float


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
    energy, curved = extract(low, 6) + extract(area, 0), extract(second, 4)
    if beyond > 0.0:
        energy += beyond * (extract(value, 0) + 0.5 * beyond * extract(slope, 0))
        value, curved = value + beyond * slope, 0.0
    return AlongRay(
        energy, extract(value, 0), extract(slope, 0), extract(value, 4), extract(slope, 4), curved,
        extract(shares, 2), extract(shares, 3),
    )  # fmt: skip


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
    low: AlongRay, high: AlongRay, ray: int, way: tuple[float, float, float], half_face: float
) -> TiltedAnswer:
    """Return force and moment with their derivatives between two rays.

    `way`: approach, lift of the ends and radius [m].
    """
    approach, lift, radius = way
    first = _ray(ray)
    width = _ray(ray + 1) - first
    p = lift / (radius + approach)
    x = (p - first) / width
    found = _between(low, high, width, x)
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
        low.carrying + x * (high.carrying - low.carrying),
        low.rough + x * (high.rough - low.rough),
    )
