"""The rate of a state under the forces of tooth pairs, compiled; equations: `pair_motion`."""

from __future__ import annotations

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.dynamics.mesh import pair_columns as columns
from siggen.dynamics.mesh.pair_forces import write_forces
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.time.pair_equations import APPROACH, FORCE, TILT, UPRIGHT, PairEquations


@njit(cache=True)
def at_speed(equations: PairEquations, speed_deviation: float) -> PairEquations:
    """Return the equations at the speed Ω_0 (1 + speed_deviation)."""
    return PairEquations(
        equations.rows,
        equations.static,
        equations.rigid_sliding * (1.0 + speed_deviation),
        equations.places,
        equations.external_input,
    )


# Inlined: taking arrays out of tuples again and again costs as much as the forces (see `packed_tables`).
@njit(cache=True, inline="always")
def load_pairs(
    equations: PairEquations, mesh: int, law: PairLaw, pairs: FloatArray, state: FloatArray, pitches: float
) -> tuple[float, float, float, float, float]:
    """Write the table of pairs of a mesh in a state; return ΣN, ΣF, Σ s F, Σμ and Σ ζ F."""
    rows, node = equations.rows, pairs[0, pairs.shape[1] - columns.NODE_ROWS :].reshape(columns.NODE_ROWS, 1)
    n = rows.shape[1]
    block = (rows.shape[0] - 2 * n) // equations.static.shape[0]
    first = 2 * n + mesh * block
    approach, approach_rate = equations.static[mesh, APPROACH], 0.0
    sliding_0, sliding_1 = equations.rigid_sliding[mesh, 0], equations.rigid_sliding[mesh, 1]
    for i in range(n):
        approach += rows[first, i] * state[i]
        approach_rate += rows[first, i] * state[n + i]
        sliding_0 += rows[first + 1, i] * state[n + i]
        sliding_1 += rows[first + 2, i] * state[n + i]
    node[columns.NODE_APPROACH, 0], node[columns.NODE_RATE, 0] = approach, approach_rate
    node[columns.NODE_SLIDING_0, 0], node[columns.NODE_SLIDING_1, 0] = sliding_0, sliding_1
    if block > UPRIGHT:
        tilt, tilt_rate = equations.static[mesh, TILT], 0.0
        for i in range(n):
            tilt += rows[first + 6, i] * state[i]
            tilt_rate += rows[first + 6, i] * state[n + i]
        node[columns.NODE_TILT, 0], node[columns.NODE_TILT_RATE, 0] = tilt, tilt_rate
    write_forces(law, pitches * equations.places[mesh, 0] + equations.places[mesh, 1], pairs)
    return (
        node[columns.NODE_NORMAL, 0],
        node[columns.NODE_FRICTION, 0],
        node[columns.NODE_ARM, 0],
        node[columns.NODE_MOMENT, 0],
        node[columns.NODE_TURN, 0],
    )


# Inlined for the same reason; the forces themselves are not, since that would make five compilations of them.
@entry(cache=True, inline="always")
def pair_rate(
    model: tuple[PairEquations, tuple[PairLaw, ...], tuple[FloatArray, ...]],
    state: FloatArray,
    pitches: float,
    rate: FloatArray,
) -> None:
    """Write ż (2n,) of a state into `rate`; the form that integrators call."""
    equations, laws, pairs = model
    rows = equations.rows
    n = rows.shape[1]
    block = (rows.shape[0] - 2 * n) // equations.static.shape[0]
    for i in range(n):
        rate[i] = state[n + i]
        rate[n + i] = 0.0
    for m in range(len(laws)):
        normal, friction, moment, across, rubbed = load_pairs(equations, m, laws[m], pairs[m], state, pitches)
        excess, first = normal - equations.static[m, FORCE], 2 * n + m * block
        for i in range(n):
            rate[n + i] -= rows[first + 3, i] * excess + rows[first + 4, i] * friction + rows[first + 5, i] * moment
        if block > UPRIGHT:
            for i in range(n):
                rate[n + i] -= rows[first + 7, i] * across + rows[first + 8, i] * rubbed
    # Columns outside, so that the inner loop carries no sum and runs on several rates at once; displacement and
    # velocity of a coordinate together, which halves the traffic to memory.
    for j in range(n):
        displacement, velocity = state[j], state[n + j]
        for i in range(n):
            rate[n + i] += rows[j, i] * displacement + rows[n + j, i] * velocity


@entry(cache=True)
def steps_apart(
    equations: PairEquations, mesh: int, law: PairLaw, pairs: FloatArray, states: FloatArray, pitches: FloatArray
) -> int:
    """Return at how many states (k, 2n) no pair of a mesh touches."""
    count = 0
    for i in range(states.shape[0]):
        load_pairs(equations, mesh, law, pairs, states[i], pitches[i])
        touching = False
        for j in range(pairs.shape[0]):
            touching = touching or pairs[j, columns.FLANK] != 0.0
        if not touching:
            count += 1
    return count
