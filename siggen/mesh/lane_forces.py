"""The pair law at three nodes in lanes: all forces at the nodes of one step.

What `write_node_forces` writes, since places, springs and loads are the same code: of two pairs with the same bytes, of
more with sums in another order; where pairs share a gear body both settle within `SMOOTH_CHANGE` from another guess.
That stays the way of all steps that lanes do not take: these take contacts across the face, while the same pairs are in
reach at all nodes and no back flank comes near. What passes from one step to the next stands in the table of pairs, so
that both ways may follow each other.

A lane is a pair at a node. Two pairs share a register: four lanes of the one with an even number, then of the other,
the last of each being node 2 once more, left out in the end. The latest two pairs in reach are in the first register,
those before in the next one.
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
    MOST_APART,
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
from siggen.mesh.pair_springs import (
    LEAST_CARRYING,
    Engaged,
    between,
    damped,
    engage,
    engaged,
    lubricated,
    placed,
    placed_contact,
    rubbed,
)
from siggen.mesh.springs import (
    LEAST_CHANGE,
    MOST_STEPS,
    SMOOTH_CHANGE,
    Before,
    PairPlace,
    Spring,
    contact_spring,
    settled_spring,
    spread,
)

# First part: the table of it, and where its pairs are.

_row = count()
APPLIES = next(_row)  # whether lanes can be used at all
REACHED = next(_row)
NODES_AT = next(_row)  # on [0, 1]
WEIGHTS = next(_row)  # of the nodes; none of the lanes that are left out
PAIR = next(_row)  # number of the pair; this and the next six stay while it is in reach (`pair_springs.Engaged`)
TOUCH_AT = next(_row)
COLUMNS_AT = next(_row)
MISSED_1_AT = next(_row)
MISSED_2_AT = next(_row)
OFFSET = next(_row)
INSIDE = next(_row)  # 1 in the lanes of a pair in reach, 0 elsewhere
DEPTH = next(_row)  # penetration by itself [m]
TOUCH = next(_row)  # the rest is what `pair_columns` says of the same names
CURVES = next(_row)
SHARE = next(_row)
COUPLING = next(_row)  # to the pair before, and in the next two rows to older ones
NORMAL = next(_row) + MOST_APART - 1
STIFFNESS = NORMAL + 1
YIELD = NORMAL + 2
MOMENT = NORMAL + 3
CROSS = NORMAL + 4
TURNING = NORMAL + 5
CARRYING = NORMAL + 6
ROUGH = NORMAL + 7
POSITION = NORMAL + 8
FORCE = NORMAL + 9  # of the spring alone
PENETRATION = NORMAL + 10  # and steps of Newton's method on coupled pairs, while NORMAL holds their penetration
ROWS = NORMAL + 11
LATEST, COUNT, LATEST_SLOT = range(3)
"""Lanes of the row REACHED: number of the latest pair in reach, how many are, and the slot of the latest."""
PAIRS = 2
"""Of a register."""
HALF = LANES // PAIRS
STEP_NODES = 3
LAST = 2
"""Lane of the last node, and half a register on that of the other pair."""
BOTH = 0b01110111
"""The lanes of both pairs that count."""

of_pairs = shuffle(0, 1, 2, 2, 0, 1, 2, 2)
"""Values at nodes, for the pairs there."""


def lane_table(law: PairLaw, nodes: FloatArray, weights: FloatArray) -> FloatArray:
    """Return the table (rows, LANES) of a law at nodes on [0, 1] with the weights of their quadrature.

    ROWS for every two slots; behind them what solves coupled pairs: coupling, matrix and right side of all slots.
    """
    registers = (law.slots + 1) // PAIRS
    table = aligned(np.zeros((registers * ROWS + law.slots * (2 * law.slots + 1), LANES)))
    head, first = law.places, law.places[layout.STIFFNESS_AT]
    rows = int(head[head[layout.TABLE_AT] :][: head[layout.TEETH_1] * head[layout.TEETH_2]].max()) + 1
    stiffness = law.numbers[first : first + rows * head[layout.POINTS]]
    applies = len(nodes) == STEP_NODES and head[layout.CONTACT_NODES] > 0
    table[APPLIES] = float(applies and bool((stiffness > 0.0).all()))
    table[NODES_AT, : len(nodes)] = nodes
    table[WEIGHTS].reshape(PAIRS, HALF)[:, : len(weights)] = weights
    table[PAIR : registers * ROWS : ROWS] = -1e9  # no pair yet, and a place that is a number
    return table


@njit(cache=True, _nrt=False, error_model="numpy")
def engage_lanes(law: PairLaw, table: FloatArray, latest: int, count: int, slots: int) -> None:
    """Write what stays as long as the same pairs are in reach: `count` of them up to the latest."""
    table[REACHED, LATEST], table[REACHED, COUNT], table[REACHED, LATEST_SLOT] = latest, count, latest % slots
    for c in range(max(count + count % PAIRS, PAIRS)):
        kept, row, first = engaged(law, latest - c), c // PAIRS * ROWS, _half(latest, c) * HALF
        for lane in range(first, first + HALF):
            table[row + PAIR, lane] = latest - c
            table[row + TOUCH_AT, lane], table[row + COLUMNS_AT, lane] = kept.touch, kept.columns
            table[row + MISSED_1_AT, lane], table[row + MISSED_2_AT, lane] = kept.missed_1, kept.missed_2
            table[row + OFFSET, lane] = kept.offset
            table[row + INSIDE, lane] = 1.0 if c < count else 0.0


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _half(latest: int, c: int) -> int:
    """Return in which half of its register the pair is that came c before the latest."""
    return (latest - c) % PAIRS


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _read(table: FloatArray, row: int) -> Lanes:
    return load(table, row * LANES)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def place_lanes(law: PairLaw, pitches: Lanes, approach: Lanes, table: FloatArray, row: int) -> Lanes:
    """Write where the pairs of the register from `row` on are and how deep each is by itself [m]; return that depth."""
    touch_at, columns_at = _read(table, row + TOUCH_AT), _read(table, row + COLUMNS_AT)
    missed_1, missed_2 = _read(table, row + MISSED_1_AT), _read(table, row + MISSED_2_AT)
    # Lanes take contacts alone: no stiffness of whole faces is asked for.
    kept = Engaged(touch_at, touch_at, touch_at, columns_at, missed_1, missed_2, _read(table, row + OFFSET))
    position, cell, weight, gap = placed(law, kept, pitches - _read(table, row + PAIR))
    touch, curves, share = placed_contact(law, touch_at, columns_at, cell, weight)
    store(table, (row + POSITION) * LANES, position)
    store(table, (row + TOUCH) * LANES, touch)
    store(table, (row + CURVES) * LANES, curves)
    store(table, (row + SHARE) * LANES, share)
    for apart in range(min(law.places[layout.APART], MOST_APART)):
        first = law.places[layout.COUPLING_AT] + apart * law.places[layout.POINTS]
        store(table, (row + COUPLING + apart) * LANES, between(law, cell + first, weight))
    depth = approach - gap
    store(table, (row + DEPTH) * LANES, depth)
    return depth


NOT_HERE = -(2**62)
"""Returned where lanes do not take a step, and nothing was written that matters."""
_of_even, _of_odd = shuffle(0, 1, 2, 3, 0, 1, 2, 3), shuffle(4, 5, 6, 7, 4, 5, 6, 7)
_of_other, _of_halves = shuffle(4, 5, 6, 7, 0, 1, 2, 3), shuffle(0, 0, 0, 0, 4, 4, 4, 4)
_node_1, _node_2 = shuffle(1, 1, 1, 1, 5, 5, 5, 5), shuffle(2, 2, 2, 2, 6, 6, 6, 6)


@entry(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def write_lane_forces(
    law: PairLaw, pitches_0: float, pitches_1: float, pairs: FloatArray, table: FloatArray, node: FloatArray
) -> int:
    """Write the forces at the nodes of a step, and return what `write_node_forces` does, or NOT_HERE.

    `table` of `lane_table`, the others as there; `node` is (NODE_ROWS, LANES).
    """
    if table[APPLIES, 0] == 0.0:
        return NOT_HERE
    scalars, slots = law.scalars, pairs.shape[0] // STEP_NODES
    pitches = pitches_0 + (pitches_1 - pitches_0) * of_pairs(_read(table, NODES_AT))
    first, last = extract(pitches, 0), extract(pitches, LAST)
    latest, count = int(np.floor(last + scalars[layout.REACH_BEFORE])), 0
    reach = scalars[layout.CONTACT_RATIO] + scalars[layout.REACH_AFTER]
    while last - (latest - count) < reach:
        count += 1
    if int(np.floor(first + scalars[layout.REACH_BEFORE])) != latest or first - (latest - count) < reach:
        return NOT_HERE
    if table[REACHED, LATEST] != latest or table[REACHED, COUNT] != count:
        engage_lanes(law, table, latest, count, slots)
    if count > PAIRS:
        return _write_many(law, pitches, pairs, table, node, latest, count)
    # Of one register the compiler keeps in registers what the loops over several pass on in the table.
    if not _place(law, pitches, table, node, ROWS):
        return NOT_HERE
    _write_two(law, pairs, table, of_pairs(_read(node, NODE_TILT)), latest)
    return _loaded(law, pairs, table, node, latest, count, ROWS)


@njit(cache=True, _nrt=False, error_model="numpy")
def _write_many(
    law: PairLaw, pitches: Lanes, pairs: FloatArray, table: FloatArray, node: FloatArray, latest: int, count: int
) -> int:
    """Write the forces of more pairs than a register holds."""
    end, tilt = (count + 1) // PAIRS * ROWS, of_pairs(_read(node, NODE_TILT))
    if not _place(law, pitches, table, node, end):
        return NOT_HERE
    if law.places[layout.APART] > 0:
        _write_coupled(law, pairs, table, tilt, latest, count)
    else:
        for row in range(0, end, ROWS):
            place = _placed(table, row)
            _write(table, row, contact_spring(law, place, tilt, place.depth))
    return _loaded(law, pairs, table, node, latest, count, end)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _place(law: PairLaw, pitches: Lanes, table: FloatArray, node: FloatArray, end: int) -> bool:
    """Write where all pairs are and how deep; return whether no back flank comes near."""
    approach = of_pairs(_read(node, NODE_APPROACH))
    for row in range(0, end, ROWS):
        depth = place_lanes(law, pitches, approach, table, row)
        backwards_m = 2.0 * (approach - _read(table, row + OFFSET)) - depth + law.scalars[layout.BACKLASH_M]
        if any_of((depth <= 0.0) & (backwards_m < 0.0) & (_read(table, row + INSIDE) > 0.0)):
            return False
    return True


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _loaded(
    law: PairLaw, pairs: FloatArray, table: FloatArray, node: FloatArray, latest: int, count: int, end: int
) -> int:
    """Write the forces that follow from the springs, and what the next step is guessed from; return what touches."""
    slots, same = pairs.shape[0] // STEP_NODES, _load(law, table, node, end)
    touching, digit, first_slot = 0, 1, int(table[REACHED, LATEST_SLOT])
    for slot in range(slots):
        i, c = LAST * slots + slot, _past(first_slot - slot, slots)
        pairs[i, columns.SPRUNG], pairs[i, columns.STIFFNESS] = 0.0, 0.0
        if c < count:
            for at in range(slot, STEP_NODES * slots, slots):
                if pairs[at, columns.PAIR] != latest - c:
                    engage(law, pairs, at, latest - c)
            row, lane = c // PAIRS * ROWS, LAST + _half(latest, c) * HALF
            pairs[i, columns.SPRUNG] = table[row + FORCE, lane]
            pairs[i, columns.STIFFNESS] = table[row + STIFFNESS, lane]
            pairs[i, columns.ALONE] = table[row + DEPTH, lane]
            touching += digit if table[row + FORCE, lane] > 0.0 else 0
        digit *= 3
    if law.places[layout.ROUGHNESSES] > 0:
        _rub(law, table, node, end)
    return touching if same else -1 - touching


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _past(number: int, slots: int) -> int:
    """Return a number from -slots on, modulo the slots."""
    return number if number >= 0 else number + slots


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _near(law: PairLaw, table: FloatArray, tilt: Lanes, row: int) -> Lanes:
    """Return 1 for the pairs that approach, 0 for others."""
    ahead = magnitude(tilt) * law.scalars[layout.CONTACT_HALF_FACE]  # how far one end of the face is
    return select(_read(table, row + DEPTH) + ahead > 0.0, _read(table, row + INSIDE), 0.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _placed(table: FloatArray, row: int) -> PairPlace:
    depth, touch = _read(table, row + DEPTH), _read(table, row + TOUCH)
    return PairPlace(depth, touch, _read(table, row + CURVES), _read(table, row + SHARE), 0.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write_two(law: PairLaw, pairs: FloatArray, table: FloatArray, tilt: Lanes, latest: int) -> None:
    """Write the springs of two pairs, on one gear body or not."""
    place = _placed(table, 0)
    c, both = splat(0.0), splat(0.0) > 0.0
    if law.places[layout.APART] > 0:
        shared, near = _read(table, COUPLING), _near(law, table, tilt, 0)
        both = near * _of_other(near) > 0.0
        c = select(both, _of_even(shared) if latest % PAIRS == 0 else _of_odd(shared), 0.0)
    at, force, yielding = _two_springs(law, place, tilt, c, both, _last(pairs, table, 0, latest, place.depth))
    _write(table, 0, settled_spring(at, force, place.depth - c * _of_other(force), yielding))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write(table: FloatArray, row: int, spring: Spring) -> None:
    """Write the springs of pairs in reach, and none elsewhere."""
    inside = _read(table, row + INSIDE) > 0.0
    for field, value, outside in (
        (FORCE, spring.force, 0.0), (STIFFNESS, spring.stiffness, 0.0), (YIELD, spring.yielding, 0.0),
        (MOMENT, spring.moment, 0.0), (CROSS, spring.cross, 0.0), (TURNING, spring.turning, 0.0),
        (CARRYING, spring.carrying, 1.0), (ROUGH, spring.rough, 0.0),
    ):  # fmt: skip
        store(table, (row + field) * LANES, select(inside, value, outside))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _last(pairs: FloatArray, table: FloatArray, row: int, latest: int, depth: Lanes) -> Before:
    """Return the springs of a register at the last node of the step before, zeros of other pairs."""
    force, stiffness, alone, slots = splat(0.0), splat(0.0), depth, pairs.shape[0] // STEP_NODES
    first_slot, first = int(table[REACHED, LATEST_SLOT]), row // ROWS * PAIRS
    for c in range(first, min(first + PAIRS, slots)):
        number = latest - c
        i, lane = LAST * slots + _past(first_slot - c, slots), _half(latest, c) * HALF
        if pairs[i, columns.PAIR] == number:
            force = insert(force, lane, pairs[i, columns.SPRUNG])
            stiffness = insert(stiffness, lane, pairs[i, columns.STIFFNESS])
            alone = insert(alone, lane, pairs[i, columns.ALONE])
    return Before(_of_halves(force), _of_halves(stiffness), depth - _of_halves(alone))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _two_springs(
    law: PairLaw, place: PairPlace, tilt: Lanes, c: Lanes, both: Choice, before: Before
) -> tuple[Spring, Lanes, Lanes]:
    """Return the last springs that were asked for, forces and stiffness to the approach, as `two_springs`.

    Lanes that are not coupled have their own.
    """
    force, k, change = before
    inverse = 1.0 / (1.0 - k * _of_other(k) * c * c)
    force = force + k * (change - c * _of_other(k) * _of_other(change)) * inverse
    at = contact_spring(law, place, tilt, place.depth - c * _of_other(force))
    for step in range(MOST_STEPS):
        k, other = at.stiffness, _of_other(force)
        inverse = 1.0 / (1.0 - k * _of_other(k) * c * c)
        change = (at.force - force - k * c * (_of_other(at.force) - other)) * inverse
        force = force + change
        size = magnitude(force)
        least = LEAST_CHANGE * larger(size, _of_other(size))
        left = select(both, select(magnitude(change) <= larger(SMOOTH_CHANGE * size, least), 0.0, 1.0), 0.0)
        if step == MOST_STEPS - 1 or not any_of(left > 0.0):
            break
        at = contact_spring(law, place, tilt, place.depth - c * _of_other(force))
    return at, select(both, force, at.force), k * (1.0 - c * _of_other(k)) * inverse


# Springs of more than two pairs on one gear body. Derived as those of two: (I + diag(k) C) Δf = F(p) - f at all nodes.
# Pairs are counted from the latest one; their matrices hold the nodes twice.


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _of_pair(values: Lanes, latest: int, c: int) -> Lanes:
    """Return the values of a pair of a register, in both halves."""
    return _of_even(values) if _half(latest, c) == 0 else _of_odd(values)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _joined(latest: int, later: Lanes, earlier: Lanes) -> Lanes:
    """Return a register of the values of its pairs."""
    even = _of_halves(insert(splat(0.0), 0, 1.0)) > 0.0
    return select(even, later, earlier) if latest % PAIRS == 0 else select(even, earlier, later)


@njit(cache=True, _nrt=False, error_model="numpy")
def _write_coupled(
    law: PairLaw, pairs: FloatArray, table: FloatArray, tilt: Lanes, latest: int, count: int
) -> None:  # fmt: skip
    """Write the springs of any number of pairs that share a gear body."""
    slots = pairs.shape[0] // STEP_NODES
    work, end = (slots + 1) // PAIRS * ROWS, (count + 1) // PAIRS * ROWS
    _write_couplings(law, table, tilt, work, latest, count)
    for row in range(0, end, ROWS):
        force, stiffness, change = _last(pairs, table, row, latest, _read(table, row + DEPTH))
        store(table, (row + FORCE) * LANES, force)
        store(table, (row + STIFFNESS) * LANES, stiffness)
        store(table, (row + PENETRATION) * LANES, stiffness * change)
    _solve(table, work, PENETRATION, latest, count)
    _add(table, end)
    for _ in range(MOST_STEPS):
        for row in range(0, end, ROWS):
            penetration = _read(table, row + DEPTH) - _others(table, work, row, latest, count)
            store(table, (row + NORMAL) * LANES, penetration)
        for row in range(0, end, ROWS):
            force, penetration = _read(table, row + FORCE), _read(table, row + NORMAL)
            at = contact_spring(law, _placed(table, row), tilt, penetration)
            _write(table, row, at)
            change = select(_read(table, row + INSIDE) > 0.0, at.force - force, 0.0)
            store(table, (row + FORCE) * LANES, force)
            store(table, (row + PENETRATION) * LANES, change)
        _solve(table, work, PENETRATION, latest, count)
        if _add(table, end):
            break
    _solve(table, work, STIFFNESS, latest, count)
    for row in range(0, end, ROWS):
        last = Spring(
            _read(table, row + FORCE), _read(table, row + STIFFNESS), _read(table, row + PENETRATION),
            _read(table, row + NORMAL), _read(table, row + MOMENT), _read(table, row + CROSS),
            _read(table, row + TURNING), _read(table, row + CARRYING), _read(table, row + ROUGH),
        )  # fmt: skip
        coupled = _read(table, row + DEPTH) - _others(table, work, row, latest, count)
        _write(table, row, settled_spring(last, last.force, coupled, last.yielding))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write_couplings(law: PairLaw, table: FloatArray, tilt: Lanes, work: int, latest: int, count: int) -> None:
    """Write what a unit force on every pair moves every other one by, of those that approach [m/N]."""
    apart = min(law.places[layout.APART], MOST_APART)
    for i in range(count):
        near_i = _of_pair(_near(law, table, tilt, i // PAIRS * ROWS), latest, i)
        store(table, (work + i * count + i) * LANES, splat(0.0))
        for j in range(i + 1, count):
            c = splat(0.0)
            if j - i <= apart:  # the later of two pairs knows it
                near_j = _of_pair(_near(law, table, tilt, j // PAIRS * ROWS), latest, j)
                c = _of_pair(_read(table, i // PAIRS * ROWS + COUPLING + j - i - 1), latest, i) * (near_i * near_j)
            store(table, (work + i * count + j) * LANES, c)
            store(table, (work + j * count + i) * LANES, c)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _others(table: FloatArray, work: int, row: int, latest: int, count: int) -> Lanes:
    """Return by how much the forces of the others keep the pairs of a register apart [m]."""
    i, later, earlier = row // ROWS * PAIRS, splat(0.0), splat(0.0)
    for j in range(count):
        force = _of_pair(_read(table, j // PAIRS * ROWS + FORCE), latest, j)
        later = later + _read(table, work + i * count + j) * force
        if i + 1 < count:
            earlier = earlier + _read(table, work + (i + 1) * count + j) * force
    return _joined(latest, later, earlier)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _solve(table: FloatArray, work: int, field: int, latest: int, count: int) -> None:
    """Write into PENETRATION what solves the system for a field.

    It is a positive definite one whose rows are multiplied by stiffnesses, since the energy is convex: no pivoting.
    """
    matrix = work + count * count
    right = matrix + count * count
    for i in range(count):
        row = i // PAIRS * ROWS
        store(table, (right + i) * LANES, _of_pair(_read(table, row + field), latest, i))
        stiffness = _of_pair(_read(table, row + STIFFNESS), latest, i)
        for j in range(count):
            value = stiffness * _read(table, work + i * count + j)
            store(table, (matrix + i * count + j) * LANES, value + 1.0 if i == j else value)
    for k in range(count):
        inverse = 1.0 / _read(table, matrix + k * count + k)
        for i in range(k + 1, count):
            factor = _read(table, matrix + i * count + k) * inverse
            for j in range(k + 1, count):
                value = _read(table, matrix + i * count + j) - factor * _read(table, matrix + k * count + j)
                store(table, (matrix + i * count + j) * LANES, value)
            store(table, (right + i) * LANES, _read(table, right + i) - factor * _read(table, right + k))
    for i in range(count - 1, -1, -1):
        value = _read(table, right + i)
        for j in range(i + 1, count):
            value = value - _read(table, matrix + i * count + j) * _read(table, right + j)
        store(table, (right + i) * LANES, value / _read(table, matrix + i * count + i))
    for i in range(0, count, PAIRS):
        later = _read(table, right + i)
        earlier = _read(table, right + i + 1) if i + 1 < count else splat(0.0)
        store(table, (i // PAIRS * ROWS + PENETRATION) * LANES, _joined(latest, later, earlier))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _add(table: FloatArray, end: int) -> bool:
    """Add Newton's step, which stands in PENETRATION, to the forces; return whether all of them are settled."""
    largest = splat(0.0)
    for row in range(0, end, ROWS):
        force = _read(table, row + FORCE) + _read(table, row + PENETRATION)
        store(table, (row + FORCE) * LANES, force)
        largest = larger(largest, larger(magnitude(force), _of_other(magnitude(force))))
    settled = True
    for row in range(0, end, ROWS):
        allowed = larger(SMOOTH_CHANGE * magnitude(_read(table, row + FORCE)), LEAST_CHANGE * largest)
        settled = settled and not any_of(magnitude(_read(table, row + PENETRATION)) > allowed)
    return settled


# Dampers and friction.


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _and(sum_of: Lanes, chosen: Choice, values: Lanes) -> Lanes:
    """Return a sum at the nodes and the values of both pairs, where chosen."""
    values = select(chosen, values, 0.0)
    return sum_of + _of_even(values) + _of_odd(values)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _load(law: PairLaw, table: FloatArray, node: FloatArray, end: int) -> bool:
    """Add springs and dampers of all pairs; return whether each touches at all nodes or at none."""
    total = splat(0.0)
    for row in range(0, end, ROWS):
        stiffness = _read(table, row + STIFFNESS)
        total = total + _of_even(stiffness) + _of_odd(stiffness)
    shared = select(total > 0.0, 1.0 / square_root(total), 0.0)
    rate, tilt_rate = of_pairs(_read(node, NODE_RATE)), of_pairs(_read(node, NODE_TILT_RATE))
    normal, slope, slope_rate, moment = splat(0.0), splat(0.0), splat(0.0), splat(0.0)
    same = True
    for row in range(0, end, ROWS):
        spring = Spring(
            _read(table, row + FORCE), _read(table, row + STIFFNESS), _read(table, row + YIELD),
            _read(table, row + DEPTH), _read(table, row + MOMENT), _read(table, row + CROSS),
            _read(table, row + TURNING), _read(table, row + CARRYING), _read(table, row + ROUGH),
        )  # fmt: skip
        force = damped(law, _damping_root(law, table, row, spring) * shared, rate, tilt_rate, spring)
        store(table, (row + MOMENT) * LANES, force.moment)
        store(table, (row + NORMAL) * LANES, force.force)
        normal, slope = _and(normal, force.carries, force.force), _and(slope, force.carries, spring.yielding)
        slope_rate = _and(slope_rate, force.carries, force.damping)
        moment = _and(moment, force.carries, force.moment)
        touches = bits(spring.force > 0.0) & BOTH
        same = same and touches == 7 * (touches >> LAST & 0x11)
    store(node, NODE_NORMAL * LANES, normal)
    store(node, NODE_SLOPE * LANES, slope)
    store(node, NODE_SLOPE_RATE * LANES, slope_rate)
    store(node, NODE_MOMENT * LANES, moment)
    return same


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _damping_root(law: PairLaw, table: FloatArray, row: int, spring: Spring) -> Lanes:
    """Return c √Σk/k of a register's pairs, by the share of the load that asperities carry, the same at all nodes."""
    scalars = law.scalars
    if law.places[layout.SHARE_DAMPS] == 0:
        return splat(scalars[layout.DAMPING_ROOT])
    drives, weights = spring.force > 0.0, _read(table, WEIGHTS)
    whole = _mean(weights, drives, splat(1.0))
    load_n = _mean(weights, drives, spring.force)
    carrying = _mean(weights, drives, spring.carrying)
    loaded = load_n > 0.0
    held = select(loaded, whole, 1.0)
    load_n = select(loaded, load_n / larger(carrying, LEAST_CARRYING * held), 0.0)
    position = _mean(weights, drives, _read(table, row + POSITION)) / held
    share, _ = lubricated(law, position, load_n, _mean(weights, drives, spring.rough) / held, loaded)
    least = scalars[layout.DAMPING_STRUCTURE] + scalars[layout.DAMPING_FILM]
    root = scalars[layout.DAMPING_STRUCTURE] + scalars[layout.DAMPING_FILM] * (1.0 - share)
    return select(loaded, root + scalars[layout.DAMPING_ASPERITIES] * share, least)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _mean(weights: Lanes, chosen: Choice, values: Lanes) -> Lanes:
    """Return the weighted sum over the nodes of each pair, where chosen."""
    values = select(chosen, weights * values, 0.0)
    return 0.0 + _of_halves(values) + _node_1(values) + _node_2(values)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _rub(law: PairLaw, table: FloatArray, node: FloatArray, end: int) -> None:
    """Add the friction of all pairs."""
    sum_friction, sum_arm, turn = splat(0.0), splat(0.0), splat(0.0)
    sliding_0, sliding_1 = of_pairs(_read(node, NODE_SLIDING_0)), of_pairs(_read(node, NODE_SLIDING_1))
    for row in range(0, end, ROWS):
        force, here = _read(table, row + NORMAL), _read(table, row + POSITION)
        rubs = force > 0.0
        if not any_of(rubs):
            continue
        faces = _read(table, row + CARRYING), _read(table, row + ROUGH)
        if law.places[layout.SPREAD_AT] > 0:
            friction, arm = splat(0.0), splat(0.0)
            for part in spread(law, here):
                chosen = rubs & (part.share > 0.0)
                if any_of(chosen):
                    sliding = sliding_0 + part.place * sliding_1
                    rubbing = part.share * rubbed(law, force, part.place, faces, sliding).friction
                    friction = select(chosen, friction + rubbing, friction)
                    arm = select(chosen, arm + part.place * rubbing, arm)
        else:
            friction = rubbed(law, force, here, faces, sliding_0 + here * sliding_1).friction
            arm = here * friction
        sum_friction, sum_arm = _and(sum_friction, rubs, friction), _and(sum_arm, rubs, arm)
        if law.places[layout.CONTACT_VALUES] > 4:
            turn = _and(turn, rubs, friction * _read(table, row + MOMENT) / force)
    store(node, NODE_FRICTION * LANES, sum_friction)
    store(node, NODE_ARM * LANES, sum_arm)
    store(node, NODE_TURN * LANES, turn)
