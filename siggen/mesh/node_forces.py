"""Forces of all tooth pairs at the nodes of one step with their tangents, compiled: springs, dampers, friction.

Any law, any number of slots and nodes, one pair after the other; a state by itself is a step of one node
(`pair_forces`). What a pair answers with is the same code as in lanes (`lane_forces`): places, springs, loads. The
asperity share that a damper answers to is found once per pair, at the middle of the step and the mean force over it:
its error is of second order, none at one node.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.mesh import pair_law as layout
from siggen.mesh.pair_columns import (
    ARM,
    ASPERITY_SHARE,
    CARRYING,
    COEFFICIENT,
    CROSS,
    DAMPING,
    FLANK,
    FRICTION,
    MOMENT,
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
    PLACE,
    POSITION,
    ROUGH,
    SLIDING,
    STIFFNESS,
    TILT,
    TURNING,
    WHOLE,
    YIELD,
)
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.pair_springs import LEAST_CARRYING, damped, lubricated, pair_table, rubbed, write_springs
from siggen.mesh.springs import EXACT_CHANGE, LoadPart, Spring, spread


@entry(cache=True, _nrt=False, error_model="numpy")
def write_node_forces(
    law: PairLaw, nodes: FloatArray, weights: FloatArray, pitches_0: float, pitches_1: float, pairs: FloatArray,
    node: FloatArray, settled: float,
) -> int:  # fmt: skip
    """Write the forces at the nodes of a step, and return which slots touch, negative where that changes within it.

    Parameters
    ----------
    law : PairLaw
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
    slots, tilts = pairs.shape[0] // count, law.places[layout.CONTACT_VALUES] > 4
    touching, changed = 0, False
    for q in range(count):
        base, before = q * slots, (q - 1 if q > 0 else count - 1) * slots
        for i in range(slots if tilts else 0):
            pairs[base + i, TILT] = node[NODE_TILT, q]
        pitches = pitches_0 + (pitches_1 - pitches_0) * nodes[q]
        found = write_springs(law, node[NODE_APPROACH, q], pitches, pairs, base, before, slots, settled)
        changed = changed or (q > 0 and found != touching)
        touching = found
        for row in range(NODE_NORMAL, NODE_ROWS):
            node[row, q] = 0.0
    for i in range(slots):
        _write_root(law, weights, pairs, i, slots)
    for q in range(count):
        _load(law, pairs, q, slots, node)
    if law.places[layout.ROUGHNESSES] > 0:
        for i in range(slots):
            _rub(law, pairs, i, slots, node)
    return -1 - touching if changed else touching


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write_root(law: PairLaw, weights: FloatArray, pairs: FloatArray, slot: int, slots: int) -> None:
    """Write c √Σk/k of a slot, by the share of the load that asperities carry, the same at all nodes."""
    scalars, root = law.scalars, law.scalars[layout.DAMPING_ROOT]
    if law.places[layout.SHARE_DAMPS] > 0:
        root = scalars[layout.DAMPING_STRUCTURE] + scalars[layout.DAMPING_FILM]
        load, position, rough = _middle(weights, pairs, slot, slots)
        if load > 0.0:
            share, _ = lubricated(law, position, load, rough, True)
            root = scalars[layout.DAMPING_STRUCTURE] + scalars[layout.DAMPING_FILM] * (1.0 - share)
            root += scalars[layout.DAMPING_ASPERITIES] * share
    for i in range(slot, pairs.shape[0], slots):
        pairs[i, DAMPING] = root


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _load(law: PairLaw, pairs: FloatArray, q: int, slots: int, node: FloatArray) -> None:
    """Add springs and dampers of all pairs at a node; NORMAL becomes the whole force."""
    rate, tilt_rate, total = node[NODE_RATE, q], node[NODE_TILT_RATE, q], 0.0
    for i in range(q * slots, (q + 1) * slots):
        total += pairs[i, STIFFNESS]
        pairs[i, SLIDING], pairs[i, PLACE] = 0.0, pairs[i, POSITION]
        if pairs[i, WHOLE] > 0.0:
            if law.places[layout.SPREAD_AT] > 0:
                before, behind = spread(law, pairs[i, POSITION])
                pairs[i, PLACE] = before.share * before.place + behind.share * behind.place
            pairs[i, SLIDING] = node[NODE_SLIDING_0, q] + pairs[i, PLACE] * node[NODE_SLIDING_1, q]
        pairs[i, FRICTION], pairs[i, COEFFICIENT], pairs[i, ASPERITY_SHARE], pairs[i, ARM] = 0.0, 0.0, 0.0, 0.0
    shared = 1.0 / sqrt(total) if total > 0.0 else 0.0
    for i in range(q * slots, (q + 1) * slots):
        found = damped(law, pairs[i, DAMPING] * shared, rate, tilt_rate, _spring(pairs, i))
        pairs[i, NORMAL], pairs[i, DAMPING], pairs[i, MOMENT] = found.force, found.damping, found.moment
        node[NODE_MOMENT, q] += found.moment
        if found.carries:
            node[NODE_NORMAL, q] += found.force
            node[NODE_SLOPE, q] += pairs[i, YIELD]
            node[NODE_SLOPE_RATE, q] += found.damping


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _spring(pairs: FloatArray, i: int) -> Spring:
    return Spring(
        pairs[i, NORMAL], pairs[i, STIFFNESS], pairs[i, YIELD], pairs[i, PENETRATION], pairs[i, MOMENT],
        pairs[i, CROSS], pairs[i, TURNING], pairs[i, CARRYING], pairs[i, ROUGH],
    )  # fmt: skip


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
def _rub(law: PairLaw, pairs: FloatArray, slot: int, slots: int, node: FloatArray) -> None:
    """Add the friction of a slot at all nodes."""
    for q in range(pairs.shape[0] // slots):
        i = q * slots + slot
        force, here = pairs[i, NORMAL], pairs[i, POSITION]
        if pairs[i, FLANK] * force <= 0.0:
            continue
        if law.places[layout.SPREAD_AT] > 0:
            for part in spread(law, here):
                _rub_part(law, pairs, i, node, q, part)
        else:
            found = rubbed(law, abs(force), here, (pairs[i, CARRYING], pairs[i, ROUGH]), pairs[i, SLIDING])
            pairs[i, FRICTION], pairs[i, COEFFICIENT], pairs[i, ASPERITY_SHARE] = found
            pairs[i, ARM] = here * found.friction
        node[NODE_FRICTION, q] += pairs[i, FRICTION]
        node[NODE_ARM, q] += pairs[i, ARM]
        node[NODE_TURN, q] += pairs[i, FRICTION] * pairs[i, MOMENT] / force


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _rub_part(law: PairLaw, pairs: FloatArray, i: int, node: FloatArray, q: int, part: LoadPart) -> None:
    """Add the friction of the slices on one side of the pitch point; all have the pair's line load."""
    if part.share <= 0.0:
        return
    sliding = node[NODE_SLIDING_0, q] + part.place * node[NODE_SLIDING_1, q]
    found = rubbed(law, abs(pairs[i, NORMAL]), part.place, (pairs[i, CARRYING], pairs[i, ROUGH]), sliding)
    pairs[i, FRICTION] += part.share * found.friction
    pairs[i, ARM] += part.share * part.place * found.friction
    pairs[i, COEFFICIENT] += part.share * found.coefficient
    pairs[i, ASPERITY_SHARE] += part.share * found.share


# Forces of all tooth pairs in one state: a step of one node (`node_forces`), whose forces stand for themselves.
#
# Equations: `pair_law`.

_PLACE, _WEIGHT = np.zeros(1), np.ones(1)


@entry(cache=True, _nrt=False)
def write_forces(law: PairLaw, pitches: float, pairs: FloatArray) -> None:
    """Write the forces of all pairs into the table, and their sums into the node (NODE_ROWS, 1) that holds the state.

    It stands behind the first row of the table, where nothing need be allocated.
    """
    node = pairs[0, pairs.shape[1] - NODE_ROWS :].reshape(NODE_ROWS, 1)
    write_node_forces(law, _PLACE, _WEIGHT, pitches, pitches, pairs, node, EXACT_CHANGE)


@entry(cache=True, _nrt=False)
def pair_forces(
    law: PairLaw,
    approach_m: float,
    rate_m_s: float,
    pitches: float,
    sliding_0_m_s: float,
    sliding_1_per_s: float,
    pairs: FloatArray,
) -> None:
    """Write the forces of all pairs into `pairs` of `pair_table`; sliding speed at s: sliding_0 + s sliding_1.

    Tilt and its rate are those of the node behind the table.
    """
    node = pairs[0, pairs.shape[1] - NODE_ROWS :].reshape(NODE_ROWS, 1)
    node[NODE_APPROACH, 0], node[NODE_RATE, 0] = approach_m, rate_m_s
    node[NODE_SLIDING_0, 0], node[NODE_SLIDING_1, 0] = sliding_0_m_s, sliding_1_per_s
    write_forces(law, pitches, pairs)


@entry(cache=True, _nrt=False)
def static_force(law: PairLaw, approach_m: float, pitches: float, pairs: FloatArray) -> float:
    """Return ΣN [N] at rest: that of the springs, at the tilts in `pairs` of `pair_table`."""
    write_springs(law, approach_m, pitches, pairs, 0, 0, pairs.shape[0], EXACT_CHANGE)
    total = 0.0
    for i in range(pairs.shape[0]):
        total += pairs[i, NORMAL]
    return total


def static_approach_m(law: PairLaw, force_n: float, pitches: float) -> float:
    """Return the approach [m] at which the pairs carry a force [N] at rest; negative on the back flank.

    Without force the one at which drive flanks begin to touch.

    Raises
    ------
    ValueError
        If not even a penetration of a tenth of a base pitch carries it.
    """
    pairs = pair_table(law)
    reach = 0.1 * law.base_pitch_m
    low, high = -law.backlash_m - reach, reach
    if not static_force(law, low, pitches, pairs) <= force_n <= static_force(law, high, pitches, pairs):
        raise ValueError(f"force_n: received {force_n}; allowed are forces that teeth carry within {reach:.3g} m")
    return _halved(law, force_n, pitches, low, high, pairs)


@entry(cache=True, _nrt=False)
def _halved(law: PairLaw, force_n: float, pitches: float, low: float, high: float, pairs: FloatArray) -> float:
    """Return the approach between two at which the pairs carry a force."""
    # Monotone, so halving always ends; 80 halvings of 2 mm are below the rounding of a nanometre.
    for _ in range(80):
        middle = 0.5 * (low + high)
        found = static_force(law, middle, pitches, pairs)
        if found < force_n or found == force_n == 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
