"""Forces of all tooth pairs at the nodes of one step with their tangents, compiled: springs, dampers, film, friction.

Equations: `pair_law`. A state by itself is a step of one node (`pair_forces`). The asperity share that a damper answers
to is found once per pair, at the middle of the step and the mean force over it: its error is of second order, none at
one node.
"""

from __future__ import annotations

from math import sqrt, tanh

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import njit
from siggen.dynamics.friction.asperity_table import cell_value, contact_cell
from siggen.dynamics.friction.friction import friction_mixed
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.pair_columns import (
    ALONE,
    ASPERITY_SHARE,
    CARRYING,
    COEFFICIENT,
    CROSS,
    DAMPING,
    FLANK,
    FRICTION,
    MOMENT,
    MOST_APART,
    NODE_APPROACH,
    NODE_ARM,
    NODE_FRICTION,
    NODE_MOMENT,
    NODE_NORMAL,
    NODE_RATE,
    NODE_ROWS,
    NODE_SLIDING_0,
    NODE_SLIDING_1,
    NODE_SLOPE,
    NODE_SLOPE_RATE,
    NODE_TILT,
    NODE_TILT_RATE,
    NODE_TURN,
    NORMAL,
    PENETRATION,
    POSITION,
    ROUGH,
    SLIDING,
    STIFFNESS,
    TILT,
    TOUCH,
    TURNING,
    WHOLE,
    YIELD,
)
from siggen.dynamics.mesh.pair_springs import coupling_of, write_springs

STRAIGHT = 10.0
"""tanh is 1 within 4e-9 beyond."""
LEAST_CARRYING = 1e-3
"""Of the face, less than a slice: what a force is divided by where a motion that diverges leaves the table."""


@njit(cache=True, _nrt=False, inline="always", error_model="numpy")
def film_force(scalars: FloatArray, position_m: float, gap_m: float, rate_m_s: float) -> float:
    """Return the force of the film between flanks of a pair in the path of contact; none where they part."""
    place = (position_m - scalars[layout.START_M]) / scalars[layout.PITCH_M]
    if rate_m_s <= 0.0 or place < 0.0 or place > scalars[layout.CONTACT_RATIO]:
        return 0.0
    curvature_m = position_m * (scalars[layout.LINE_M] - position_m) / scalars[layout.LINE_M]
    force_n: float = (
        scalars[layout.FILM] * (0.5 * curvature_m / max(gap_m, scalars[layout.FILM_FLOOR_M])) ** 1.5 * rate_m_s
    )
    return force_n


@njit(cache=True, _nrt=False, inline="always", error_model="numpy")
def lubricated(
    scalars: FloatArray,
    numbers: FloatArray,
    index: IntArray,
    position_m: float,
    load_n: float,
    rough: float,
) -> tuple[float, float]:
    """Return asperity share and friction coefficient at a force per carrying share; rough lands count by theirs."""
    loads, positions = index[layout.LUBRICATED_LOADS], index[layout.LUBRICATED_POSITIONS]
    along, up, a, b = contact_cell(
        positions, loads, scalars[layout.LUBRICATED_LINE], scalars[layout.LUBRICATED_START],
        scalars[layout.LUBRICATED_PER_M], scalars[layout.LUBRICATED_FLOOR], scalars[layout.LUBRICATED_PER_LOG],
        position_m, load_n,
    )  # fmt: skip
    corner = along * loads + up
    share = min(cell_value(numbers, index[layout.RATIO_AT] + corner, loads, a, b), 1.0)
    if rough > 0.0 and index[layout.ROUGHNESSES] > 1:
        raised = cell_value(numbers, index[layout.RATIO_AT] + positions * loads + corner, loads, a, b)
        share = share * (1.0 - rough) + min(raised, 1.0) * rough
    fluid = cell_value(numbers, index[layout.FLUID_AT] + corner, loads, a, b)
    return share, friction_mixed(share, scalars[layout.BOUNDARY], fluid)


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
    settled: float,
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
    settled : float
        Share of their force to which pairs on one gear body are settled (`write_springs`).
    """
    count = nodes.size
    slots, tilts = pairs.shape[0] // count, index[layout.CONTACT_VALUES] > 4
    touching, changed = 0, False
    for q in range(count):
        base, before = q * slots, (q - 1 if q > 0 else count - 1) * slots
        for i in range(slots if tilts else 0):
            pairs[base + i, TILT] = node[NODE_TILT, q]
        pitches = pitches_0 + (pitches_1 - pitches_0) * nodes[q]
        found = write_springs(
            scalars, numbers, index, node[NODE_APPROACH, q], pitches, pairs, base, before, slots, settled
        )
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
    if scalars[layout.FILM] > 0.0 and index[layout.APART] > 0:
        _widen(scalars, index, pairs, q * slots, slots)
    for i in range(q * slots, (q + 1) * slots):
        total += pairs[i, STIFFNESS]
        pairs[i, SLIDING] = 0.0
        if pairs[i, WHOLE] > 0.0:
            pairs[i, SLIDING] = node[NODE_SLIDING_0, q] + pairs[i, POSITION] * node[NODE_SLIDING_1, q]
        pairs[i, FRICTION], pairs[i, COEFFICIENT], pairs[i, ASPERITY_SHARE] = 0.0, 0.0, 0.0
    shared = 1.0 / sqrt(total) if total > 0.0 else 0.0
    for i in range(q * slots, (q + 1) * slots):
        flank = pairs[i, FLANK]
        root = pairs[i, DAMPING] if index[layout.SHARE_DAMPS] > 0 else scalars[layout.DAMPING_ROOT]
        pairs[i, DAMPING] = 0.0
        if flank == 0.0:
            if scalars[layout.FILM] > 0.0 and pairs[i, WHOLE] > 0.0:
                film = film_force(scalars, pairs[i, POSITION], pairs[i, TOUCH] - pairs[i, PENETRATION], rate)
                pairs[i, NORMAL] = film
                node[NODE_NORMAL, q] += film
                node[NODE_SLOPE_RATE, q] += film / rate if film > 0.0 else 0.0
            continue
        damping = root * shared * pairs[i, STIFFNESS]
        pairs[i, DAMPING] = damping
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
def _widen(scalars: FloatArray, index: IntArray, pairs: FloatArray, base: int, slots: int) -> None:
    """Write how far pairs that do not touch are apart under the forces of the others, which deflect their gear body."""
    apart = min(index[layout.APART], MOST_APART)
    for i in range(base, base + slots):
        if pairs[i, FLANK] != 0.0 or pairs[i, WHOLE] == 0.0:
            continue
        depth = pairs[i, ALONE]
        for j in range(base, base + slots):
            if j != i and pairs[j, FLANK] != 0.0:
                depth -= coupling_of(scalars, pairs, apart, i, j) * pairs[j, NORMAL]
        pairs[i, PENETRATION] = depth


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
        pairs[i, ASPERITY_SHARE], coefficient = lubricated(scalars, numbers, index, here, load, pairs[i, ROUGH])
        speed = pairs[i, SLIDING] / scalars[layout.SLIP_SPEED]
        friction = coefficient * force
        if abs(speed) < STRAIGHT:
            friction *= tanh(speed)
        elif speed < 0.0:
            friction = -friction
        pairs[i, COEFFICIENT], pairs[i, FRICTION] = coefficient, friction
        node[NODE_FRICTION, q] += friction
        node[NODE_ARM, q] += here * friction
        if tilts:
            node[NODE_TURN, q] += friction * pairs[i, MOMENT] / force
