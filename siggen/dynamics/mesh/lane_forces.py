"""The pair law of two slots at three nodes in lanes, last part: all forces at the nodes of one step.

What `write_node_forces` writes, with the same bytes: it stays the way of all laws and steps that lanes do not take, and
the reference of the test. Lanes take contacts across the face without film, while the same pairs are in reach at all
nodes and no back flank comes near. What passes from one step to the next stands in the table of pairs, so that both
ways may follow each other.
"""

from __future__ import annotations

from math import log, tanh

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_columns as columns
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.lane_springs import write_alone, write_two
from siggen.dynamics.mesh.lane_table import (
    APPLIES,
    BOTH,
    CARRYING,
    CROSS,
    DEPTH,
    MOMENT,
    NODES_AT,
    NORMAL,
    OFFSET,
    PAIR,
    POSITION,
    ROUGH,
    SCRATCH,
    SLOTS,
    STIFFNESS,
    TURNING,
    YIELD,
    engage_lanes,
    of_pairs,
    place_lanes,
)
from siggen.dynamics.mesh.node_forces import LEAST_CARRYING, STRAIGHT
from siggen.dynamics.mesh.pair_columns import (
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
from siggen.dynamics.mesh.pair_places import engage_pair
from siggen.lanes import (
    LANES,
    Choice,
    Lanes,
    Whole,
    as_doubles,
    bits,
    extract,
    gather_pairs,
    larger,
    load,
    magnitude,
    select,
    shuffle,
    smaller,
    splat,
    square_root,
    store,
    truncated,
)

NOT_HERE = -1000
"""Returned where lanes do not take a step, and nothing was written that matters."""
_of_slot_0, _of_slot_1 = shuffle(0, 0, 2, 2, 4, 4, 6, 6), shuffle(1, 1, 3, 3, 5, 5, 7, 7)
_at_nodes = shuffle(0, 2, 4, 6, 0, 2, 4, 6)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def write_lane_forces(
    scalars: FloatArray,
    numbers: FloatArray,
    index: IntArray,
    pitches_0: float,
    pitches_1: float,
    pairs: FloatArray,
    table: FloatArray,
    node: FloatArray,
) -> int:
    """Write the forces at the nodes of a step, and return what `write_node_forces` does, or NOT_HERE.

    `table` of `lane_table`, the others as there; `node` is (NODE_ROWS, LANES).
    """
    if table[APPLIES, 0] == 0.0:
        return NOT_HERE
    pitches = pitches_0 + (pitches_1 - pitches_0) * of_pairs(load(table, NODES_AT * LANES))
    first, last = extract(pitches, 0), extract(pitches, 4)
    pair = int(np.floor(last + scalars[layout.REACH_BEFORE]))
    reach = scalars[layout.CONTACT_RATIO] + scalars[layout.REACH_AFTER]
    older = last - (pair - 1) < reach
    if int(np.floor(first + scalars[layout.REACH_BEFORE])) != pair or (first - (pair - 1) < reach) != older:
        return NOT_HERE
    slot = pair % SLOTS
    if table[PAIR, slot] != pair:
        engage_lanes(numbers, index, table, slot, pair)
    if older and table[PAIR, 1 - slot] != pair - 1:
        engage_lanes(numbers, index, table, 1 - slot, pair - 1)
    inside = BOTH if older else BOTH // 3 << slot
    approach = of_pairs(load(node, NODE_APPROACH * LANES))
    depth = place_lanes(scalars, numbers, index, pitches, approach, table)
    behind = (depth <= 0.0) & (approach - load(table, OFFSET * LANES) < -scalars[layout.BACKLASH_M])
    if bits(behind) & inside != 0:
        return NOT_HERE
    _write_springs(scalars, numbers, index, pairs, table, node, bits(depth > 0.0) & inside, inside, slot, pair)
    touching = _load(scalars, index, table, node)
    for s in range(SLOTS):
        if inside >> s & 1 != 0:
            number = pair if s == slot else pair - 1
            for i in range(s, 3 * SLOTS, SLOTS):
                if pairs[i, columns.PAIR] != number:
                    engage_pair(numbers, index, pairs, i, number)
            pairs[4 + s, columns.ALONE] = table[DEPTH, 4 + s]
        pairs[4 + s, columns.NORMAL], pairs[4 + s, columns.STIFFNESS] = table[NORMAL, 4 + s], table[STIFFNESS, 4 + s]
    if index[layout.ROUGHNESSES] > 0:
        _rub(scalars, numbers, index, table, node)
    return touching


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write_springs(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, table: FloatArray, node: FloatArray,
    near: int, inside: int, slot: int, pair: int,
) -> None:  # fmt: skip
    """Write the springs of all lanes; `near` are those that approach, by bits."""
    tilts = index[layout.CONTACT_VALUES] > 4
    for i in range(0, 3 * SLOTS, SLOTS):
        tilt = node[NODE_TILT, i // SLOTS] if tilts else 0.0
        if index[layout.APART] == 0 or near >> i & 3 != 3:
            write_alone(scalars, numbers, index, table, i, tilt, inside >> i & 1 != 0)
            write_alone(scalars, numbers, index, table, i + 1, tilt, inside >> i & 2 != 0)
            continue
        later, earlier = i + slot, i + 1 - slot
        if i > 0:
            before_i, before_j = _before(table, later), _before(table, earlier)
        else:
            before_i = _last(pairs, 4 + slot, pair, table[DEPTH, later])
            before_j = _last(pairs, 5 - slot, pair - 1, table[DEPTH, earlier])
        write_two(scalars, numbers, index, table, later, earlier, tilt, before_i, before_j)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _before(table: FloatArray, lane: int) -> tuple[float, float, float]:
    """Return force and stiffness at the node before, and the change of the depth since then."""
    before = lane - SLOTS
    return table[NORMAL, before], table[STIFFNESS, before], table[DEPTH, lane] - table[DEPTH, before]


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _last(pairs: FloatArray, i: int, pair: int, depth: float) -> tuple[float, float, float]:
    """Return the same of the last node of the step before, zeros of another pair."""
    if pairs[i, columns.PAIR] != pair:
        return 0.0, 0.0, 0.0
    return pairs[i, columns.NORMAL], pairs[i, columns.STIFFNESS], depth - pairs[i, columns.ALONE]


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _summed(node: FloatArray, row: int, chosen: Choice, values: Lanes) -> None:
    """Write the sum over both slots at all nodes."""
    values = select(chosen, values, 0.0)
    store(node, row * LANES, _at_nodes(0.0 + _of_slot_0(values) + _of_slot_1(values)))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _load(scalars: FloatArray, index: IntArray, table: FloatArray, node: FloatArray) -> int:
    """Add springs and dampers of all pairs (`node_forces._load`); return which slots touch."""
    elastic, stiffness = load(table, NORMAL * LANES), load(table, STIFFNESS * LANES)
    driven, back = elastic > 0.0, elastic < 0.0
    flank = select(driven, 1.0, select(back, splat(-1.0), 0.0))
    total = 0.0 + _of_slot_0(stiffness) + _of_slot_1(stiffness)
    shared = select(total > 0.0, 1.0 / square_root(total), 0.0)
    rate = of_pairs(load(node, NODE_RATE * LANES))
    damped = scalars[layout.DAMPING_ROOT] * shared
    damping = damped * stiffness
    force = elastic + damping * rate
    moment = splat(0.0)
    if index[layout.CONTACT_VALUES] > 4:
        cross, tilt_rate = load(table, CROSS * LANES), damped * of_pairs(load(node, NODE_TILT_RATE * LANES))
        force = select(driven, force + cross * tilt_rate, force)
        turned = load(table, TURNING * LANES) * tilt_rate
        moment = load(table, MOMENT * LANES) + damped * cross * rate + turned
        moment = select(driven & (force > 0.0), moment, 0.0)
        store(table, MOMENT * LANES, moment)
    carries = force * flank > 0.0
    store(table, NORMAL * LANES, select(carries, force, 0.0))
    _summed(node, NODE_NORMAL, carries, force)
    _summed(node, NODE_SLOPE, carries, load(table, YIELD * LANES))
    _summed(node, NODE_SLOPE_RATE, carries, damping)
    _summed(node, NODE_MOMENT, driven, moment)
    for row in (NODE_FRICTION, NODE_ARM, NODE_TURN):
        store(node, row * LANES, splat(0.0))
    touches, pulls = bits(driven) & BOTH, bits(back) & BOTH
    touching = _digits(touches >> 4) + 2 * _digits(pulls >> 4)
    same = touches == 21 * (touches & 3) and pulls == 21 * (pulls & 3)  # 21: once more at every node
    return touching if same else -1 - touching


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _digits(chosen: int) -> int:
    """Return a digit to the base 3 per slot."""
    return (chosen & 1) + 3 * (chosen >> 1 & 1)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _cell(numbers: FloatArray, first: Whole, loads: int, a: Lanes, b: Lanes) -> Lanes:
    """Return values in cells of a table in row order, bilinear in the weights (`cell_value`)."""
    low_0, high_0 = gather_pairs(numbers, first)
    low_1, high_1 = gather_pairs(numbers, first + loads)
    low = low_0 * (1.0 - a) + low_1 * a
    return low * (1.0 - b) + (high_0 * (1.0 - a) + high_1 * a) * b


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _coefficient(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, table: FloatArray, load_n: Lanes, rubs: int
) -> Lanes:
    """Return the friction coefficients at forces per carrying share (`lubricated`), of use where pairs rub."""
    loads, positions = index[layout.LUBRICATED_LOADS], index[layout.LUBRICATED_POSITIONS]
    line, per_m = scalars[layout.LUBRICATED_LINE], scalars[layout.LUBRICATED_PER_M]
    along = (load(table, POSITION * LANES) - scalars[layout.LUBRICATED_START]) * per_m
    along = smaller(larger(along, 0.0), positions - 1.0)
    held = scalars[layout.LUBRICATED_START] + along / per_m
    group = load_n * line / (scalars[layout.LUBRICATED_FLOOR] * held * (line - held))
    store(table, SCRATCH * LANES, larger(group, 1.0))
    for lane in range(3 * SLOTS):
        table[SCRATCH, lane] = log(table[SCRATCH, lane]) if rubs >> lane & 1 != 0 else 0.0
    table[SCRATCH, 6], table[SCRATCH, 7] = 0.0, 0.0
    up = smaller(load(table, SCRATCH * LANES) * scalars[layout.LUBRICATED_PER_LOG], loads - 1.0)
    i, j = smaller(truncated(along), positions - 2), smaller(truncated(up), loads - 2)
    a, b, corner = along - as_doubles(i), up - as_doubles(j), i * loads + j
    share = smaller(_cell(numbers, corner + index[layout.RATIO_AT], loads, a, b), 1.0)
    rough = load(table, ROUGH * LANES)
    if index[layout.ROUGHNESSES] > 1 and bits(rough > 0.0) & rubs != 0:
        raised = _cell(numbers, corner + (index[layout.RATIO_AT] + positions * loads), loads, a, b)
        share = select(rough > 0.0, share * (1.0 - rough) + smaller(raised, 1.0) * rough, share)
    bounded = smaller(_cell(numbers, corner + index[layout.FLUID_AT], loads, a, b), scalars[layout.BOUNDARY])
    return bounded + share * (scalars[layout.BOUNDARY] - bounded)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _rub(scalars: FloatArray, numbers: FloatArray, index: IntArray, table: FloatArray, node: FloatArray) -> None:
    """Add the friction of all pairs (`node_forces._rub`)."""
    force, here = load(table, NORMAL * LANES), load(table, POSITION * LANES)
    rubbing = force > 0.0
    rubs = bits(rubbing) & BOTH
    load_n = select(rubbing, force, 0.0) / larger(load(table, CARRYING * LANES), LEAST_CARRYING)
    friction = _coefficient(scalars, numbers, index, table, load_n, rubs) * force
    sliding = of_pairs(load(node, NODE_SLIDING_0 * LANES)) + here * of_pairs(load(node, NODE_SLIDING_1 * LANES))
    speed = sliding / scalars[layout.SLIP_SPEED]
    turning = magnitude(speed) < STRAIGHT
    friction = select(turning, friction, select(speed < 0.0, friction * -1.0, friction))
    turns = bits(turning) & rubs
    if turns != 0:
        store(table, SCRATCH * LANES, friction)
        for lane in range(3 * SLOTS):
            if turns >> lane & 1 != 0:
                table[SCRATCH, lane] *= tanh(extract(speed, lane))
        friction = load(table, SCRATCH * LANES)
    _summed(node, NODE_FRICTION, rubbing, friction)
    _summed(node, NODE_ARM, rubbing, here * friction)
    if index[layout.CONTACT_VALUES] > 4:
        _summed(node, NODE_TURN, rubbing, friction * load(table, MOMENT * LANES) / force)
