"""Columns of the table of tooth pairs in reach, and rows of the values at the nodes of a step."""

from __future__ import annotations

from itertools import count

_column = count()
NORMAL = next(_column)  # force [N]
FRICTION = next(_column)  # [N]
PENETRATION = next(_column)  # p [m]
STIFFNESS = next(_column)  # f', 0 where a pair does not touch [N/m]
SLIDING = next(_column)  # speed [m/s]
POSITION = next(_column)  # s [m]
FLANK = next(_column)  # +1, -1, 0: drive flank, back flank, no contact
CARRYING = next(_column)  # share of the face; this and the next three of pairs that touch
ASPERITY_SHARE = next(_column)
COEFFICIENT = next(_column)  # of friction
DAMPING = next(_column)  # [N s/m]; while a node is written, what it is over the root of the summed stiffness
WHOLE = next(_column)  # stiffness of the whole face, 0 for an empty slot [N/m]
ROUGH = next(_column)  # share of the load on rough land
TOUCH = next(_column)  # first touch [m]
CURVES = next(_column)  # where its curves begin (`contact_spring`)
SHARE = next(_column)  # of the upper column
TILT = next(_column)  # [rad]
MOMENT = next(_column)  # across the face [N m]
CROSS = next(_column)  # its derivative to the approach [N]
TURNING = next(_column)  # and to the tilt [N m]
YIELD = next(_column)  # stiffness to an approach of all pairs [N/m]
ALONE = next(_column)  # penetration of a pair by itself [m]
SPRUNG = next(_column)  # force of the spring without its damper [N]: what the next spring is guessed from
PAIR = next(_column)  # global number
ROW = next(_column)  # what is kept while it is engaged (`pair_places.Engaged`)
STIFFNESS_AT = next(_column)
TOUCH_AT = next(_column)
COLUMNS_AT = next(_column)
MISSED_1_AT = next(_column)
MISSED_2_AT = next(_column)
OFFSET = next(_column)
ARM = next(_column)  # moment of the friction about the pinion's base tangent point [N m]
PLACE = next(_column)  # mean place of the load [m]; of spur teeth s
COUPLED = next(_column)  # from here on the coupling to older pairs [m/N]
MOST_APART = 3
"""Pairs further apart than this do not couple: no gear has more in contact."""
COLUMNS = COUPLED + MOST_APART

_row = count()
NODE_APPROACH = next(_row)  # [m]; this and the next five the caller writes
NODE_RATE = next(_row)  # of the approach [m/s]
NODE_SLIDING_0 = next(_row)  # sliding speed at s: the first [m/s] plus s times the second [1/s]
NODE_SLIDING_1 = next(_row)
NODE_TILT = next(_row)  # [rad]
NODE_TILT_RATE = next(_row)  # [rad/s]
NODE_NORMAL = next(_row)  # ΣN [N]
NODE_SLOPE = next(_row)  # its tangent to the approach [N/m]
NODE_SLOPE_RATE = next(_row)  # and to the rate [N s/m]
NODE_FRICTION = next(_row)  # ΣF [N]
NODE_ARM = next(_row)  # Σ s F [N m]
NODE_MOMENT = next(_row)  # Σμ [N m]
NODE_TURN = next(_row)  # Σ ζ F [N m]
NODE_ROWS = next(_row)


def solution_columns(slots: int) -> int:
    """Return the columns behind the table in which coupled pairs are solved (`pair_springs`)."""
    return 3 + 2 * slots
