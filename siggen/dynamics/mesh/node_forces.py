"""Forces of all tooth pairs at the nodes of one step with their tangents, compiled.

The law is that of `pair_forces`: the same places, springs, moments, dampers, film and friction. Only the asperity share
that a damper answers to is found once per pair, at the middle of the step and the mean force over it: its error is of
second order.
"""

from __future__ import annotations

from math import sqrt, tanh

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.pair_columns import (
    CARRYING,
    CROSS,
    DAMPING,
    FLANK,
    MOMENT,
    NORMAL,
    PENETRATION,
    POSITION,
    ROUGH,
    STIFFNESS,
    TILT,
    TOUCH,
    TURNING,
    WHOLE,
    YIELD,
)
from siggen.dynamics.mesh.pair_forces import LEAST_CARRYING, film_force, lubricated
from siggen.dynamics.mesh.pair_tangents import write_springs

(
    NODE_APPROACH, NODE_RATE, NODE_SLIDING_0, NODE_SLIDING_1, NODE_TILT, NODE_TILT_RATE, NODE_NORMAL, NODE_SLOPE,
    NODE_SLOPE_RATE, NODE_FRICTION, NODE_ARM, NODE_MOMENT, NODE_TURN,
) = range(13)  # fmt: skip
"""Rows of the values at the nodes: approach [m], its rate, both parts of the sliding speed [m/s, 1/s], tilt [rad] and
its rate, which the caller writes; ΣN [N], its tangents to approach [N/m] and rate [N s/m], ΣF [N], Σ s F, Σμ and
Σ ζ F [N m]."""
NODE_ROWS = 13
STRAIGHT = 10.0
"""tanh is 1 within 4e-9 beyond."""


@njit(cache=True, _nrt=False, error_model="numpy")
def write_node_forces(
    scalars: FloatArray,
    numbers: FloatArray,
    index: IntArray,
    nodes: FloatArray,
    weights: FloatArray,
    pitches_0: float,
    pitches_1: float,
    pairs: FloatArray,
    node: FloatArray,
) -> int:
    """Write the forces at the nodes of a step, and return which slots touch, negative where that changes within it.

    Parameters
    ----------
    scalars, numbers, index : of `PairLaw`
    nodes, weights : (k,)
        Of the quadrature on [0, 1].
    pitches_0, pitches_1 : float
        Pinion angle at the ends of the step, in base pitches.
    pairs : (k slots, COLUMNS)
        Tables of pairs of all nodes, one behind the other (`pair_table`); what they hold is the first guess.
    node : (NODE_ROWS, k or more)
    """
    count = nodes.size
    slots, tilts = pairs.shape[0] // count, index[layout.CONTACT_VALUES] > 4
    touching, changed = 0, False
    for q in range(count):
        base, before = q * slots, (q - 1 if q > 0 else count - 1) * slots
        for i in range(slots if tilts else 0):
            pairs[base + i, TILT] = node[NODE_TILT, q]
        pitches = pitches_0 + (pitches_1 - pitches_0) * nodes[q]
        found = write_springs(scalars, numbers, index, node[NODE_APPROACH, q], pitches, pairs, base, before, slots)
        changed = changed or (q > 0 and found != touching)
        touching = found
        for row in range(NODE_NORMAL, NODE_ROWS):
            node[row, q] = 0.0
    if index[layout.SHARE_DAMPS] > 0:
        _write_roots(scalars, numbers, index, weights, pairs, slots)
    for q in range(count):
        _load(scalars, index, pairs, q, slots, tilts, node)
    if index[layout.ROUGHNESSES] > 0:
        for i in range(slots):
            _rub(scalars, numbers, index, pairs, i, slots, tilts, node)
    return -1 - touching if changed else touching


@njit(cache=True, _nrt=False, error_model="numpy")
def _write_roots(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, weights: FloatArray, pairs: FloatArray, slots: int
) -> None:
    """Write c √Σk/k of every pair by the share of the load that asperities carry, the same at all nodes."""
    for i in range(slots):
        root = scalars[layout.DAMPING_STRUCTURE] + scalars[layout.DAMPING_FILM]
        load, position, rough = _middle(weights, pairs, i, slots)
        if load > 0.0:
            share, _ = lubricated(scalars, numbers, index, position, load, rough)
            root = scalars[layout.DAMPING_STRUCTURE] + scalars[layout.DAMPING_FILM] * (1.0 - share)
            root += scalars[layout.DAMPING_ASPERITIES] * share
        for q in range(weights.size):
            pairs[q * slots + i, DAMPING] = root


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _load(
    scalars: FloatArray, index: IntArray, pairs: FloatArray, q: int, slots: int, tilts: bool, node: FloatArray
) -> None:
    """Add springs, dampers and films of all pairs at a node; NORMAL becomes the whole force."""
    rate, total = node[NODE_RATE, q], 0.0
    for i in range(q * slots, (q + 1) * slots):
        total += pairs[i, STIFFNESS]
    shared = 1.0 / sqrt(total) if total > 0.0 else 0.0
    for i in range(q * slots, (q + 1) * slots):
        flank = pairs[i, FLANK]
        if flank == 0.0:
            if scalars[layout.FILM] > 0.0 and pairs[i, WHOLE] > 0.0:
                film = film_force(scalars, pairs[i, POSITION], pairs[i, TOUCH] - pairs[i, PENETRATION], rate)
                node[NODE_NORMAL, q] += film
                node[NODE_SLOPE_RATE, q] += film / rate if film > 0.0 else 0.0
            continue
        root = pairs[i, DAMPING] if index[layout.SHARE_DAMPS] > 0 else scalars[layout.DAMPING_ROOT]
        damping = root * shared * pairs[i, STIFFNESS]
        force = pairs[i, NORMAL] + damping * rate
        if tilts and flank > 0.0:
            tilt_rate, cross = root * shared * node[NODE_TILT_RATE, q], pairs[i, CROSS]
            force += cross * tilt_rate
            moment = pairs[i, MOMENT] + root * shared * cross * rate + pairs[i, TURNING] * tilt_rate
            pairs[i, MOMENT] = moment if force > 0.0 else 0.0
            node[NODE_MOMENT, q] += pairs[i, MOMENT]
        pairs[i, NORMAL] = 0.0
        if force * flank > 0.0:
            pairs[i, NORMAL] = force
            node[NODE_NORMAL, q] += force
            node[NODE_SLOPE, q] += pairs[i, YIELD]
            node[NODE_SLOPE_RATE, q] += damping


@njit(cache=True, _nrt=False, error_model="numpy")
def _middle(weights: FloatArray, pairs: FloatArray, slot: int, slots: int) -> tuple[float, float, float]:
    """Return means over the nodes at which the drive flank of a slot carries; no force where it never does.

    Force on the face that carries [N], position [m] and share on damage.
    """
    whole, load, position, carrying, rough = 0.0, 0.0, 0.0, 0.0, 0.0
    for q in range(weights.size):
        i = q * slots + slot
        if pairs[i, FLANK] <= 0.0:
            continue
        weight = weights[q]
        whole += weight
        load += weight * pairs[i, NORMAL]
        position += weight * pairs[i, POSITION]
        carrying += weight * pairs[i, CARRYING]
        rough += weight * pairs[i, ROUGH]
    if load <= 0.0:
        return 0.0, 0.0, 0.0
    return load / max(carrying, LEAST_CARRYING * whole), position / whole, rough / whole


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _rub(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, slot: int, slots: int, tilts: bool,
    node: FloatArray,
) -> None:  # fmt: skip
    """Add the friction of a slot at all nodes."""
    for q in range(pairs.shape[0] // slots):
        i = q * slots + slot
        force, here = pairs[i, NORMAL], pairs[i, POSITION]
        if pairs[i, FLANK] <= 0.0 or force <= 0.0:
            continue
        load = force / max(pairs[i, CARRYING], LEAST_CARRYING)
        _, coefficient = lubricated(scalars, numbers, index, here, load, pairs[i, ROUGH])
        speed = (node[NODE_SLIDING_0, q] + here * node[NODE_SLIDING_1, q]) / scalars[layout.SLIP_SPEED]
        friction = coefficient * force
        if abs(speed) < STRAIGHT:
            friction *= tanh(speed)
        elif speed < 0.0:
            friction = -friction
        node[NODE_FRICTION, q] += friction
        node[NODE_ARM, q] += here * friction
        if tilts:
            node[NODE_TURN, q] += friction * pairs[i, MOMENT] / force
