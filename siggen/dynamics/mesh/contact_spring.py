"""Force of one pair from the table of the contact across the face, compiled: the narrow function of the time loop.

Equations: `siggen.gears.contact.contact_table`. A monotone cubic in the approach at the two columns beside the
position, linear between them.
"""

from __future__ import annotations

from math import sqrt

from numba import njit

from siggen.arrays import FloatArray, IntArray
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.pair_columns import CELL, CURVES, ROW, SHARE, TOUCH, WEIGHT, between

VALUES = 4
"""Force, slope, carrying share and share of the load on damage stand side by side at every node."""


@njit(cache=True, inline="always")
def place_contact(numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int) -> None:
    """Write what `contact_spring` needs of slot i at its angle: first touch, beginning and share of its columns."""
    row, cell, weight, points = int(pairs[i, ROW]), int(pairs[i, CELL]), pairs[i, WEIGHT], index[layout.POINTS]
    pairs[i, TOUCH] = between(numbers, index[layout.TOUCH_AT], row * points + cell, weight)
    place = row * (points - 1) + cell
    column = numbers[index[layout.COLUMN_AT] + place] + numbers[index[layout.GAIN_AT] + place] * weight
    whole = min(int(column), index[layout.CONTACT_COLUMNS] - 2)
    pairs[i, CURVES] = index[layout.CURVES_AT] + whole * index[layout.CONTACT_NODES] * VALUES
    pairs[i, SHARE] = column - whole


@njit(cache=True, inline="always")
def contact_spring(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, penetration_m: float
) -> tuple[float, float]:
    """Return force [N] and stiffness [N/m] of slot i.

    Parameters
    ----------
    scalars, numbers, index : of `PairLaw`
    pairs : (slots, COLUMNS)
        The table of pairs, placed at an angle (`place_contact`).
    i : int
    penetration_m : float
        Approach of this pair beyond its missing material [m].
    """
    approach = penetration_m - pairs[i, TOUCH]
    if approach <= 0.0:
        return 0.0, 0.0
    nodes = index[layout.CONTACT_NODES]
    unit_m = scalars[layout.CONTACT_REACH] / ((nodes - 1.0) * (nodes - 1.0))
    node = min(int(sqrt(approach / unit_m)), nodes - 2)
    span = unit_m * (2.0 * node + 1.0)
    over = approach - unit_m * (node * node)
    t = over / span
    here = int(pairs[i, CURVES]) + node * VALUES
    there = here + nodes * VALUES
    share = pairs[i, SHARE]
    rest = 1.0 - share
    f_0, f_1 = numbers[here] * rest + numbers[there] * share, numbers[here + 4] * rest + numbers[there + 4] * share
    s_0, s_1 = (
        numbers[here + 1] * rest + numbers[there + 1] * share,
        numbers[here + 5] * rest + numbers[there + 5] * share,
    )
    if t > 1.0:  # beyond the last node the slope stays
        return f_1 + s_1 * (over - span), s_1
    rise = (f_1 - f_0) / span
    bend, twist = 3.0 * rise - 2.0 * s_0 - s_1, s_0 + s_1 - 2.0 * rise
    return f_0 + over * (s_0 + t * (bend + t * twist)), s_0 + t * (2.0 * bend + 3.0 * t * twist)


@njit(cache=True, inline="always")
def contact_shares(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, penetration_m: float
) -> tuple[float, float]:
    """Return the carrying share of the face and the share of the load on damage of slot i, arguments as above."""
    nodes = index[layout.CONTACT_NODES]
    unit_m = scalars[layout.CONTACT_REACH] / ((nodes - 1.0) * (nodes - 1.0))
    approach = max(penetration_m - pairs[i, TOUCH], 0.0)
    node = min(int(sqrt(approach / unit_m)), nodes - 2)
    t = min((approach - unit_m * (node * node)) / (unit_m * (2.0 * node + 1.0)), 1.0)
    here = int(pairs[i, CURVES]) + node * VALUES
    there = here + nodes * VALUES
    share = pairs[i, SHARE]
    carrying_0 = numbers[here + 2] * (1.0 - t) + numbers[here + 6] * t
    carrying_1 = numbers[there + 2] * (1.0 - t) + numbers[there + 6] * t
    rough_0 = numbers[here + 3] * (1.0 - t) + numbers[here + 7] * t
    rough_1 = numbers[there + 3] * (1.0 - t) + numbers[there + 7] * t
    return carrying_0 + share * (carrying_1 - carrying_0), rough_0 + share * (rough_1 - rough_0)
