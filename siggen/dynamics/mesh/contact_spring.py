"""Force of one pair from the table of the contact across the face, compiled: the narrow function of the time loop.

Equations: `siggen.gears.contact.contact_table`. A monotone cubic in the approach at the two columns beside the
position, linear between them; an expansion in the tilt. Numbers of one node stand side by side.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.pair_columns import CELL, CURVES, ROW, SHARE, TILT, TOUCH, WEIGHT, between


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def place_contact(numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int) -> None:
    """Write what `contact_state` needs of slot i at its angle: first touch, beginning and share of its columns."""
    row, cell, weight, points = int(pairs[i, ROW]), int(pairs[i, CELL]), pairs[i, WEIGHT], index[layout.POINTS]
    pairs[i, TOUCH] = between(numbers, index[layout.TOUCH_AT], row * points + cell, weight)
    place = row * (points - 1) + cell
    column = numbers[index[layout.COLUMN_AT] + place] + numbers[index[layout.GAIN_AT] + place] * weight
    whole = min(int(column), index[layout.CONTACT_COLUMNS] - 2)
    pairs[i, CURVES] = index[layout.CURVES_AT] + whole * index[layout.CONTACT_NODES] * index[layout.CONTACT_VALUES]
    pairs[i, SHARE] = column - whole


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _node(approach: float, unit_m: float, nodes: int) -> int:
    """Return the node before an approach, the last but one from there on, however far."""
    root = sqrt(approach / unit_m)
    return int(root) if root < nodes - 1.0 else nodes - 2


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def contact_state(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, penetration_m: float
) -> tuple[float, float, float, float, float, float, float]:
    """Return all that the table says of slot i.

    Force [N] and stiffness [N/m]; moment across the face [N m], dM/dd = dF/dθ [N] and dM/dθ [N m]; carrying share of
    the face and share of the load on damage.

    Parameters
    ----------
    scalars, numbers, index : of `PairLaw`
    pairs : (slots, COLUMNS)
        The table of pairs, placed at an angle (`place_contact`), with its tilt.
    i : int
    penetration_m : float
        Approach of this pair beyond its missing material [m].
    """
    approach = penetration_m - pairs[i, TOUCH]
    if not approach > 0.0:  # a motion that diverges is no number in the end: it may not become a place in the table
        return 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0
    nodes, values = index[layout.CONTACT_NODES], index[layout.CONTACT_VALUES]
    unit_m = scalars[layout.CONTACT_UNIT]
    node = _node(approach, unit_m, nodes)
    span = unit_m * (2.0 * node + 1.0)
    over = approach - unit_m * (node * node)
    per_span = 1.0 / span
    t = over * per_span
    here = int(pairs[i, CURVES]) + node * values
    there, share = here + nodes * values, pairs[i, SHARE]
    beyond, held = t > 1.0, min(t, 1.0)
    force, slope, _ = _hermite(numbers, here, there, values, share, over, per_span, beyond)
    low = _across(numbers, here + 2, there + 2, share)
    carrying = low + held * (_across(numbers, here + values + 2, there + values + 2, share) - low)
    low = _across(numbers, here + 3, there + 3, share)
    rough = low + held * (_across(numbers, here + values + 3, there + values + 3, share) - low)
    if values == 4:
        return force, slope, 0.0, 0.0, 0.0, carrying, rough
    tilt = pairs[i, TILT]
    moment, m_slope, m_bend = _hermite(numbers, here + 4, there + 4, values, share, over, per_span, beyond)
    turning, r_slope, r_bend = _hermite(numbers, here + 6, there + 6, values, share, over, per_span, beyond)
    force += tilt * (m_slope + 0.5 * tilt * r_slope)
    slope += tilt * (m_bend + 0.5 * tilt * r_bend)
    cross = m_slope + r_slope * tilt
    return max(force, 0.0), max(slope, 0.0), moment + turning * tilt, cross, turning, carrying, rough


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _across(numbers: FloatArray, here: int, there: int, share: float) -> float:
    """Return the value between two columns."""
    low = numbers[np.uint64(here)]  # never negative, which the compiler cannot know of a signed one
    value: float = low + share * (numbers[np.uint64(there)] - low)
    return value


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _hermite(
    numbers: FloatArray, here: int, there: int, values: int, share: float, over: float, per_span: float, beyond: bool
) -> tuple[float, float, float]:
    """Return value, first and second derivative of the cubic whose value and slope stand at `here` of both columns."""
    f_0, s_0 = _across(numbers, here, there, share), _across(numbers, here + 1, there + 1, share)
    f_1 = _across(numbers, here + values, there + values, share)
    s_1 = _across(numbers, here + values + 1, there + values + 1, share)
    if beyond:
        return f_1 + s_1 * (over - 1.0 / per_span), s_1, 0.0
    rise, t = (f_1 - f_0) * per_span, over * per_span
    bend, twist = 3.0 * rise - 2.0 * s_0 - s_1, s_0 + s_1 - 2.0 * rise
    value = f_0 + over * (s_0 + t * (bend + t * twist))
    return value, s_0 + t * (2.0 * bend + 3.0 * t * twist), (2.0 * bend + 6.0 * t * twist) * per_span
