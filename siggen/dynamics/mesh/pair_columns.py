"""Columns of the table of tooth pairs in reach, rows of a node, and how tables are read, compiled."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit

(
    NORMAL, FRICTION, PENETRATION, STIFFNESS, SLIDING, POSITION, FLANK, CARRYING, ASPERITY_SHARE, COEFFICIENT, DAMPING,
    WHOLE, GAP, OFFSET, CELL, WEIGHT, ROW, ROUGH, TOUCH, CURVES, SHARE, TILT, MOMENT, CROSS, TURNING, PAIR, STIFF_AT,
    MISSED_1_AT, MISSED_2_AT, YIELD, ALONE,
    COUPLED,
) = range(32)  # fmt: skip
"""Columns of the table of pairs: forces [N]; penetration p [m]; stiffness f', 0 where a pair does not touch [N/m];
sliding speed [m/s]; position s [m]; +1, -1, 0 for the drive flank, the back flank and no contact; of pairs that touch
share of the face that carries, asperity share, friction coefficient, damping [N s/m]. Then stiffness of the whole face,
0 for an empty slot, missing material, place of the teeth, cell of the tables and weight of its upper end, row, share of
the load on damage; first touch [m], beginning of the curves and share of the upper column (`contact_spring`); tilt
[rad], moment across the face [N m], its derivatives to approach [N] and tilt [N m]. What is kept per engagement: the
pair's global number, and where its stiffness and its missing material begin. Stiffness to an approach of all pairs
[N/m] and penetration of a pair by itself [m] (`pair_springs`); from COUPLED on the coupling to older pairs."""
MOST_APART = 3
"""Pairs further apart than this do not couple: no gear has more in contact."""
COLUMNS = COUPLED + MOST_APART

(
    NODE_APPROACH, NODE_RATE, NODE_SLIDING_0, NODE_SLIDING_1, NODE_TILT, NODE_TILT_RATE, NODE_NORMAL, NODE_SLOPE,
    NODE_SLOPE_RATE, NODE_FRICTION, NODE_ARM, NODE_MOMENT, NODE_TURN,
) = range(13)  # fmt: skip
"""Rows of the values at the nodes: approach [m], its rate, both parts of the sliding speed [m/s, 1/s], tilt [rad] and
its rate, which the caller writes; ΣN [N], its tangents to approach [N/m] and rate [N s/m], ΣF [N], Σ s F, Σμ and
Σ ζ F [N m]."""
NODE_ROWS = 13


def solution_columns(slots: int) -> int:
    """Return the columns behind the table in which coupled pairs are solved (`pair_springs`)."""
    return 3 + 2 * slots


@njit(cache=True, _nrt=False, error_model="numpy")
def between(numbers: FloatArray, first: int, cell: int, weight: float) -> float:
    """Return the value in a cell of the table that begins at `first`, linear in the weight of the cell's upper end."""
    here = np.uint64(first + cell)  # never negative, which the compiler cannot know of a signed one
    value: float = numbers[here] * (1.0 - weight) + numbers[here + np.uint64(1)] * weight
    return value
