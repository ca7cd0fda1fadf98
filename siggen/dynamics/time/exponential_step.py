"""Steps of the exponential integrator, compiled. Constants and derivation: `exponential_scheme`.

The forces of the mesh at the nodes of a step decide what the mesh sees there, and that decides the forces: with the
tangents of the pair law (`node_forces`) three linear equations for the excess forces there, Newton's method. From a
good guess, the parabola through the forces of the step before, a single step of it is enough where nothing happens.
Friction and moments follow in proportion, or with the next step.

A step is taken again as SPLIT shorter ones where its force is no smooth function of time: a flank touches or parts, the
quadratic part of the force is larger than allowed, or Newton's method does not end. It is short from the start where a
pair passes its pitch point, at which friction turns, or an edge of damage (`event_places`). So steps are shortened by
what happens and never by a label.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.node_forces import (
    NODE_APPROACH,
    NODE_FRICTION,
    NODE_NORMAL,
    NODE_RATE,
    NODE_ROWS,
    NODE_SLIDING_0,
    NODE_SLIDING_1,
    NODE_SLOPE,
    NODE_SLOPE_RATE,
    NODE_TILT,
    write_node_forces,
)
from siggen.dynamics.mesh.pair_columns import PAIR, ROW
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.time.exponential_products import add_response, free_motion, write_middle
from siggen.dynamics.time.exponential_scheme import LEVELS, NODES, SPLIT, Scheme

MOST_ITERATIONS = 6
SMOOTH_CHANGE = 0.02
"""Of the static approach: a correction whose square, times the curvature of the law, is below 1e-5 of the force."""
KINKED_CHANGE = 1e-4
"""The same where a flank touches or parts within the step."""
FINEST = SPLIT ** (LEVELS - 1)
TOUCHED = 2
"""How often a step is halved at least in which a flank touches or parts."""
ROUND = 4.0
"""Sliding speed over the slip speed at which friction has turned: tanh is 0.999."""
CHANNELS = 5
STIFFNESS, DAMPING, FORCE, APPROACH, TILT, ROLL_0, ROLL_1 = range(7)
"""Places in `Scheme.linear`."""
LAST_LEVEL, TOUCHING, ATTEMPTS, SHORTENED = range(4)
"""Places in the row of the memory behind the excess forces."""
Work = tuple[FloatArray, ...]


def fresh_memory() -> FloatArray:
    """Return what is carried from step to step beside the state, as it is at the start: (CHANNELS + 1, NODES or more).

    Excess forces at the nodes of the last step; then its level, which slots touched at its end (`write_springs`; -1:
    not known), and how many steps were tried and shortened.
    """
    memory = np.zeros((CHANNELS + 1, max(NODES, SHORTENED + 1)))
    memory[CHANNELS, TOUCHING] = -1.0
    return memory


@njit(cache=True, _nrt=False, inline="always", error_model="numpy")
def _correct(
    response: FloatArray, linear: FloatArray, level: int, size: int, node: FloatArray, excess: FloatArray
) -> float:
    """Take Newton's step on the excess forces; return the largest change of the approach at the nodes [m].

    What belongs to a node stands in a number of its own: the compiler keeps them in registers.
    """
    channels, rate = response.shape[1], size + NODES
    x_0, x_1, x_2, v_0, v_1, v_2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0  # what approach and rate change by at the nodes
    for channel in range(1, channels):
        for r in range(NODES):
            change = node[NODE_FRICTION + channel - 1, r] - excess[channel, r]
            x_0 += response[level, channel, r, size] * change
            x_1 += response[level, channel, r, size + 1] * change
            x_2 += response[level, channel, r, size + 2] * change
            v_0 += response[level, channel, r, rate] * change
            v_1 += response[level, channel, r, rate + 1] * change
            v_2 += response[level, channel, r, rate + 2] * change
    k_0, d_0, e_0 = _equation(linear, node, excess, 0, x_0, v_0)
    k_1, d_1, e_1 = _equation(linear, node, excess, 1, x_1, v_1)
    k_2, d_2, e_2 = _equation(linear, node, excess, 2, x_2, v_2)
    a_00 = 1.0 + (-k_0 * response[level, 0, 0, size] - d_0 * response[level, 0, 0, rate])
    a_01 = -k_0 * response[level, 0, 1, size] - d_0 * response[level, 0, 1, rate]
    a_02 = -k_0 * response[level, 0, 2, size] - d_0 * response[level, 0, 2, rate]
    a_10 = -k_1 * response[level, 0, 0, size + 1] - d_1 * response[level, 0, 0, rate + 1]
    a_11 = 1.0 + (-k_1 * response[level, 0, 1, size + 1] - d_1 * response[level, 0, 1, rate + 1])
    a_12 = -k_1 * response[level, 0, 2, size + 1] - d_1 * response[level, 0, 2, rate + 1]
    a_20 = -k_2 * response[level, 0, 0, size + 2] - d_2 * response[level, 0, 0, rate + 2]
    a_21 = -k_2 * response[level, 0, 1, size + 2] - d_2 * response[level, 0, 1, rate + 2]
    a_22 = 1.0 + (-k_2 * response[level, 0, 2, size + 2] - d_2 * response[level, 0, 2, rate + 2])
    # Diagonal dominant: no pivoting.
    inverse = 1.0 / a_00
    f_1, f_2 = a_10 * inverse, a_20 * inverse
    a_11, a_12, e_1 = a_11 - f_1 * a_01, a_12 - f_1 * a_02, e_1 - f_1 * e_0
    a_21, a_22, e_2 = a_21 - f_2 * a_01, a_22 - f_2 * a_02, e_2 - f_2 * e_0
    f_2 = a_21 * (1.0 / a_11)
    e_2 = (e_2 - f_2 * e_1) / (a_22 - f_2 * a_12)
    e_1 = (e_1 - a_12 * e_2) / a_11
    e_0 = (e_0 - a_01 * e_1 - a_02 * e_2) / a_00
    excess[0, 0] += e_0
    excess[0, 1] += e_1
    excess[0, 2] += e_2
    for r, change in ((0, e_0), (1, e_1), (2, e_2)):
        x_0 += response[level, 0, r, size] * change
        x_1 += response[level, 0, r, size + 1] * change
        x_2 += response[level, 0, r, size + 2] * change
        v_0 += response[level, 0, r, rate] * change
        v_1 += response[level, 0, r, rate + 1] * change
        v_2 += response[level, 0, r, rate + 2] * change
    _follow(node, excess, channels, 0, x_0, v_0)
    _follow(node, excess, channels, 1, x_1, v_1)
    _follow(node, excess, channels, 2, x_2, v_2)
    return max(abs(x_0), abs(x_1), abs(x_2))


@njit(cache=True, _nrt=False, inline="always", error_model="numpy")
def _equation(
    linear: FloatArray, node: FloatArray, excess: FloatArray, q: int, moved: float, moved_rate: float
) -> tuple[float, float, float]:
    """Return the tangents of the excess force at a node to approach and rate, and what is missing of it."""
    slope, slope_rate = node[NODE_SLOPE, q] - linear[STIFFNESS], node[NODE_SLOPE_RATE, q] - linear[DAMPING]
    found = node[NODE_NORMAL, q] - linear[FORCE] - linear[STIFFNESS] * (node[NODE_APPROACH, q] - linear[APPROACH])
    found += slope * moved + slope_rate * moved_rate - linear[DAMPING] * node[NODE_RATE, q]
    return slope, slope_rate, found - excess[0, q]


@njit(cache=True, _nrt=False, inline="always", error_model="numpy")
def _follow(node: FloatArray, excess: FloatArray, channels: int, q: int, moved: float, moved_rate: float) -> None:
    """Let the force at a node follow its tangents, friction and moments in proportion."""
    rise = node[NODE_SLOPE, q] * moved + node[NODE_SLOPE_RATE, q] * moved_rate
    force = node[NODE_NORMAL, q]
    grown = 1.0 + (rise / force if force != 0.0 else 0.0)
    node[NODE_NORMAL, q] = force + rise
    for channel in range(1, channels):
        excess[channel, q] = node[NODE_FRICTION + channel - 1, q] * grown


@njit(cache=True, _nrt=False, error_model="numpy")
def _attempt(  # noqa: PLR0912 - compiled, and cut up it would count references
    scheme: Scheme,
    law: PairLaw,
    level: int,
    pitches_0: float,
    pitches_1: float,
    speed_ratio: float,
    tolerance_n: float,
    memory: FloatArray,
    pairs: FloatArray,
    work: Work,
) -> bool:
    """Write the state at the end of a step; return False, and keep the memory as it is, if the step has an event."""
    response, linear, legendre, extrapolation = scheme.response, scheme.linear, scheme.legendre, scheme.extrapolation
    node, excess, seen, start, end, between = work
    size, channels, columns = scheme.transition.shape[1], response.shape[1], end.size
    seers = 4 if channels == 3 else 6
    free_motion(scheme.transition, scheme.input_response, level, start, between, end)
    last = int(memory[CHANNELS, LAST_LEVEL])
    for channel in range(channels):
        for q in range(NODES):
            excess[channel, q] = 0.0
        for r in range(NODES):
            force = memory[channel, r]
            for q in range(NODES):
                excess[channel, q] += extrapolation[last, level, r, q] * force
    settled, touching, before = False, 0, -1
    for iteration in range(MOST_ITERATIONS):
        for c in range(size, columns):
            seen[c] = end[c]
        add_response(response, level, excess, size, columns, seen)
        for s in range(seers):
            for q in range(NODES):
                node[s, q] = seen[size + s * NODES + q]
        for q in range(NODES):
            node[NODE_APPROACH, q] += linear[APPROACH]
            node[NODE_SLIDING_0, q] += linear[ROLL_0] * speed_ratio
            node[NODE_SLIDING_1, q] += linear[ROLL_1] * speed_ratio
            if seers > 4:
                node[NODE_TILT, q] += linear[TILT]
        touching = write_node_forces(
            law.scalars, law.numbers, law.places, scheme.nodes, scheme.weights, pitches_0, pitches_1, pairs, node
        )
        change = _correct(response, linear, level, size, node, excess)
        kinked = touching < 0 or (iteration > 0 and touching != before)
        before = touching
        if change <= (KINKED_CHANGE if kinked else SMOOTH_CHANGE) * abs(linear[APPROACH]):
            settled = True
            break
    if level < LEVELS - 1:
        bent, rubbing = 0.0, 0.0
        for q in range(NODES):
            bent += legendre[NODES - 1, q] * node[NODE_NORMAL, q]
            rubbing += legendre[NODES - 1, q] * node[NODE_FRICTION, q]
        parted = touching < 0 or touching != int(memory[CHANNELS, TOUCHING])
        if not settled or (level < TOUCHED and parted) or not max(abs(bent), abs(rubbing)) <= tolerance_n:
            return False
    add_response(response, level, excess, 0, min(size + -size % 4, columns), end)
    for channel in range(channels):
        for q in range(NODES):
            memory[channel, q] = excess[channel, q]
    memory[CHANNELS, LAST_LEVEL] = level
    memory[CHANNELS, TOUCHING] = touching if touching >= 0 else -1 - touching
    return True


@njit(cache=True, _nrt=False, error_model="numpy")
def _has_event(
    law: PairLaw,
    pairs: FloatArray,
    events: NDArray[np.bool_],
    pitch_place: float,
    reach: float,
    pitches_0: float,
    pitches_1: float,
) -> bool:
    """Return whether a pair comes as near as `reach` [base pitches] to its pitch point, or to an edge of damage."""
    if reach >= 0.0 and np.floor(pitches_1 - pitch_place + reach) > np.floor(pitches_0 - pitch_place - reach):
        return True
    for i in range(pairs.shape[0] // NODES):
        place = pitches_0 - pairs[i, PAIR]
        inside = 0.0 <= place < law.scalars[layout.CONTACT_RATIO]
        if inside and events[int(pairs[i, ROW]), int(place * law.scalars[layout.PER_PITCH])]:
            return True
    return False


def work_arrays(columns: int, inputs: int) -> Work:
    """Return working space for `advance`: node values, excess forces, what is seen, state, end, inputs.

    Allocated outside: compiled code that allocates nothing need not count references, which costs more than the forces.
    """
    node, excess = np.zeros((NODE_ROWS, NODES)), np.zeros((CHANNELS, NODES))
    return node, excess, np.zeros(columns), np.zeros(columns), np.zeros(columns), np.zeros((2, inputs))


@njit(cache=True, _nrt=False, error_model="numpy")
def advance(  # noqa: PLR0912 - compiled, and cut up it would count references
    scheme: Scheme,
    law: PairLaw,
    stride: int,
    speed_input: int,
    tolerance_n: float,
    events: NDArray[np.bool_],
    pitches: FloatArray,
    inputs: FloatArray,
    memory: FloatArray,
    pairs: FloatArray,
    work: Work,
    apart: NDArray[np.bool_],
    trajectory: FloatArray,
) -> None:
    """Fill `trajectory` (steps + 1, 2n) after row 0; mark in `apart` (steps,) at which of them no pair touches.

    A step of the scheme takes `stride` of these steps, 1 or 2; one that is left over at the end is half of it.
    `pitches` (steps + 1,), `inputs` (steps + 1, m), `events` of `event_places`; `memory` of `fresh_memory` and `pairs`
    (NODES slots, COLUMNS) go on from the steps before.
    """
    size, m = scheme.transition.shape[1], inputs.shape[1]
    state, end, between = work[3], work[4], work[5]
    centre = -scheme.linear[ROLL_0] / scheme.linear[ROLL_1]
    pitch_place = (centre - law.scalars[layout.START_M]) / law.scalars[layout.PITCH_M]
    reach = ROUND * law.scalars[layout.SLIP_SPEED] / abs(scheme.linear[ROLL_1] * law.scalars[layout.PITCH_M])
    reach = reach if law.places[layout.ROUGHNESSES] > 0 else -1.0
    for j in range(size):
        state[j] = trajectory[0, j]
    steps, i = pitches.size - 1, 0
    while i < steps:
        until = FINEST if i + stride <= steps else FINEST // 2
        last = min(i + stride, steps)
        turned, ratio = (pitches[last] - pitches[i]) * (FINEST // until), 1.0
        if speed_input >= 0:
            ratio += 0.5 * (inputs[i, speed_input] + inputs[last, speed_input])
        place, level = 0, 0
        if until < FINEST or _has_event(law, pairs, events, pitch_place, reach, pitches[i], pitches[last]):
            level = 1
        while place < until:
            length = FINEST // SPLIT**level
            a, b = place / until, (place + length) / until
            for k in range(m):
                rise = inputs[last, k] - inputs[i, k]
                between[0, k], between[1, k] = inputs[i, k] + a * rise, inputs[i, k] + b * rise
            memory[CHANNELS, ATTEMPTS] += 1.0
            a, b = place / FINEST, (place + length) / FINEST
            if not _attempt(
                scheme, law, level, pitches[i] + a * turned, pitches[i] + b * turned, ratio, tolerance_n, memory,
                pairs, work,
            ):  # fmt: skip
                level += 1
                memory[CHANNELS, SHORTENED] += 1.0
                continue
            if stride == 2 and level == 0:
                write_middle(scheme.middle, state, memory, scheme.response.shape[1], between, trajectory[i + 1])
                apart[i] = memory[CHANNELS, TOUCHING] == 0.0
            for j in range(size):
                state[j] = end[j]
            place += length
            if stride == 2 and place == FINEST // 2:
                apart[i] = memory[CHANNELS, TOUCHING] == 0.0
                for j in range(size):
                    trajectory[i + 1, j] = state[j]
            while level > 0 and place % (FINEST // SPLIT ** (level - 1)) == 0:
                level -= 1
        apart[last - 1] = memory[CHANNELS, TOUCHING] == 0.0
        for j in range(size):
            trajectory[last, j] = state[j]
        i = last
