"""Columns of the table of tooth pairs in reach, and rows of the values at the nodes of a step."""

from __future__ import annotations

(
    NORMAL, FRICTION, PENETRATION, STIFFNESS, SLIDING, POSITION, FLANK, CARRYING, ASPERITY_SHARE, COEFFICIENT, DAMPING,
    WHOLE, ROUGH, TOUCH, CURVES, SHARE, TILT, MOMENT, CROSS, TURNING, YIELD, ALONE, PAIR, ROW,
    STIFFNESS_AT, TOUCH_AT, COLUMNS_AT, MISSED_1_AT, MISSED_2_AT, OFFSET, COUPLED,
) = range(31)  # fmt: skip
"""Columns of the table of pairs: forces [N]; penetration p [m]; stiffness f', 0 where a pair does not touch [N/m];
sliding speed [m/s]; position s [m]; +1, -1, 0 for the drive flank, the back flank and no contact; of pairs that touch
share of the face that carries, asperity share, friction coefficient, damping [N s/m]. Then stiffness of the whole face,
0 for an empty slot; share of the load on damage; first touch [m], beginning of the curves and share of the upper column
(`contact_spring`); tilt [rad], moment across the face [N m], its derivatives to approach [N] and tilt [N m]; stiffness
to an approach of all pairs [N/m] and penetration of a pair by itself [m]; the pair's global number, and what is kept
while it is engaged (`pair_places.Engaged`); from COUPLED on the coupling to older pairs."""
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
