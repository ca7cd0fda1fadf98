"""Columns of the rows in which the union of outlines is computed: one row per ellipse or trapezoid on a flank.

Compiled code takes no objects, so a flank's damage is an array (n, COLUMNS) and these are the places of its numbers.
"""

from __future__ import annotations

(
    HEIGHT, FACE, SEMI_FACE, SEMI_HEIGHT, DEPTH, DISH, TRAPEZOID, LOWEST, HIGHEST,
    LEFT_LOW, RIGHT_LOW, LEFT_HIGH, RIGHT_HIGH, EDGE_RADIUS,
) = range(14)  # fmt: skip
"""`HEIGHT`, `FACE`: centre; `SEMI_FACE`, `SEMI_HEIGHT`: semi-axes (of a trapezoid half its width, and half the height
range of its polygon about that range's middle); `DEPTH`: largest depth [m]; `DISH`: 1 for a dished floor; `TRAPEZOID`:
0 for an ellipse; `LOWEST`, `HIGHEST`: ends along the height; the next four: a trapezoid's left and right end at its
lowest and at its highest point, the right end one behind the left one; `EDGE_RADIUS`: of its edges [m]."""
COLUMNS = 14
"""Width of a row."""
UNSTATED = -1.0
"""Edge radius of a damage that has the one of the contact's options."""
THROUGH_M = 0.1
"""Depth of what is gone through the whole tooth, above any half thickness: no notch in a section, and no floor [m]."""
