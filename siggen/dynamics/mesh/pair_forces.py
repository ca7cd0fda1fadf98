"""Forces of all tooth pairs in one state: a step of one node (`node_forces`), whose forces stand for themselves.

Equations: `pair_law`.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.dynamics.mesh.node_forces import write_node_forces
from siggen.dynamics.mesh.pair_columns import (
    NODE_APPROACH,
    NODE_RATE,
    NODE_ROWS,
    NODE_SLIDING_0,
    NODE_SLIDING_1,
    NORMAL,
)
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.mesh.pair_places import pair_table
from siggen.dynamics.mesh.pair_springs import write_springs
from siggen.dynamics.mesh.two_springs import EXACT_CHANGE

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
