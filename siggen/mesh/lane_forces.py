"""The pair law of two slots at three nodes in lanes: all forces at the nodes of one step.

What `write_node_forces` writes, since places, springs and loads are the same code: with the same bytes, but where pairs
share a gear body, which both settle within `SMOOTH_CHANGE` from another guess. That stays the way of all laws and steps
that lanes do not take: these take contacts across the face, while the same pairs are in reach at all nodes and no back
flank comes near. What passes from one step to the next stands in the table of pairs, so that both ways may follow each
other.
"""

from __future__ import annotations

from itertools import count

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.lanes import (
    LANES,
    Choice,
    Lanes,
    aligned,
    any_of,
    bits,
    extract,
    insert,
    larger,
    load,
    magnitude,
    select,
    shuffle,
    splat,
    square_root,
    store,
)
from siggen.mesh import pair_columns as columns
from siggen.mesh import pair_law as layout
from siggen.mesh.pair_columns import (
    NODE_APPROACH,
    NODE_ARM,
    NODE_FRICTION,
    NODE_MOMENT,
    NODE_NORMAL,
    NODE_RATE,
    NODE_SLIDING_0,
    NODE_SLIDING_1,
    NODE_SLOPE,
    NODE_SLOPE_RATE,
    NODE_TILT,
    NODE_TILT_RATE,
    NODE_TURN,
)
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.pair_springs import Engaged, between, damped, engage, engaged, placed, placed_contact, rubbed
from siggen.mesh.springs import (
    LEAST_CHANGE,
    MOST_STEPS,
    SMOOTH_CHANGE,
    Before,
    PairPlace,
    Spring,
    contact_spring,
    settled_spring,
)

# The pair law of two slots at three nodes in lanes, first part: the table of it, and where its pairs are.
#
# A lane is a pair at a node: slots 0 and 1 at node 0, then at node 1, then at node 2. The last two lanes hold node 2
# once more and are left out in the end.

_row = count()
APPLIES = next(_row)  # whether lanes can be used at all
NODES_AT = next(_row)  # on [0, 1]
SLOT_AT = next(_row)  # of the pair in each lane
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
    table[SLOT_AT] = np.arange(LANES) % SLOTS
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


NOT_HERE = -1000
"""Returned where lanes do not take a step, and nothing was written that matters."""
_of_slot_0, _of_slot_1 = shuffle(0, 0, 2, 2, 4, 4, 6, 6), shuffle(1, 1, 3, 3, 5, 5, 7, 7)
_of_other_slot, _of_nodes = shuffle(1, 0, 3, 2, 5, 4, 7, 6), shuffle(0, 1, 0, 1, 0, 1, 0, 1)
_at_nodes = shuffle(0, 2, 4, 6, 0, 2, 4, 6)


@entry(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def write_lane_forces(
    law: PairLaw, pitches_0: float, pitches_1: float, pairs: FloatArray, table: FloatArray, node: FloatArray
) -> int:
    """Write the forces at the nodes of a step, and return what `write_node_forces` does, or NOT_HERE.

    `table` of `lane_table`, the others as there; `node` is (NODE_ROWS, LANES).
    """
    if table[APPLIES, 0] == 0.0:
        return NOT_HERE
    scalars = law.scalars
    pitches = pitches_0 + (pitches_1 - pitches_0) * of_pairs(load(table, NODES_AT * LANES))
    first, last = extract(pitches, 0), extract(pitches, 4)
    pair = int(np.floor(last + scalars[layout.REACH_BEFORE]))
    reach = scalars[layout.CONTACT_RATIO] + scalars[layout.REACH_AFTER]
    older = last - (pair - 1) < reach
    if int(np.floor(first + scalars[layout.REACH_BEFORE])) != pair or (first - (pair - 1) < reach) != older:
        return NOT_HERE
    slot = pair % SLOTS
    if table[PAIR, slot] != pair:
        engage_lanes(law, table, slot, pair)
    if older and table[PAIR, 1 - slot] != pair - 1:
        engage_lanes(law, table, 1 - slot, pair - 1)
    inside = BOTH if older else BOTH // 3 << slot
    approach = of_pairs(load(node, NODE_APPROACH * LANES))
    depth = place_lanes(law, pitches, approach, table)
    placed = approach - load(table, OFFSET * LANES)
    behind = (depth <= 0.0) & (2.0 * placed - depth < -scalars[layout.BACKLASH_M])
    if bits(behind) & inside != 0:
        return NOT_HERE
    tilt = of_pairs(load(node, NODE_TILT * LANES))
    here = (load(table, SLOT_AT * LANES) == float(slot)) | (splat(1.0 if older else 0.0) > 0.0)
    ahead = magnitude(tilt) * law.scalars[layout.CONTACT_HALF_FACE]  # how far one end of the face is
    _write_springs(law, pairs, table, tilt, here & (depth + ahead > 0.0), here, pair)
    for s in range(SLOTS):
        pairs[4 + s, columns.SPRUNG], pairs[4 + s, columns.STIFFNESS] = table[NORMAL, 4 + s], table[STIFFNESS, 4 + s]
    touching = _load(law, table, node)
    for s in range(SLOTS):
        if inside >> s & 1 != 0:
            number = pair if s == slot else pair - 1
            for i in range(s, 3 * SLOTS, SLOTS):
                if pairs[i, columns.PAIR] != number:
                    engage(law, pairs, i, number)
            pairs[4 + s, columns.ALONE] = table[DEPTH, 4 + s]
    if law.places[layout.ROUGHNESSES] > 0:
        _rub(law, table, node)
    return touching


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write_springs(
    law: PairLaw, pairs: FloatArray, table: FloatArray, tilt: Lanes, near: Choice, inside: Choice, pair: int
) -> None:
    """Write the springs of all lanes; `near` are those that approach; `pair` is the later one."""
    slot, depth = pair % SLOTS, load(table, DEPTH * LANES)
    place = PairPlace(depth, load(table, TOUCH * LANES), load(table, CURVES * LANES), load(table, SHARE * LANES), 0.0)
    c, both = splat(0.0), splat(0.0) > 0.0
    if law.places[layout.APART] > 0:
        shared, coming = load(table, COUPLING * LANES), select(near, 1.0, 0.0)
        both = coming * _of_other_slot(coming) > 0.0
        c = select(both, _of_slot_0(shared) if slot == 0 else _of_slot_1(shared), 0.0)
    at, force, yielding = _two_springs(law, place, tilt, c, both, _last(pairs, slot, pair, depth))
    found = settled_spring(at, force, depth - c * _of_other_slot(force), yielding)
    for row, value, outside in (
        (NORMAL, found.force, 0.0), (STIFFNESS, found.stiffness, 0.0), (YIELD, found.yielding, 0.0),
        (MOMENT, found.moment, 0.0), (CROSS, found.cross, 0.0), (TURNING, found.turning, 0.0),
        (CARRYING, found.carrying, 1.0), (ROUGH, found.rough, 0.0),
    ):  # fmt: skip
        store(table, row * LANES, select(inside, value, outside))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _last(pairs: FloatArray, slot: int, pair: int, depth: Lanes) -> Before:
    """Return the springs at the last node of the step before, zeros of other pairs."""
    force, stiffness, alone = splat(0.0), splat(0.0), depth
    for s in range(SLOTS):
        i = 4 + s
        if pairs[i, columns.PAIR] == (pair if s == slot else pair - 1):
            force = insert(force, s, pairs[i, columns.SPRUNG])
            stiffness = insert(stiffness, s, pairs[i, columns.STIFFNESS])
            alone = insert(alone, s, pairs[i, columns.ALONE])
    return Before(_of_nodes(force), _of_nodes(stiffness), depth - _of_nodes(alone))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _two_springs(
    law: PairLaw, place: PairPlace, tilt: Lanes, c: Lanes, both: Choice, before: Before
) -> tuple[Spring, Lanes, Lanes]:
    """Return the last springs that were asked for, forces and stiffness to the approach, as `two_springs`.

    Lanes that are not coupled have their own.
    """
    force, k, change = before
    inverse = 1.0 / (1.0 - k * _of_other_slot(k) * c * c)
    force = force + k * (change - c * _of_other_slot(k) * _of_other_slot(change)) * inverse
    at = contact_spring(law, place, tilt, place.depth - c * _of_other_slot(force))
    for step in range(MOST_STEPS):
        k, other = at.stiffness, _of_other_slot(force)
        inverse = 1.0 / (1.0 - k * _of_other_slot(k) * c * c)
        change = (at.force - force - k * c * (_of_other_slot(at.force) - other)) * inverse
        force = force + change
        size = magnitude(force)
        least = LEAST_CHANGE * larger(size, _of_other_slot(size))
        left = select(both, select(magnitude(change) <= larger(SMOOTH_CHANGE * size, least), 0.0, 1.0), 0.0)
        if step == MOST_STEPS - 1 or not any_of(left > 0.0):
            break
        at = contact_spring(law, place, tilt, place.depth - c * _of_other_slot(force))
    return at, select(both, force, at.force), k * (1.0 - c * _of_other_slot(k)) * inverse


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _summed(node: FloatArray, row: int, chosen: Choice, values: Lanes) -> None:
    """Write the sum over both slots at all nodes."""
    values = select(chosen, values, 0.0)
    store(node, row * LANES, _at_nodes(0.0 + _of_slot_0(values) + _of_slot_1(values)))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _load(law: PairLaw, table: FloatArray, node: FloatArray) -> int:
    """Add springs and dampers of all pairs; return which slots touch."""
    spring = Spring(
        load(table, NORMAL * LANES), load(table, STIFFNESS * LANES), load(table, YIELD * LANES),
        load(table, DEPTH * LANES), load(table, MOMENT * LANES), load(table, CROSS * LANES),
        load(table, TURNING * LANES), load(table, CARRYING * LANES), load(table, ROUGH * LANES),
    )  # fmt: skip
    total = 0.0 + _of_slot_0(spring.stiffness) + _of_slot_1(spring.stiffness)
    root = law.scalars[layout.DAMPING_ROOT] * select(total > 0.0, 1.0 / square_root(total), 0.0)
    rate, tilt_rate = of_pairs(load(node, NODE_RATE * LANES)), of_pairs(load(node, NODE_TILT_RATE * LANES))
    found = damped(law, root, rate, tilt_rate, spring)
    store(table, MOMENT * LANES, found.moment)
    store(table, NORMAL * LANES, found.force)
    _summed(node, NODE_NORMAL, found.carries, found.force)
    _summed(node, NODE_SLOPE, found.carries, spring.yielding)
    _summed(node, NODE_SLOPE_RATE, found.carries, found.damping)
    _summed(node, NODE_MOMENT, found.carries, found.moment)
    for row in (NODE_FRICTION, NODE_ARM, NODE_TURN):
        store(node, row * LANES, splat(0.0))
    touches, pulls = bits(spring.force > 0.0) & BOTH, bits(spring.force < 0.0) & BOTH
    touching = _digits(touches >> 4) + 2 * _digits(pulls >> 4)
    same = touches == 21 * (touches & 3) and pulls == 21 * (pulls & 3)  # 21: once more at every node
    return touching if same else -1 - touching


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _digits(chosen: int) -> int:
    """Return a digit to the base 3 per slot."""
    return (chosen & 1) + 3 * (chosen >> 1 & 1)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _rub(law: PairLaw, table: FloatArray, node: FloatArray) -> None:
    """Add the friction of all pairs."""
    force, here = load(table, NORMAL * LANES), load(table, POSITION * LANES)
    rubs = force > 0.0
    if not any_of(rubs):
        return
    faces = load(table, CARRYING * LANES), load(table, ROUGH * LANES)
    sliding = of_pairs(load(node, NODE_SLIDING_0 * LANES)) + here * of_pairs(load(node, NODE_SLIDING_1 * LANES))
    friction = rubbed(law, force, here, faces, sliding).friction
    _summed(node, NODE_FRICTION, rubs, friction)
    _summed(node, NODE_ARM, rubs, here * friction)
    if law.places[layout.CONTACT_VALUES] > 4:
        _summed(node, NODE_TURN, rubs, friction * load(table, MOMENT * LANES) / force)
