r"""Sink of a line contact at one edge of the surface: exact for a half plane, fitted for the notch behind the edge.

A contact of relative radius R and line load F has the Hertz half width a = √(2 R κ F), κ = 2/(π E*). The surface ends
at the signed distance d ahead of the common normal (negative: the normal is already beyond the edge), d̂ = d/a. The
*sink* is the approach less Hertz's approach at the same load and the same far datum.

Derived. The contact [-b, d] is bounded at -b and singular at d; the singular integral equation of a parabola gives its
half length c a and

    c = (d̂ + √(d̂² + 3))/3,   sink/(κF) = G = -ln c + (3c² - 1)(c² - 1)/(4c²)   for d̂ < 1,   0 beyond,

and the distance of the load's centroid from the edge, a c² (2c - d̂). Deep in the gap G = d̂² + ½ + ln(2|d̂|): the first
term is the rigid sink d²/2R, the rest the elasticity of a contact that narrows to c a = a²/(2|d|).

The notch of depth D behind the edge takes away material that would have carried: + N. Derived: a narrow load at the
corner of a quarter plane is softer than on a half plane by ½ [(π/2)(1/(π/2 + 1) + 1/(π/2 - 1)) - 1] = 1.1815 κ per unit
of ln(D/distance), Poisson's ratio drops out. Fitted to plane finite elements (`reference.contact`, ν = 0.3, D/a from
0.35 to 8.4, d̂ from -16 to 2): the course in between, with z = D/(x a) over the distance x a = a (2c + c⁴)/3 from the
edge (d beyond d̂ = 1). Error 3 % of N for D > a/2 and d̂ <= 0.5, at most 0.02 κF beyond d̂ = 1.

A rounded edge (radius r, tangent to the flank where the outline is, falling away inside the gap) has two limits, the
sharp edge and Hertz's contact of the two radii; between them the elastic parts combine by their contact widths,

    e = d²/(2(R + r)) - κF · ½ ln(w + ε (1 - w⁸)),   ε = r/(R + r),   w = exp(-2 (G - d̂²)) (d̂² for d̂ < 0 only);

the eighth power, fitted, lets the rounding end with the sink at d̂ = 1. The law holds

within 7 % of the elastic part against pressure cells (`tests.reference.contact`, r 0.02 to 0.2 mm).
"""

from __future__ import annotations

from math import exp, log, pi, sqrt
from typing import NamedTuple

from siggen.compiled import entry, njit

QUARTER_PLANE = 1.1815
"""Derived: see the module's docstring."""
NOTCH_POWER = 1.25
NOTCH_SCALE, NOTCH_ON_LAND, NOTCH_SHALLOW, NOTCH_SHALLOW_LINEAR = 0.311, 0.278, 0.262, 0.363
"""Fitted by `python -m tests.reference.contact`."""
NO_EDGE = 1e30
"""Distance of an edge that does not exist [m]."""


class EdgeTerms(NamedTuple):
    """Of one edge under the load u = κF [m]: what the coupled law of two edges needs, with derivatives to ln u.

    `factor`: sink over u; `factor_slope`: its derivative to ln u; `centroid_m`: distance of the load from the edge;
    `centroid_slope_m`: its derivative to ln u.
    """

    factor: float
    factor_slope: float
    centroid_m: float
    centroid_slope_m: float


@njit(cache=True, _nrt=False, error_model="numpy")
def half_length(ahead: float) -> float:
    """Return c, the contact's half length over a, at d̂ = `ahead` (1 at d̂ = 1)."""
    return _length_and_slope(ahead)[0]


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _length_and_slope(ahead: float) -> tuple[float, float]:
    """Return c and dc/dd̂."""
    root = sqrt(ahead * ahead + 3.0)
    # the same number; the first form loses all digits deep in the gap
    c = 1.0 / (root - ahead) if ahead < 0.0 else (ahead + root) / 3.0
    return c, c / root


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _notch_and_slope(ahead: float, depth: float, rounding: float, length: tuple[float, float]) -> tuple[float, float]:
    """Return N, what a notch behind the edge adds to G, and dN/d(ln u).

    Parameters
    ----------
    ahead : d̂
    depth : D/a; 0 for none
    rounding : ε = r/(R + r) of the edge, which keeps the load at least 2/3 √ε a from the corner
    length : of `_length_and_slope`

    Notes
    -----
    d̂ and D/a both fall as u^-½.
    """
    if depth <= 0.0 or ahead > 1e3:
        return 0.0, 0.0
    c, c_slope = length
    if ahead < 1.0:
        distance, distance_slope = (2.0 * c + c**4) / 3.0, (2.0 + 4.0 * c**3) / 3.0 * c_slope
    else:
        distance, distance_slope = ahead, 1.0
    if rounding > 0.0:
        sharp = distance
        distance = sqrt(sharp * sharp + 4.0 / 9.0 * rounding)
        distance_slope *= sharp / distance
    z = depth / distance
    # logarithmic slopes to ln u
    z_log = -0.5 + 0.5 * ahead * distance_slope / distance
    w = c**4
    w_log = 4.0 * (-0.5 * ahead * c_slope / c)
    land = NOTCH_ON_LAND * w / (1.0 + w / 6.0)
    scale = NOTCH_SCALE * (1.0 + land)
    scale_log = land / (1.0 + land) * w_log / (1.0 + w / 6.0)
    shallow = NOTCH_SHALLOW + NOTCH_SHALLOW_LINEAR * z
    below = w * shallow + z * z
    below_log = (w * (shallow * w_log + NOTCH_SHALLOW_LINEAR * z * z_log) + 2.0 * z * z * z_log) / below
    base = scale * z
    # base^NOTCH_POWER by roots, three times as fast as a power
    power = base * sqrt(sqrt(base)) * z * z / below
    power_log = NOTCH_POWER * (scale_log + z_log) + 2.0 * z_log - below_log
    strength = QUARTER_PLANE / NOTCH_POWER
    return strength * log(1.0 + power), strength * power / (1.0 + power) * power_log


@entry(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def edge_terms(ahead_m: float, depth_m: float, radius_m: float, rounding_m: float, load_m: float) -> EdgeTerms:
    """Return the terms of one edge.

    Parameters
    ----------
    ahead_m : d, distance from the common normal to the edge, negative beyond it [m]
    depth_m : D, depth of the notch behind the edge, 0 for none [m]
    radius_m, rounding_m : R, and the edge's radius r, 0 for a sharp one [m]
    load_m : κF > 0 [m]
    """
    width = sqrt(2.0 * radius_m * load_m)
    ahead = ahead_m / width
    share = rounding_m / (radius_m + rounding_m)
    if ahead >= 1.0 and depth_m <= 0.0:
        return EdgeTerms(0.0, 0.0, ahead_m, 0.0)
    c, c_slope = _length_and_slope(ahead)
    notch, notch_slope = _notch_and_slope(ahead, depth_m / width, share, (c, c_slope))
    if ahead >= 1.0:
        return EdgeTerms(notch, notch_slope, ahead_m, 0.0)
    square = c * c
    factor = -log(c) + (3.0 * square - 1.0) * (square - 1.0) / (4.0 * square)
    by_c = -1.0 / c + 1.5 * c - 0.5 / (square * c)
    slope = by_c * c_slope * (-0.5 * ahead)
    if rounding_m > 0.0:
        rigid = ahead * ahead if ahead < 0.0 else 0.0
        narrow = exp(-2.0 * (factor - rigid))
        mixed = narrow + share * (1.0 - narrow**8)
        elastic_slope = slope + rigid
        factor = rigid * (1.0 - share) - 0.5 * log(mixed)
        slope = -rigid * (1.0 - share) + narrow * (1.0 - 8.0 * share * narrow**7) / mixed * elastic_slope
    reach = square * (2.0 * c - ahead)
    reach_by_ahead = 2.0 * c * c_slope * (2.0 * c - ahead) + square * (2.0 * c_slope - 1.0)
    centroid_slope = 0.5 * width * (reach - ahead * reach_by_ahead)
    return EdgeTerms(factor + notch, slope + notch_slope, width * reach, centroid_slope)


# Sink of a line contact over a gap with two edges: one scalar equation for the share of either edge.
#
# Derived. With the normal at the distances x₁, x₂ from the edges (l = x₁ + x₂; negative: still on that land), F = F₁ +
# F₂ and a_i the Hertz half width of F_i alone,
#
#     δ = κF₁ [ln(2/a₁) + ½ + G(-x₁/a₁) + N₁] - κF₂ ln λ
#     δ = κF₂ [ln(2/a₂) + ½ + G(-x₂/a₂) + N₂] - κF₁ ln λ
#     sink = δ - κF [ln(2/a) + ½]
#
# since either land sinks in the far field of the other's load, λ = l plus the distances of both centroids from their
# edges. An edge that would have to pull carries nothing. Against pressure cells on a half plane (`reference.contact`):
# 0.005 µm; with the notch against plane finite elements: 0.05 µm, 4 % of what the notch adds for D = 0.2 mm.
#
# A gap narrower than the contact is no far field any more. Exact for a gap in the middle of a contact: its pressure is
# |x| √(b² - x²)/√(x² - l²/4) with b² = a² + l²/4, and the sink is l²/8R, that of a rigid body, at every load. Off the
# middle it stays within 1 % of that until one edge alone carries less. So the sink of narrow gaps is the lesser of
# both, joined by the power `NARROW_POWER`, and with (l/a)⁴ over `NARROW` it goes over into that of two edges. Against
# pressure cells, gaps of 0.1 to 7 a: 0.025 κF at most, and a gap that closes sinks no more.
#
# The floor of the gap carries from the sink D on; the two limits are joined over `FLOOR_ROUNDING` κF, with
# `FLOOR_LIFT` of that on top of D, so that joining them never makes the sink fall with the load (derived: lift x least
# slope of the edges' sink inside a gap, 0.42, must be 1/8).

FLOOR_ROUNDING, FLOOR_LIFT = 0.5, 0.3
NARROW, NARROW_POWER = 2.0, 6
NEGLIGIBLE = 1e-3
LARGEST_PASSES = 60
SHARE_TOLERANCE = 1e-12


class GapSink(NamedTuple):
    """Sink over a gap [m], its derivative to κF, and the part of the load on the left edge (0 to 1)."""

    sink_m: float
    slope: float
    left_share: float


@entry(cache=True, _nrt=False, error_model="numpy")
def gap_sink(
    left_m: float, right_m: float, notch_m: float, floor_m: float, radius_m: float, rounding_m: float, load_m: float
) -> GapSink:
    """Return the sink at one slice.

    Parameters
    ----------
    left_m, right_m : x₁ and x₂, distances from the normal back to the left and on to the right edge [m]; `NO_EDGE`
        where the land is missing on that side, `-NO_EDGE` for both: no gap at all
    notch_m, floor_m : depth D of the notch behind the edges, and of the floor below the normal; 0 for none [m]
    radius_m, rounding_m : R, and the radius of the edges, 0 for sharp ones [m]
    load_m : κF [m]; at 0 the rigid sink, whose slope is infinite inside the gap
    """
    if load_m <= 0.0:
        return _rigid(left_m, right_m, floor_m, radius_m + rounding_m)
    edges = _edges(left_m, right_m, notch_m, radius_m, rounding_m, load_m)
    if floor_m <= 0.0 or edges.sink_m <= 0.0:
        return edges
    # smooth lesser of the edges' sink and the floor's, of degree 1 in (sink, load)
    span = FLOOR_ROUNDING * load_m
    floor, rise = floor_m + FLOOR_LIFT * span, FLOOR_LIFT * FLOOR_ROUNDING
    above = edges.sink_m - floor
    root = sqrt(above * above + span * span)
    sink = 0.5 * (edges.sink_m + floor - root)
    slope = 0.5 * (edges.slope + rise - (above * (edges.slope - rise) + FLOOR_ROUNDING * span) / root)
    return GapSink(sink, slope, edges.left_share)


@njit(cache=True, _nrt=False, error_model="numpy")
def _rigid(left_m: float, right_m: float, floor_m: float, radius_m: float) -> GapSink:
    near = max(min(left_m, right_m), 0.0)
    sink = near * near / (2.0 * radius_m)
    if floor_m > 0.0:
        sink = min(sink, floor_m)
    share = 0.5 if left_m == right_m else 1.0 if left_m < right_m else 0.0
    return GapSink(sink, 0.0, share)


@njit(cache=True, _nrt=False, error_model="numpy")
def _edges(left_m: float, right_m: float, notch_m: float, radius_m: float, rounding_m: float, load_m: float) -> GapSink:
    """Return the sink on the edges alone."""
    swapped = right_m < left_m
    near, far = (right_m, left_m) if swapped else (left_m, right_m)
    sink, slope, share = _far_fields(near, far, notch_m, radius_m, rounding_m, load_m)
    square = 2.0 * radius_m * load_m
    if far < 0.5 * NO_EDGE and near > -sqrt(square):
        narrow = NARROW * square * square
        narrow /= narrow + (near + far) ** 4
        if narrow > NEGLIGIBLE:
            more, steeper, _ = (
                _far_fields(near, far, 0.0, radius_m, rounding_m, load_m) if notch_m > 0.0 else (sink, slope, share)
            )
            least, least_slope = _narrow(near, far, radius_m, rounding_m, load_m)
            slope += narrow * (least_slope - steeper) + 2.0 * narrow * (1.0 - narrow) / load_m * (least - more)
            sink += narrow * (least - more)
    return GapSink(sink, slope, 1.0 - share if swapped else share)


@njit(cache=True, _nrt=False, error_model="numpy")
def _narrow(near: float, far: float, radius: float, rounding: float, load: float) -> tuple[float, float]:
    """Return sink and slope over a gap without a notch that is narrower than its contact."""
    one = edge_terms(-near, 0.0, radius, rounding, load)
    single = load * one.factor
    if single <= 0.0:
        return 0.0, 0.0
    rigid = (near + far) ** 2 / (8.0 * (radius + rounding))
    part = rigid / (single + rigid)
    # the power mean of both in a form that bears a rigid sink of 0
    least = part * single / (part**NARROW_POWER + (1.0 - part) ** NARROW_POWER) ** (1.0 / NARROW_POWER)
    return least, (least / single) ** (NARROW_POWER + 1) * (one.factor + one.factor_slope)


@njit(cache=True, _nrt=False, error_model="numpy")
def _far_fields(
    near: float, far: float, depth: float, radius: float, rounding: float, load: float
) -> tuple[float, float, float]:
    """Return sink, slope and the near edge's share, of one edge or two in each other's far field."""
    one = edge_terms(-near, depth, radius, rounding, load)
    width = sqrt(2.0 * radius * load)
    if far < 0.5 * NO_EDGE and near > -width:
        # the far land, unloaded, sinks in the near one's field; it touches once the approach exceeds its gap
        apart = log(near + far + one.centroid_m)
        reach = max(far, 0.0)
        approach = load * (log(2.0 / width) + 0.5 + one.factor)
        if approach > reach * reach / (2.0 * (radius + rounding)) - load * apart:
            return _shared(near, far, depth, radius, rounding, load)
    return load * one.factor, one.factor + one.factor_slope, 1.0


@njit(cache=True, _nrt=False, error_model="numpy")
def _shared(
    near: float, far: float, depth: float, radius: float, rounding: float, load: float
) -> tuple[float, float, float]:
    """Return sink, slope and the near edge's share where both edges carry."""
    low, high = 0.0, load
    first = 0.5 * load
    for _ in range(LARGEST_PASSES):
        second = load - first
        one = edge_terms(-near, depth, radius, rounding, first)
        two = edge_terms(-far, depth, radius, rounding, second)
        # ln(2/a_i) + ½ and its derivative -½ to ln u_i
        one_open = 0.5 - 0.5 * log(0.5 * radius * first) + one.factor
        two_open = 0.5 - 0.5 * log(0.5 * radius * second) + two.factor
        length = near + far + one.centroid_m + two.centroid_m
        apart = log(length)
        rest = first * one_open - second * two_open + (first - second) * apart
        a11 = one_open - 0.5 + one.factor_slope - second / first * one.centroid_slope_m / length
        a12 = -apart - two.centroid_slope_m / length
        a21 = -apart - one.centroid_slope_m / length
        a22 = two_open - 0.5 + two.factor_slope - first / second * two.centroid_slope_m / length
        if rest > 0.0:
            high = first
        else:
            low = first
        change = -rest / (a11 - a21 + a22 - a12)
        moved = first + change
        if moved <= low:
            moved = 0.5 * (first + low)
        elif moved >= high:
            moved = 0.5 * (first + high)
        if abs(moved - first) <= SHARE_TOLERANCE * load:
            break
        first = moved
    weight = (a22 - a12) / (a11 - a21 + a22 - a12)
    approach = first * one_open - second * apart
    whole = 0.5 - 0.5 * log(0.5 * radius * load)
    return approach - load * whole, a11 * weight + a12 * (1.0 - weight) - (whole - 0.5), first / load


# Largest elastic pressure where a line contact meets a rounded edge.
#
# Derived, but for two numbers. Deep in a gap the flank of radius R rests on the rounding r alone: Hertz with the
# radius R r/(R + r). Near the edge the sharp contact's pressure is K/√x at the distance x, K = √(2 c a) (c a - d)/(π κ
# R) from the solution of `edge_law`; the rounding cuts it at A (K²/(κ r))^⅓ (dimensions; A fitted). The two join by a
# power sum, and a contact away from the edge keeps Hertz's pressure on R. A and the power are fitted to pressure cells
# (`tests.reference.contact`, r 0.02 to 0.2 mm, 30 to 100 N/mm, d̂ -11 to 0.9): within 4 %.
#
# Steel yields below: 4 to 5 GPa at 60 N/mm and r = 0.1 mm. So real edges are rounder than they broke out.

ROUNDED_FACTOR, JOINING_POWER = 0.9325, 7.26


@entry(cache=True)
def largest_edge_pressure(
    ahead_m: float, radius_m: float, rounding_m: float, line_load_n_per_m: float, kappa_per_pa: float
) -> float:
    """Return the largest pressure [Pa] of a line load at a rounded edge.

    Parameters
    ----------
    ahead_m : d, distance from the common normal to the edge, negative beyond it [m]
    radius_m, rounding_m : R, and the edge's radius r > 0 [m]
    line_load_n_per_m : F > 0
    kappa_per_pa : κ = 2/(π E*)
    """
    load = kappa_per_pa * line_load_n_per_m
    width = sqrt(2.0 * radius_m * load)
    plain = 2.0 * load / (pi * width)
    if ahead_m >= width:
        return plain / kappa_per_pa
    half = half_length(ahead_m / width) * width
    singular = sqrt(2.0 * half) * (half - ahead_m) / (pi * radius_m)
    cut = ROUNDED_FACTOR * (singular * singular / rounding_m) ** (1.0 / 3.0)
    deep = plain * sqrt((radius_m + rounding_m) / rounding_m)
    joined = cut * (1.0 + (cut / deep) ** JOINING_POWER) ** (-1.0 / JOINING_POWER)
    return float(max(plain, joined) / kappa_per_pa)
