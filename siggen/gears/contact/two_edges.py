r"""Sink of a line contact over a gap with two edges: one scalar equation for the share of either edge.

Derived. With the normal at the distances x₁, x₂ from the edges (l = x₁ + x₂; negative: still on that land), F = F₁ + F₂
and a_i the Hertz half width of F_i alone,

    δ = κF₁ [ln(2/a₁) + ½ + G(-x₁/a₁) + N₁] - κF₂ ln λ
    δ = κF₂ [ln(2/a₂) + ½ + G(-x₂/a₂) + N₂] - κF₁ ln λ
    sink = δ - κF [ln(2/a) + ½]

since either land sinks in the far field of the other's load, λ = l plus the distances of both centroids from their
edges. An edge that would have to pull carries nothing. Against pressure cells on a half plane (`reference.contact`):
0.005 µm; with the notch against plane finite elements: 0.05 µm, 4 % of what the notch adds for D = 0.2 mm.

A gap narrower than the contact is no far field any more. Exact for a gap in the middle of a contact: its pressure is
|x| √(b² - x²)/√(x² - l²/4) with b² = a² + l²/4, and the sink is l²/8R, that of a rigid body, at every load. Off the
middle it stays within 1 % of that until one edge alone carries less. So the sink of narrow gaps is the lesser of both,
joined by the power `NARROW_POWER`, and with (l/a)⁴ over `NARROW` it goes over into that of two edges. Against pressure
cells, gaps of 0.1 to 7 a: 0.025 κF at most, and a gap that closes sinks no more.

The floor of the gap carries from the sink D on; the two limits are joined over `FLOOR_ROUNDING` κF, with `FLOOR_LIFT`
of that on top of D, so that joining them never makes the sink fall with the load (derived: lift x least slope of the
edges' sink inside a gap, 0.42, must be 1/8).
"""

from __future__ import annotations

from math import log, sqrt
from typing import NamedTuple

from siggen.compiled import entry, njit
from siggen.gears.contact.edge_law import NO_EDGE, edge_terms

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
