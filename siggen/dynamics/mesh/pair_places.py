"""Where tooth pairs are at an angle, compiled: what no state changes, for one value or for lanes of them.

Derived: pair n of the global count is pitches - n base pitches behind its entry. What belongs to a pair stays in the
table of pairs until another one takes its slot.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.pair_columns import COLUMNS, NODE_ROWS, PAIR, solution_columns
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.lanes import Lanes, Whole, as_doubles, gather, gather_pairs, larger, smaller, truncated

Value = Lanes
"""A number, or lanes of numbers."""


class Engaged(NamedTuple):
    """What stays during the engagement of a pair, as floats.

    Its row in the tables, where its stiffness, its first touch, its columns and the missing material of both teeth
    begin, and the place of its teeth [m].
    """

    row: Value
    stiffness: Value
    touch: Value
    columns: Value
    missed_1: Value
    missed_2: Value
    offset: Value


class Placed(NamedTuple):
    """Position [m], cell of the tables and weight of its upper end, missing material and place of the teeth [m]."""

    position: Value
    cell: Whole
    weight: Value
    gap: Value


def pair_table(law: PairLaw) -> FloatArray:
    """Return a table of no pair yet: (slots, COLUMNS, space for a solution and, in row 0, for a node)."""
    pairs = np.zeros((law.slots, COLUMNS + solution_columns(law.slots) + NODE_ROWS))
    pairs[:, PAIR] = -np.inf
    return pairs


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def row_places(law: PairLaw, row: int) -> tuple[float, float, float]:
    """Return where stiffness, first touch and columns of a row of the tables begin."""
    index, points = law.places, law.places[layout.POINTS]
    first = row * points
    return float(index[layout.STIFFNESS_AT] + first), float(index[layout.TOUCH_AT] + first), float(first - row)


@njit(cache=True, _nrt=False, error_model="numpy")
def engaged(law: PairLaw, pair: int) -> Engaged:
    """Return what stays during the engagement of a pair."""
    numbers, index, count = law.numbers, law.places, law.places[layout.MISSING_POINTS]
    tooth_1, tooth_2 = pair % index[layout.TEETH_1], pair % index[layout.TEETH_2]
    row = index[index[layout.TABLE_AT] + tooth_1 * index[layout.TEETH_2] + tooth_2]
    stiffness, touch, columns = row_places(law, row)
    missed_1 = index[layout.MISSING_1_AT] + index[index[layout.KIND_1_AT] + tooth_1] * count
    missed_2 = index[layout.MISSING_2_AT] + index[index[layout.KIND_2_AT] + tooth_2] * count
    offset = numbers[index[layout.OFFSET_1_AT] + tooth_1] + numbers[index[layout.OFFSET_2_AT] + tooth_2]
    return Engaged(float(row), stiffness, touch, columns, float(missed_1), float(missed_2), offset)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def between(law: PairLaw, first: Whole, weight: Value) -> Value:
    """Return the value in the cell of a table that begins at `first`, linear in the weight of the cell's upper end."""
    low, high = gather_pairs(law.numbers, first)
    return low * (1.0 - weight) + high * weight


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def placed(law: PairLaw, pair: Engaged, place: Value) -> Placed:
    """Return where a pair is `place` pitches behind its entry; tables are held at their ends."""
    scalars, points, count = law.scalars, law.places[layout.POINTS], law.places[layout.MISSING_POINTS]
    along = smaller(larger(place * scalars[layout.PER_PITCH], 0.0), points - 1.0)
    cell = smaller(truncated(along), points - 2)
    missing = (place + scalars[layout.REACH_BEFORE]) * scalars[layout.MISSING_PER_PITCH]
    missing = smaller(larger(missing, 0.0), count - 1.0)
    there = smaller(truncated(missing), count - 2)
    share = missing - as_doubles(there)
    missed = between(law, truncated(pair.missed_1) + there, share)
    missed = missed + between(law, truncated(pair.missed_2) + there, share)
    position = scalars[layout.START_M] + place * scalars[layout.PITCH_M]
    return Placed(position, cell, along - as_doubles(cell), pair.offset + missed + scalars[layout.LEAD_M])


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def placed_contact(
    law: PairLaw, touch_at: Value, columns_at: Value, cell: Whole, weight: Value
) -> tuple[Value, Value, Value]:
    """Return first touch [m], beginning and share of the columns of a pair in the table of the contact.

    `touch_at` and `columns_at` are those of `Engaged`.
    """
    numbers, index = law.numbers, law.places
    first = truncated(columns_at) + cell
    column = gather(numbers, first + index[layout.COLUMN_AT])
    column = column + gather(numbers, first + index[layout.GAIN_AT]) * weight
    whole = smaller(truncated(column), index[layout.CONTACT_COLUMNS] - 2)
    curves = whole * (index[layout.CONTACT_NODES] * index[layout.CONTACT_VALUES]) + index[layout.CURVES_AT]
    touch = between(law, truncated(touch_at) + cell, weight)
    return touch, as_doubles(curves), column - as_doubles(whole)
