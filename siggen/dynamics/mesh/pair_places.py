"""Where the tooth pairs in reach are at an angle, compiled: the table of pairs and all of it that no state changes.

Derived: pair n of the global count is pitches - n base pitches behind its entry. What belongs to a pair stays in the
table until another one takes its slot.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.contact_spring import place_contact
from siggen.dynamics.mesh.pair_columns import (
    CELL,
    COLUMNS,
    COUPLED,
    GAP,
    MISSED_1_AT,
    MISSED_2_AT,
    MOST_APART,
    NODE_ROWS,
    OFFSET,
    PAIR,
    POSITION,
    ROUGH,
    ROW,
    STIFF_AT,
    WEIGHT,
    WHOLE,
    between,
    solution_columns,
)
from siggen.dynamics.mesh.pair_law import PairLaw


def pair_table(law: PairLaw) -> FloatArray:
    """Return a table of no pair yet: (slots, COLUMNS, space for a solution and, in row 0, for a node)."""
    pairs = np.zeros((law.slots, COLUMNS + solution_columns(law.slots) + NODE_ROWS))
    pairs[:, PAIR] = -np.inf
    return pairs


@njit(cache=True, _nrt=False, error_model="numpy")
def _cell(place: float, points: int) -> tuple[int, float]:
    """Return the cell and the weight of its upper end, `place` intervals from the first point, kept at the ends."""
    place = min(max(place, 0.0), points - 1.0)
    cell = min(int(place), points - 2)
    return cell, place - cell


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def place_pair(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, place: float
) -> None:
    """Write what depends on the angle alone into row i of an engaged pair, `place` pitches behind its entry."""
    points, count = index[layout.POINTS], index[layout.MISSING_POINTS]
    cell, weight = _cell(place * scalars[layout.PER_PITCH], points)
    pairs[i, WHOLE] = between(numbers, int(pairs[i, STIFF_AT]), cell, weight)
    pairs[i, CELL], pairs[i, WEIGHT] = cell, weight
    pairs[i, POSITION] = scalars[layout.START_M] + place * scalars[layout.PITCH_M]
    along, share = _cell((place + scalars[layout.REACH_BEFORE]) * scalars[layout.MISSING_PER_PITCH], count)
    first = between(numbers, int(pairs[i, MISSED_1_AT]), along, share)
    first += between(numbers, int(pairs[i, MISSED_2_AT]), along, share)
    pairs[i, GAP] = pairs[i, OFFSET] + first + scalars[layout.LEAD_M]
    pairs[i, ROUGH] = 0.0
    if index[layout.CONTACT_NODES] > 0:
        place_contact(numbers, index, pairs, i)
    for a in range(min(index[layout.APART], MOST_APART)):
        pairs[i, COUPLED + a] = between(numbers, index[layout.COUPLING_AT] + a * points, cell, weight)


@njit(cache=True, _nrt=False, error_model="numpy")
def engage_pair(numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, pair: int) -> None:
    """Write what stays during the engagement of a pair: its row, where its tables begin, the place of its teeth."""
    tooth_1, tooth_2 = pair % index[layout.TEETH_1], pair % index[layout.TEETH_2]
    row = index[index[layout.TABLE_AT] + tooth_1 * index[layout.TEETH_2] + tooth_2]
    count = index[layout.MISSING_POINTS]
    pairs[i, PAIR], pairs[i, ROW] = pair, row
    pairs[i, STIFF_AT] = index[layout.STIFFNESS_AT] + row * index[layout.POINTS]
    pairs[i, MISSED_1_AT] = index[layout.MISSING_1_AT] + index[index[layout.KIND_1_AT] + tooth_1] * count
    pairs[i, MISSED_2_AT] = index[layout.MISSING_2_AT] + index[index[layout.KIND_2_AT] + tooth_2] * count
    pairs[i, OFFSET] = numbers[index[layout.OFFSET_1_AT] + tooth_1] + numbers[index[layout.OFFSET_2_AT] + tooth_2]
