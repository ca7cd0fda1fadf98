"""The pair law of two slots at three nodes in lanes, second part: springs, one node after the other.

Two pairs on one gear body are solved by Newton's method from the node before, so nodes follow one another. All that the
table says of one pair is read at once: eight numbers stand side by side. Operations are those of `contact_spring` and
`pair_springs`, in their order.
"""

from __future__ import annotations

from math import sqrt

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.lane_table import (
    CARRYING,
    COUPLING,
    CROSS,
    CURVES,
    DEPTH,
    MOMENT,
    NORMAL,
    ROUGH,
    SHARE,
    STIFFNESS,
    TOUCH,
    TURNING,
    YIELD,
)
from siggen.dynamics.mesh.pair_springs import MOST_STEPS, SMOOTH_CHANGE
from siggen.lanes import LANES, Lanes, extract, load, shuffle, splat

_slopes = shuffle(1, 0, 3, 2, 5, 4, 7, 6)
_next_node = shuffle(4, 5, 6, 7, 4, 5, 6, 7)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _across(numbers: FloatArray, here: int, there: int, share: float) -> Lanes:
    """Return eight values between two columns."""
    low = load(numbers, here)
    return low + share * (load(numbers, there) - low)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def spring_of(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, table: FloatArray, lane: int, tilt: float,
    penetration_m: float,
) -> tuple[float, float]:  # fmt: skip
    """Return force and stiffness of a pair; write its moment with its derivatives and its shares (`contact_state`)."""
    approach = penetration_m - table[TOUCH, lane]
    if not approach > 0.0:
        table[MOMENT, lane], table[CROSS, lane], table[TURNING, lane] = 0.0, 0.0, 0.0
        table[CARRYING, lane], table[ROUGH, lane] = 1.0, 0.0
        return 0.0, 0.0
    nodes, values = index[layout.CONTACT_NODES], index[layout.CONTACT_VALUES]
    unit_m = scalars[layout.CONTACT_UNIT]
    root = sqrt(approach / unit_m)
    node = int(root) if root < nodes - 1.0 else nodes - 2
    span = unit_m * (2.0 * node + 1.0)
    over = approach - unit_m * (node * node)
    per_span = 1.0 / span
    t = over * per_span
    here = int(table[CURVES, lane]) + node * values
    there, share = here + nodes * values, table[SHARE, lane]
    low = _across(numbers, here, there, share)
    high = _next_node(low)  # behind four values that of the next node follows in the same register
    if values > 4:
        high = _across(numbers, here + LANES, there + LANES, share)
    # Cubics of force, moment and what turns it in lanes 0, 4 and 6, whose slopes stand beside them; shares in 2 and 3.
    s_0, s_1 = _slopes(low), _slopes(high)
    if t > 1.0:
        value, slope, second = high + s_1 * (over - 1.0 / per_span), s_1, splat(0.0)
    else:
        rise = (high - low) * per_span
        bend, twist = 3.0 * rise - 2.0 * s_0 - s_1, s_0 + s_1 - 2.0 * rise
        value, slope = low + over * (s_0 + t * (bend + t * twist)), s_0 + t * (2.0 * bend + 3.0 * t * twist)
        second = (2.0 * bend + 6.0 * t * twist) * per_span
    shares = low + min(t, 1.0) * (high - low)
    table[CARRYING, lane], table[ROUGH, lane] = extract(shares, 2), extract(shares, 3)
    force, stiffness = extract(value, 0), extract(slope, 0)
    if values == 4:
        return force, stiffness
    force += tilt * (extract(slope, 4) + 0.5 * tilt * extract(slope, 6))
    stiffness += tilt * (extract(second, 4) + 0.5 * tilt * extract(second, 6))
    table[MOMENT, lane] = extract(value, 4) + extract(value, 6) * tilt
    table[CROSS, lane] = extract(slope, 4) + extract(slope, 6) * tilt
    table[TURNING, lane] = extract(value, 6)
    return max(force, 0.0), max(stiffness, 0.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def write_alone(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, table: FloatArray, lane: int, tilt: float, inside: bool
) -> None:
    """Write the spring of a pair at its own depth, nothing where it is out of reach."""
    force, stiffness = 0.0, 0.0
    if inside:
        force, stiffness = spring_of(scalars, numbers, index, table, lane, tilt, table[DEPTH, lane])
    stiffness = stiffness if force != 0.0 else 0.0
    table[NORMAL, lane], table[STIFFNESS, lane], table[YIELD, lane] = force, stiffness, stiffness


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def write_two(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, table: FloatArray, i: int, j: int, tilt: float,
    before_i: tuple[float, float, float], before_j: tuple[float, float, float],
) -> None:  # fmt: skip
    """Write the springs of two pairs on one gear body; i entered later.

    From a state near by come force, stiffness and the change of the depth since then.
    """
    c = table[COUPLING, i]
    alone_i, alone_j = table[DEPTH, i], table[DEPTH, j]
    f_i, k_i, d_i = before_i
    f_j, k_j, d_j = before_j
    inverse = 1.0 / (1.0 - k_i * k_j * c * c)
    f_i, f_j = f_i + k_i * (d_i - c * k_j * d_j) * inverse, f_j + k_j * (d_j - c * k_i * d_i) * inverse
    p_i, p_j = alone_i, alone_j
    for _ in range(MOST_STEPS):
        p_i, p_j = alone_i - c * f_j, alone_j - c * f_i
        g_i, k_i = spring_of(scalars, numbers, index, table, i, tilt, p_i)
        g_j, k_j = spring_of(scalars, numbers, index, table, j, tilt, p_j)
        inverse = 1.0 / (1.0 - k_i * k_j * c * c)
        d_i = (g_i - f_i - k_i * c * (g_j - f_j)) * inverse
        d_j = (g_j - f_j - k_j * c * (g_i - f_i)) * inverse
        f_i, f_j = f_i + d_i, f_j + d_j
        if max(abs(d_i), abs(d_j)) <= SMOOTH_CHANGE * max(abs(f_i), abs(f_j)):
            break
    table[MOMENT, i] += table[CROSS, i] * (alone_i - c * f_j - p_i)
    table[MOMENT, j] += table[CROSS, j] * (alone_j - c * f_i - p_j)
    table[NORMAL, i], table[NORMAL, j] = max(f_i, 0.0), max(f_j, 0.0)
    table[STIFFNESS, i] = k_i if table[NORMAL, i] != 0.0 else 0.0
    table[STIFFNESS, j] = k_j if table[NORMAL, j] != 0.0 else 0.0
    table[YIELD, i] = k_i * (1.0 - c * k_j) * inverse
    table[YIELD, j] = k_j * (1.0 - c * k_i) * inverse
