"""Forces of all tooth pairs at the nodes of one step with their tangents, compiled: springs, dampers, friction.

Any law, any number of slots and nodes, one pair after the other; a state by itself is a step of one node
(`pair_forces`). What a pair answers with is the same code as in lanes (`lane_forces`): places, springs, loads. The
asperity share that a damper answers to is found once per pair, at the middle of the step and the mean force over it:
its error is of second order, none at one node.
"""

from __future__ import annotations

from math import sqrt

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.contact_spring import Spring
from siggen.dynamics.mesh.load_spread import LoadPart, spread
from siggen.dynamics.mesh.pair_columns import (
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
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.mesh.pair_loads import LEAST_CARRYING, damped, lubricated, rubbed
from siggen.dynamics.mesh.pair_springs import write_springs


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
