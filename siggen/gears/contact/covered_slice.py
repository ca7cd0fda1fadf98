r"""Sink of a slice that damage covers in part: land and gap share its load by one energy.

Derived. Of a slice under the mean load u the land, a part f, carries u_l and the gap, c = 1 - f, carries u_g, with
u = f u_l + c u_g. A load that passes from one to the other sinks by the kernel between neighbours, k = K_0 - K_1:

    E(u) = min ½ k f c (u_l - u_g)² + f ∫ e_l du + c ∫ e_g du,   k (u_l - u_g) = e_g(u_g) - e_l(u_l),

and the sink is dE/du = f e_l + c e_g; where the gap is too deep to carry it is k u c/f + e_l(u/f). A slice of land
alone or of a gap alone keeps its own law, and between them the sink is continuous in c.
"""

from __future__ import annotations

from math import asinh
from typing import NamedTuple

from siggen.compiled import entry, njit
from siggen.gears.contact.line_kernel import ENERGY_WIDTH
from siggen.gears.contact.two_edges import GapSink, gap_sink

PASSES = 40
CLOSE = 1e-12
"""Of the last step over the mean load."""


def spread_of_cells(cell_widths: float) -> float:
    """Return k = K_0 - K_1 of cells so many half widths wide."""
    x = 0.5 * cell_widths / ENERGY_WIDTH
    return 1.5 * asinh(x) - 0.5 * asinh(3.0 * x)


class CoveredSlice(NamedTuple):
    """A slice (a named tuple, since compiled code takes no dataclass).

    `gap`: left_m, right_m, notch_m, floor_m of the covered part, as for `gap_sink`; `tips`: left_m and right_m of the
    land; `covered`: c; `spread`: k; `radii`: radius_m and rounding_m, as for `gap_sink`.
    """

    gap: tuple[float, float, float, float]
    tips: tuple[float, float]
    covered: float
    spread: float
    radii: tuple[float, float]


@entry(cache=True, _nrt=False, error_model="numpy")
def covered_sink(one: CoveredSlice, load_m: float) -> GapSink:
    """Return the sink of a slice, its slope, and the part of the gap's load on its left edge.

    Parameters
    ----------
    one : CoveredSlice, with c above 0 and below 1
    load_m : κq of the whole slice [m]; at 0 the rigid sink
    """
    gap, tips, covered, spread, (radius, rounding) = one
    land = 1.0 - covered
    apart = 0.0 if load_m <= 0.0 else load_apart(one, load_m)
    on_land = gap_sink(tips[0], tips[1], 0.0, 0.0, radius, rounding, load_m + covered * apart)
    on_gap = gap_sink(gap[0], gap[1], gap[2], gap[3], radius, rounding, max(load_m - land * apart, 0.0))
    if load_m <= 0.0:
        return on_gap if on_gap.sink_m < on_land.sink_m else on_land
    if apart >= load_m / land:
        sink = spread * apart * covered + on_land.sink_m
        return GapSink(sink, (spread * covered + on_land.slope) / land, on_gap.left_share)
    turn = (on_gap.slope - on_land.slope) / (spread + covered * on_land.slope + land * on_gap.slope)
    slope = land * on_land.slope * (1.0 + covered * turn) + covered * on_gap.slope * (1.0 - land * turn)
    return GapSink(land * on_land.sink_m + covered * on_gap.sink_m, slope, on_gap.left_share)


@njit(cache=True, _nrt=False, error_model="numpy")
def load_apart(one: CoveredSlice, load_m: float) -> float:
    """Return u_l - u_g [m] of a slice under `load_m` > 0; parameters as for `covered_sink`."""
    gap, tips, covered, spread, (radius, rounding) = one
    land = 1.0 - covered
    # between a land and a gap that carry nothing
    low, high = -load_m / covered, load_m / land
    on_land = gap_sink(tips[0], tips[1], 0.0, 0.0, radius, rounding, high)
    on_gap = gap_sink(gap[0], gap[1], gap[2], gap[3], radius, rounding, 0.0)
    if spread * high + on_land.sink_m <= on_gap.sink_m:
        return high
    apart = 0.0
    for _ in range(PASSES):
        on_land = gap_sink(tips[0], tips[1], 0.0, 0.0, radius, rounding, load_m + covered * apart)
        on_gap = gap_sink(gap[0], gap[1], gap[2], gap[3], radius, rounding, load_m - land * apart)
        rest = spread * apart + on_land.sink_m - on_gap.sink_m
        low, high = (low, apart) if rest > 0.0 else (apart, high)
        moved = apart - rest / (spread + covered * on_land.slope + land * on_gap.slope)
        if not low < moved < high:
            moved = 0.5 * (low + high)
        if abs(moved - apart) <= CLOSE * load_m:
            break
        apart = moved
    return apart
