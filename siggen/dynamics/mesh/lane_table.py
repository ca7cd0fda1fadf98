"""The pair law of two slots at three nodes in lanes, first part: the table of it, and where its pairs are.

A lane is a pair at a node: slots 0 and 1 at node 0, then at node 1, then at node 2. The last two lanes hold node 2 once
more and are left out in the end.
"""

from __future__ import annotations

from itertools import count

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.mesh.pair_places import Engaged, between, engaged, placed, placed_contact
from siggen.lanes import LANES, Lanes, aligned, load, shuffle, store

_row = count()
APPLIES = next(_row)  # whether lanes can be used at all
NODES_AT = next(_row)  # on [0, 1]
PAIR = next(_row)  # number of the pair; this and the next five stay while it is engaged (`pair_places.Engaged`)
TOUCH_AT = next(_row)
COLUMNS_AT = next(_row)
MISSED_1_AT = next(_row)
MISSED_2_AT = next(_row)
OFFSET = next(_row)
DEPTH = next(_row)  # penetration by itself [m]
TOUCH = next(_row)  # the rest is what `pair_columns` says of the same names
CURVES = next(_row)
SHARE = next(_row)
COUPLING = next(_row)
NORMAL = next(_row)
STIFFNESS = next(_row)
YIELD = next(_row)
MOMENT = next(_row)
CROSS = next(_row)
TURNING = next(_row)
CARRYING = next(_row)
ROUGH = next(_row)
POSITION = next(_row)
ROWS = next(_row)
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
    plain = head[layout.SHARE_DAMPS] == 0 and head[layout.SPREAD_AT] == 0
    applies = plain and law.slots == SLOTS and len(nodes) == 3 and head[layout.CONTACT_NODES] > 0
    table[APPLIES] = float(applies and bool((stiffness > 0.0).all()))
    table[NODES_AT, : len(nodes)] = nodes
    table[PAIR] = -1e9  # no pair yet, and a place that is a number
    return table


@njit(cache=True, _nrt=False, error_model="numpy")
def engage_lanes(law: PairLaw, table: FloatArray, slot: int, pair: int) -> None:
    """Write what stays during the engagement of a pair into the lanes of its slot."""
    kept = engaged(law, pair)
    for lane in range(slot, LANES, SLOTS):
        table[PAIR, lane] = pair
        table[TOUCH_AT, lane], table[COLUMNS_AT, lane] = kept.touch, kept.columns
        table[MISSED_1_AT, lane], table[MISSED_2_AT, lane] = kept.missed_1, kept.missed_2
        table[OFFSET, lane] = kept.offset


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def place_lanes(law: PairLaw, pitches: Lanes, approach: Lanes, table: FloatArray) -> Lanes:
    """Write where the pairs are and how deep each is by itself [m]; return that depth."""
    touch_at, columns_at = load(table, TOUCH_AT * LANES), load(table, COLUMNS_AT * LANES)
    missed_1, missed_2 = load(table, MISSED_1_AT * LANES), load(table, MISSED_2_AT * LANES)
    # Lanes take contacts alone: no stiffness of whole faces is asked for.
    kept = Engaged(touch_at, touch_at, touch_at, columns_at, missed_1, missed_2, load(table, OFFSET * LANES))
    position, cell, weight, gap = placed(law, kept, pitches - load(table, PAIR * LANES))
    touch, curves, share = placed_contact(law, touch_at, columns_at, cell, weight)
    store(table, POSITION * LANES, position)
    store(table, TOUCH * LANES, touch)
    store(table, CURVES * LANES, curves)
    store(table, SHARE * LANES, share)
    if law.places[layout.APART] > 0:
        store(table, COUPLING * LANES, between(law, cell + law.places[layout.COUPLING_AT], weight))
    depth = approach - gap
    store(table, DEPTH * LANES, depth)
    return depth
