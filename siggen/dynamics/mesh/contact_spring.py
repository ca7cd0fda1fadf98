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
    """Write what `contact_spring` needs of slot i at its angle: first touch, beginning and share of its columns."""
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
    if not approach > 0.0:  # a motion that diverges is no number in the end: it may not become a place in the table
        return 0.0, 0.0
    nodes = index[layout.CONTACT_NODES]
    unit_m = scalars[layout.CONTACT_REACH] / ((nodes - 1.0) * (nodes - 1.0))
    node = _node(approach, unit_m, nodes)
    span = unit_m * (2.0 * node + 1.0)
    over = approach - unit_m * (node * node)
    t = over / span
    values = index[layout.CONTACT_VALUES]
    here = int(pairs[i, CURVES]) + node * values
    there = here + nodes * values
    share = pairs[i, SHARE]
    rest = 1.0 - share
    f_0, f_1 = (
        numbers[here] * rest + numbers[there] * share,
        numbers[here + values] * rest + numbers[there + values] * share,
    )
    s_0, s_1 = (
        numbers[here + 1] * rest + numbers[there + 1] * share,
        numbers[here + values + 1] * rest + numbers[there + values + 1] * share,
    )
    if t > 1.0:  # beyond the last node the slope stays
        force, slope = f_1 + s_1 * (over - span), s_1
    else:
        rise = (f_1 - f_0) / span
        bend, twist = 3.0 * rise - 2.0 * s_0 - s_1, s_0 + s_1 - 2.0 * rise
        force, slope = f_0 + over * (s_0 + t * (bend + t * twist)), s_0 + t * (2.0 * bend + 3.0 * t * twist)
    tilt = pairs[i, TILT]
    if values == 4 or tilt == 0.0:
        return force, slope
    _, m_slope, m_bend = _cubic(numbers, here + 4, there + 4, values, share, over, span)
    _, r_slope, r_bend = _cubic(numbers, here + 6, there + 6, values, share, over, span)
    force += tilt * (m_slope + 0.5 * tilt * r_slope)
    slope += tilt * (m_bend + 0.5 * tilt * r_bend)
    return max(force, 0.0), max(slope, 0.0)


@njit(cache=True, _nrt=False, error_model="numpy")
def _cubic(
    numbers: FloatArray, here: int, there: int, values: int, share: float, over: float, span: float
) -> tuple[float, float, float]:
    """Return value, first and second derivative of the cubic whose value and slope stand at `here` of both columns."""
    rest, t = 1.0 - share, over / span
    f_0 = numbers[here] * rest + numbers[there] * share
    s_0 = numbers[here + 1] * rest + numbers[there + 1] * share
    f_1 = numbers[here + values] * rest + numbers[there + values] * share
    s_1 = numbers[here + values + 1] * rest + numbers[there + values + 1] * share
    if t > 1.0:
        return f_1 + s_1 * (over - span), s_1, 0.0
    rise = (f_1 - f_0) / span
    bend, twist = 3.0 * rise - 2.0 * s_0 - s_1, s_0 + s_1 - 2.0 * rise
    value = f_0 + over * (s_0 + t * (bend + t * twist))
    return value, s_0 + t * (2.0 * bend + 3.0 * t * twist), (2.0 * bend + 6.0 * t * twist) / span


@njit(cache=True, _nrt=False, error_model="numpy")
def contact_moment(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, penetration_m: float
) -> tuple[float, float, float]:
    """Return the moment across the face [N m], dM/dd = dF/dθ [N] and dM/dθ [N m] of slot i, arguments as above."""
    nodes, values = index[layout.CONTACT_NODES], index[layout.CONTACT_VALUES]
    unit_m = scalars[layout.CONTACT_REACH] / ((nodes - 1.0) * (nodes - 1.0))
    approach = max(0.0, penetration_m - pairs[i, TOUCH])
    node = _node(approach, unit_m, nodes)
    span, over = unit_m * (2.0 * node + 1.0), approach - unit_m * (node * node)
    here = int(pairs[i, CURVES]) + node * values
    there = here + nodes * values
    share, tilt = pairs[i, SHARE], pairs[i, TILT]
    moment, slope, _ = _cubic(numbers, here + 4, there + 4, values, share, over, span)
    turning, turning_slope, _ = _cubic(numbers, here + 6, there + 6, values, share, over, span)
    return moment + turning * tilt, slope + turning_slope * tilt, turning


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def contact_shares(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, penetration_m: float
) -> tuple[float, float]:
    """Return the carrying share of the face and the share of the load on damage of slot i, arguments as above."""
    nodes = index[layout.CONTACT_NODES]
    unit_m = scalars[layout.CONTACT_REACH] / ((nodes - 1.0) * (nodes - 1.0))
    approach = max(0.0, penetration_m - pairs[i, TOUCH])
    node = _node(approach, unit_m, nodes)
    t = min((approach - unit_m * (node * node)) / (unit_m * (2.0 * node + 1.0)), 1.0)
    values = index[layout.CONTACT_VALUES]
    here = int(pairs[i, CURVES]) + node * values
    there = here + nodes * values
    share = pairs[i, SHARE]
    carrying_0 = numbers[here + 2] * (1.0 - t) + numbers[here + values + 2] * t
    carrying_1 = numbers[there + 2] * (1.0 - t) + numbers[there + values + 2] * t
    rough_0 = numbers[here + 3] * (1.0 - t) + numbers[here + values + 3] * t
    rough_1 = numbers[there + 3] * (1.0 - t) + numbers[there + values + 3] * t
    return carrying_0 + share * (carrying_1 - carrying_0), rough_0 + share * (rough_1 - rough_0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def contact_state(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, penetration_m: float
) -> tuple[float, float, float, float, float, float, float]:
    """Return all that the table says of slot i, which is found once: spring, moment and shares of the functions above.

    Force [N] and stiffness [N/m]; moment [N m], dM/dd [N] and dM/dθ [N m]; carrying share and share on damage.
    """
    approach = penetration_m - pairs[i, TOUCH]
    if not approach > 0.0:
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
    """Return what `_cubic` returns, without divisions."""
    f_0, s_0 = _across(numbers, here, there, share), _across(numbers, here + 1, there + 1, share)
    f_1 = _across(numbers, here + values, there + values, share)
    s_1 = _across(numbers, here + values + 1, there + values + 1, share)
    if beyond:
        return f_1 + s_1 * (over - 1.0 / per_span), s_1, 0.0
    rise, t = (f_1 - f_0) * per_span, over * per_span
    bend, twist = 3.0 * rise - 2.0 * s_0 - s_1, s_0 + s_1 - 2.0 * rise
    value = f_0 + over * (s_0 + t * (bend + t * twist))
    return value, s_0 + t * (2.0 * bend + 3.0 * t * twist), (2.0 * bend + 6.0 * t * twist) * per_span
