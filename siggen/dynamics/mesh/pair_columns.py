"""Columns of the table of tooth pairs in reach, and how its tables are read, compiled."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit

(
    NORMAL, FRICTION, PENETRATION, STIFFNESS, SLIDING, POSITION, FLANK, CARRYING, ASPERITY_SHARE, COEFFICIENT, DAMPING,
    PLACED, WHOLE, GAP, OFFSET, CELL, WEIGHT, ROW, ROUGH, TOUCH, CURVES, SHARE, TILT, TILT_RATE, MOMENT, CROSS,
    TURNING, PAIR, STIFF_AT, MISSED_1_AT, MISSED_2_AT, YIELD, ALONE,
    COUPLED,
) = range(34)  # fmt: skip
"""Columns of the table of pairs: forces [N]; penetration p [m]; stiffness f' where a pair touches, of the whole face
where not, 0 for an empty slot [N/m]; sliding speed [m/s]; position s [m]; +1, -1, 0 for the drive flank, the back flank
and no contact; share of the face that carries; asperity share; friction coefficient; damping [N s/m]. Then what is kept
per angle: the angle [base pitches], stiffness of the whole face, missing material, place of the teeth, cell of the
tables and weight of its upper end, row, share of the face on damage; first touch [m], beginning of the curves and share
of the upper column (`contact_spring`); tilt [rad] and its rate [rad/s], which the caller writes, moment across the face
[N m], its derivatives to approach [N] and tilt [N m]. What is kept per engagement: the pair's global number, and where
its stiffness and its missing material begin. Stiffness to an approach of all pairs [N/m] and penetration of a pair by
itself [m] (`pair_tangents`); from COUPLED on the coupling to older pairs."""
MOST_APART = 3
"""Pairs further apart than this do not couple: no gear has more in contact."""
COLUMNS = COUPLED + MOST_APART


def solution_columns(slots: int) -> int:
    """Return the columns behind the table in which coupled pairs are solved (`pair_springs`)."""
    return 4 + 2 * slots


@njit(cache=True, _nrt=False, error_model="numpy")
def between(numbers: FloatArray, first: int, cell: int, weight: float) -> float:
    """Return the value in a cell of the table that begins at `first`, linear in the weight of the cell's upper end."""
    here = np.uint64(first + cell)  # never negative, which the compiler cannot know of a signed one
    value: float = numbers[here] * (1.0 - weight) + numbers[here + np.uint64(1)] * weight
    return value
