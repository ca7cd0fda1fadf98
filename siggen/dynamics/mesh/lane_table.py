"""The pair law of two slots at three nodes in lanes, first part: the table of it, and where its pairs are.

A lane is a pair at a node: slots 0 and 1 at node 0, then at node 1, then at node 2. The last two lanes hold node 2 once
more and are left out in the end. Operations are those of `pair_places`, in their order, so that all bytes are theirs.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.lanes import (
    LANES,
    Lanes,
    Whole,
    aligned,
    as_doubles,
    gather,
    gather_pairs,
    larger,
    load,
    shuffle,
    smaller,
    store,
    truncated,
)

(
    APPLIES, NODES_AT, PAIR, MISSED_1, MISSED_2, OFFSET, TOUCH_ROW, COLUMN_ROW, DEPTH, TOUCH, CURVES, SHARE, COUPLING,
    NORMAL, STIFFNESS, YIELD, MOMENT, CROSS, TURNING, CARRYING, ROUGH, POSITION, SCRATCH,
) = range(23)  # fmt: skip
"""Rows of the table: whether lanes can be used at all, and the nodes on [0, 1]. What stays during an engagement: number
of the pair, where its missing material begins, place of its teeth, where its first touch and its columns begin. Then
what `pair_columns` says of the same names."""
ROWS = 23
SLOTS = 2
BOTH = 0b111111
"""All lanes of both slots; of one slot every second of them."""

of_pairs = shuffle(0, 0, 1, 1, 2, 2, 2, 2)
"""Values at nodes, for the pairs there."""


def lane_table(law: PairLaw, nodes: FloatArray) -> FloatArray:
    """Return the table (ROWS, LANES) of a law at nodes on [0, 1]."""
    table = aligned(np.zeros((ROWS, LANES)))
    head, first = law.places, law.places[layout.STIFFNESS_AT]
    rows = int(head[head[layout.TABLE_AT] :][: head[layout.TEETH_1] * head[layout.TEETH_2]].max()) + 1
    stiffness = law.numbers[first : first + rows * head[layout.POINTS]]
    plain = law.scalars[layout.FILM] == 0.0 and head[layout.SHARE_DAMPS] == 0
    applies = plain and law.slots == SLOTS and len(nodes) == 3 and head[layout.CONTACT_NODES] > 0
    table[APPLIES] = float(applies and bool((stiffness > 0.0).all()))
    table[NODES_AT, : len(nodes)] = nodes
    table[PAIR] = -1e9  # no pair yet, and a place that is a number
    return table


@njit(cache=True, _nrt=False, error_model="numpy")
def engage_lanes(numbers: FloatArray, index: IntArray, table: FloatArray, slot: int, pair: int) -> None:
    """Write what stays during the engagement of a pair into the lanes of its slot (`engage_pair`)."""
    tooth_1, tooth_2 = pair % index[layout.TEETH_1], pair % index[layout.TEETH_2]
    row = index[index[layout.TABLE_AT] + tooth_1 * index[layout.TEETH_2] + tooth_2]
    count, points = index[layout.MISSING_POINTS], index[layout.POINTS]
    for lane in range(slot, LANES, SLOTS):
        table[PAIR, lane] = pair
        table[MISSED_1, lane] = index[layout.MISSING_1_AT] + index[index[layout.KIND_1_AT] + tooth_1] * count
        table[MISSED_2, lane] = index[layout.MISSING_2_AT] + index[index[layout.KIND_2_AT] + tooth_2] * count
        table[OFFSET, lane] = (
            numbers[index[layout.OFFSET_1_AT] + tooth_1] + numbers[index[layout.OFFSET_2_AT] + tooth_2]
        )
        table[TOUCH_ROW, lane] = index[layout.TOUCH_AT] + row * points
        table[COLUMN_ROW, lane] = row * (points - 1)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _between(numbers: FloatArray, place: Whole, weight: Lanes) -> Lanes:
    """Return values of cells, linear in the weights of their upper ends (`between`)."""
    low, high = gather_pairs(numbers, place)
    return low * (1.0 - weight) + high * weight


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def place_lanes(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pitches: Lanes, approach: Lanes, table: FloatArray
) -> Lanes:
    """Write where the pairs are and how deep each is by itself [m]; return that depth."""
    points, count, place = index[layout.POINTS], index[layout.MISSING_POINTS], pitches - load(table, PAIR * LANES)
    along = smaller(larger(place * scalars[layout.PER_PITCH], 0.0), points - 1.0)
    cell = smaller(truncated(along), points - 2)
    weight = along - as_doubles(cell)
    store(table, POSITION * LANES, scalars[layout.START_M] + place * scalars[layout.PITCH_M])
    store(table, TOUCH * LANES, _between(numbers, truncated(load(table, TOUCH_ROW * LANES)) + cell, weight))
    first = truncated(load(table, COLUMN_ROW * LANES)) + cell
    column = gather(numbers, first + index[layout.COLUMN_AT])
    column = column + gather(numbers, first + index[layout.GAIN_AT]) * weight
    whole = smaller(truncated(column), index[layout.CONTACT_COLUMNS] - 2)
    curves = whole * (index[layout.CONTACT_NODES] * index[layout.CONTACT_VALUES]) + index[layout.CURVES_AT]
    store(table, CURVES * LANES, as_doubles(curves))
    store(table, SHARE * LANES, column - as_doubles(whole))
    if index[layout.APART] > 0:
        store(table, COUPLING * LANES, _between(numbers, cell + index[layout.COUPLING_AT], weight))
    missing = (place + scalars[layout.REACH_BEFORE]) * scalars[layout.MISSING_PER_PITCH]
    missing = smaller(larger(missing, 0.0), count - 1.0)
    cell = smaller(truncated(missing), count - 2)
    weight = missing - as_doubles(cell)
    first_m = _between(numbers, truncated(load(table, MISSED_1 * LANES)) + cell, weight)
    first_m = first_m + _between(numbers, truncated(load(table, MISSED_2 * LANES)) + cell, weight)
    depth = approach - (load(table, OFFSET * LANES) + first_m + scalars[layout.LEAD_M])
    store(table, DEPTH * LANES, depth)
    return depth
