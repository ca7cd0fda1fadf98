"""What a mesh sees at the nodes of a step, and Newton's step on its forces there, compiled; see `exponential_step`."""

from __future__ import annotations

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.lanes import LANES, extract, load, select, shuffle, splat, store
from siggen.mesh.pair_columns import (
    NODE_APPROACH,
    NODE_FRICTION,
    NODE_NORMAL,
    NODE_RATE,
    NODE_SLIDING_0,
    NODE_SLIDING_1,
    NODE_SLOPE,
    NODE_SLOPE_RATE,
    NODE_TILT,
    NODE_TILT_RATE,
)
from siggen.motion.exponential_scheme import NODES

STIFFNESS, DAMPING, FORCE, APPROACH, TILT, ROLL_0, ROLL_1 = range(7)
"""Places in `Scheme.linear`."""

rates_of = shuffle(4, 5, 6, 7, 4, 5, 6, 7)
"""What stands in the second half of a vector: rates behind the approach, and the like."""


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def correct(
    response: FloatArray, linear: FloatArray, level: int, mesh: int, first: int, node: FloatArray, excess: FloatArray
) -> float:
    """Take Newton's step on the excess forces of a mesh; return the largest change of its approach at the nodes [m].

    The first lanes are the nodes; in `moved` the approach stands before its rate, as in the columns from `first` on.
    """
    channels, row = response.shape[1] // linear.shape[0], response.shape[3]
    own = mesh * channels
    # what approach and rate change by at the nodes
    at, moved = (level * response.shape[1] + own) * NODES * row + first, splat(0.0)
    for channel in range(1, channels):
        change = load(node, (NODE_FRICTION + channel - 1) * LANES) - load(excess, (own + channel) * LANES)
        here = at + channel * NODES * row
        moved = moved + load(response, here) * extract(change, 0)
        moved = moved + load(response, here + row) * extract(change, 1)
        moved = moved + load(response, here + 2 * row) * extract(change, 2)
    slope, slope_rate = load(node, NODE_SLOPE * LANES), load(node, NODE_SLOPE_RATE * LANES)
    force = load(node, NODE_NORMAL * LANES)
    k, d = slope - linear[mesh, STIFFNESS], slope_rate - linear[mesh, DAMPING]
    missing = force - linear[mesh, FORCE]
    missing = missing - linear[mesh, STIFFNESS] * (load(node, NODE_APPROACH * LANES) - linear[mesh, APPROACH])
    missing = missing + (k * moved + d * rates_of(moved) - linear[mesh, DAMPING] * load(node, NODE_RATE * LANES))
    missing = missing - load(excess, own * LANES)
    to_0, to_1, to_2 = load(response, at), load(response, at + row), load(response, at + 2 * row)
    k = k * -1.0
    c_0, c_1, c_2 = k * to_0 - d * rates_of(to_0), k * to_1 - d * rates_of(to_1), k * to_2 - d * rates_of(to_2)
    e_0, e_1, e_2 = extract(missing, 0), extract(missing, 1), extract(missing, 2)
    a_00, a_01, a_02 = 1.0 + extract(c_0, 0), extract(c_1, 0), extract(c_2, 0)
    a_10, a_11, a_12 = extract(c_0, 1), 1.0 + extract(c_1, 1), extract(c_2, 1)
    a_20, a_21, a_22 = extract(c_0, 2), extract(c_1, 2), 1.0 + extract(c_2, 2)
    # Diagonal dominant: no pivoting.
    inverse = 1.0 / a_00
    f_1, f_2 = a_10 * inverse, a_20 * inverse
    a_11, a_12, e_1 = a_11 - f_1 * a_01, a_12 - f_1 * a_02, e_1 - f_1 * e_0
    a_21, a_22, e_2 = a_21 - f_2 * a_01, a_22 - f_2 * a_02, e_2 - f_2 * e_0
    f_2 = a_21 * (1.0 / a_11)
    e_2 = (e_2 - f_2 * e_1) / (a_22 - f_2 * a_12)
    e_1 = (e_1 - a_12 * e_2) / a_11
    e_0 = (e_0 - a_01 * e_1 - a_02 * e_2) / a_00
    excess[own, 0] += e_0
    excess[own, 1] += e_1
    excess[own, 2] += e_2
    moved = moved + to_0 * e_0
    moved = moved + to_1 * e_1
    moved = moved + to_2 * e_2
    # The force at a node follows its tangents, friction and moments in proportion.
    rise = slope * moved + slope_rate * rates_of(moved)
    grown = select(force != 0.0, rise / force, 0.0) + 1.0
    store(node, NODE_NORMAL * LANES, force + rise)
    for channel in range(1, channels):
        store(excess, (own + channel) * LANES, load(node, (NODE_FRICTION + channel - 1) * LANES) * grown)
    largest: float = max(abs(extract(moved, 0)), abs(extract(moved, 1)), abs(extract(moved, 2)))
    return largest


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def see(
    linear: FloatArray, mesh: int, seen: FloatArray, first: int, speed_ratio: float, node: FloatArray, tilts: bool
) -> None:
    """Write what a mesh sees of a state at the nodes of a step; it stands from the column `first` on."""
    approach, sliding = load(seen, first), load(seen, first + LANES)
    store(node, NODE_APPROACH * LANES, approach + linear[mesh, APPROACH])
    store(node, NODE_RATE * LANES, rates_of(approach))
    store(node, NODE_SLIDING_0 * LANES, sliding + linear[mesh, ROLL_0] * speed_ratio)
    store(node, NODE_SLIDING_1 * LANES, rates_of(sliding) + linear[mesh, ROLL_1] * speed_ratio)
    if tilts:
        tilt = load(seen, first + 2 * LANES)
        store(node, NODE_TILT * LANES, tilt + linear[mesh, TILT])
        store(node, NODE_TILT_RATE * LANES, rates_of(tilt))
