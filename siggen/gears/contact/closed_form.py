r"""Closed form of the sink over a gap with two edges, and the distance over which the load passes between them.

Derived from `two_edges` by counting both edges' logarithms as equal: near the middle the load is shared in proportion
to the offset s of the normal from mid-gap, and the sink follows a parabola; further out one edge carries alone,

    s* = (a²/l) [ln(2 l/a) + N/2],   F₁/F = ½ - s/(2 s*) clipped to 0 .. 1 (edge 2 lies ahead, at s = l/2)
    sink = min{κF [G((|s| - l/2)/a) + N], (l²/4 + s²)/(2R) + ½ κF N},

G and N of the nearer edge under the whole load. Largest error against the coupled law at 30 / 60 / 100 N/mm, l 0.3 to
1.5 mm: 0.04 / 0.09 / 0.16 µm and 0.016 of the share without notch, 0.07 / 0.14 / 0.23 µm and 0.046 with D to 0.2 mm.
For estimates and for placing positions of tables at ±s*; the solver takes the coupled law, which has no kink.
"""

from __future__ import annotations

from math import log, sqrt

from siggen.compiled import entry
from siggen.gears.contact.edge_law import half_plane_factor, notch_factor


@entry(cache=True)
def transfer_distance(length_m: float, depth_m: float, radius_m: float, load_m: float) -> float:
    """Return s* [m]: the load passes from one edge to the other between -s* and s*.

    Parameters
    ----------
    length_m, depth_m : l and D of the gap, D = 0 for no notch; l from 2 a
    radius_m, load_m : R and κF > 0
    """
    width = sqrt(2.0 * radius_m * load_m)
    notch = notch_factor(-0.5 * length_m / width, depth_m / width)
    return width * width / length_m * (log(2.0 * length_m / width) + 0.5 * notch)


@entry(cache=True)
def closed_gap_sink(
    offset_m: float, length_m: float, depth_m: float, radius_m: float, load_m: float
) -> tuple[float, float]:
    """Return the sink [m] of sharp edges at s from mid-gap, and the part of the load on the edge before the middle.

    Parameters as in `transfer_distance`; `offset_m`: s, positive towards the edge ahead.
    """
    width = sqrt(2.0 * radius_m * load_m)
    ahead = (abs(offset_m) - 0.5 * length_m) / width
    notch = notch_factor(ahead, depth_m / width)
    one = load_m * (half_plane_factor(ahead) + notch)
    both = (0.25 * length_m * length_m + offset_m * offset_m) / (2.0 * radius_m) + 0.5 * load_m * notch
    reach = transfer_distance(length_m, depth_m, radius_m, load_m)
    return min(one, both), min(max(0.5 - 0.5 * offset_m / reach, 0.0), 1.0)
