"""Steps of the exponential integrator, compiled. Constants and derivation: `exponential_scheme`.

The forces of the mesh at the nodes of a step decide what the mesh sees there, and that decides the forces: with the
tangents of the pair law (`node_forces`) three linear equations for the excess forces there, Newton's method. From a
good guess, the parabola through the forces of the step before, a single step of it is enough where nothing happens.
Friction and moments follow in proportion, or with the next step.

A step is taken again as SPLIT shorter ones where its force is no smooth function of time: a flank touches or parts,
vibration turns the sliding, the quadratic part of the force is larger than allowed, or Newton's method does not end. It
is short from the start where a pair passes its pitch point, at which friction turns, or an edge of damage
(`event_places`). So steps are shortened by what happens and never by a label.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.lanes import LANES, Lanes, aligned, load, load_like, scalar_at, splat, splat_of, store
from siggen.mesh import pair_law as layout
from siggen.mesh.lane_forces import NOT_HERE, lane_table, write_lane_forces
from siggen.mesh.node_forces import write_node_forces
from siggen.mesh.pair_columns import NODE_FRICTION, NODE_NORMAL, NODE_ROWS, NODE_SLIDING_0, NODE_SLIDING_1, PAIR, ROW
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.springs import SMOOTH_CHANGE as SMOOTH_SHARE
from siggen.motion.exponential_scheme import LEVELS, NODES, SPLIT, Scheme
from siggen.motion.mesh_newton import ROLL_0, ROLL_1, correct, see

# Products of the exponential integrator's constants with state, inputs and forces, compiled (`exponential_scheme`).
#
# Columns lie side by side: many are one value of lanes, whose sum stays in registers from the first row to the last.
# Four registers are added to together where there are so many columns, so that none waits for the addition before. No
# sum is reordered.

_two_registers, _four_registers = splat_of(2 * LANES), splat_of(4 * LANES)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def free_motion(
    transition: FloatArray, inputs: FloatArray, level: int, start: FloatArray, between: FloatArray, free: FloatArray
) -> None:
    """Write the state after a step, and what the mesh sees in it, without excess forces into `free` (columns,)."""
    c, columns = 0, transition.shape[2]
    while c + 4 * LANES <= columns:
        store(free, c, _free_columns(transition, inputs, level, start, between, c, _four_registers(0.0)))
        c += 4 * LANES
    while c + 2 * LANES <= columns:
        store(free, c, _free_columns(transition, inputs, level, start, between, c, _two_registers(0.0)))
        c += 2 * LANES
    if c < columns:
        store(free, c, _free_columns(transition, inputs, level, start, between, c, splat(0.0)))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _free_columns(
    transition: FloatArray, inputs: FloatArray, level: int, start: FloatArray, between: FloatArray, c: int, free: Lanes
) -> Lanes:
    """Return what comes to some columns from c on."""
    size, row, count = transition.shape[1], transition.shape[2], between.shape[1]  # even: places and speeds
    at = level * size * row + c
    for j in range(0, size - 3, 4):
        free = (
            free
            + (
                load_like(transition, at, free) * scalar_at(start, j)
                + load_like(transition, at + row, free) * scalar_at(start, j + 1)
            )
            + (
                load_like(transition, at + 2 * row, free) * scalar_at(start, j + 2)
                + load_like(transition, at + 3 * row, free) * scalar_at(start, j + 3)
            )
        )
        at += 4 * row
    if size % 4 != 0:
        free = free + (
            load_like(transition, at, free) * scalar_at(start, size - 2)
            + load_like(transition, at + row, free) * scalar_at(start, size - 1)
        )
    at, half = level * 2 * count * row + c, count * row
    for k in range(0, count - 1, 2):
        free = (
            free
            + (
                load_like(inputs, at, free) * scalar_at(between, k)
                + load_like(inputs, at + half, free) * scalar_at(between, count + k)
            )
            + (
                load_like(inputs, at + row, free) * scalar_at(between, k + 1)
                + load_like(inputs, at + half + row, free) * scalar_at(between, count + k + 1)
            )
        )
        at += 2 * row
    if count % 2 != 0:
        free = free + (
            load_like(inputs, at, free) * scalar_at(between, count - 1)
            + load_like(inputs, at + half, free) * scalar_at(between, 2 * count - 1)
        )
    return free


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def add_response(
    response: FloatArray, level: int, excess: FloatArray, first: int, last: int, values: FloatArray, found: FloatArray
) -> None:
    """Write into `found` the values and what excess forces (channels, LANES) do, in columns from `first` to `last`.

    Both are multiples of LANES.
    """
    c = first
    while c + 4 * LANES <= last:
        store(found, c, _answer(response, level, excess, c, load_like(values, c, _four_registers(0.0))))
        c += 4 * LANES
    while c < last:
        store(found, c, _answer(response, level, excess, c, load_like(values, c, splat(0.0))))
        c += LANES


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _answer(response: FloatArray, level: int, excess: FloatArray, c: int, values: Lanes) -> Lanes:
    channels, row = response.shape[1], response.shape[3]
    at = level * channels * NODES * row + c
    for channel in range(channels):
        values = values + _three(response, at, row, excess, channel * LANES, values)
        at += NODES * row
    return values


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _three(table: FloatArray, at: int, row: int, forces: FloatArray, first: int, like: Lanes) -> Lanes:
    """Return three rows of a table times the forces of a channel at the nodes."""
    return (
        load_like(table, at, like) * scalar_at(forces, first)
        + load_like(table, at + row, like) * scalar_at(forces, first + 1)
        + load_like(table, at + 2 * row, like) * scalar_at(forces, first + 2)
    )


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def write_middle(
    middle: FloatArray, start: FloatArray, memory: FloatArray, channels: int, between: FloatArray, state: FloatArray
) -> None:
    """Write the state (columns of `middle`,), zeros behind it, in the middle of a step that was taken as a whole."""
    c, columns = 0, middle.shape[1]
    while c + 4 * LANES <= columns:
        store(state, c, _middle_columns(middle, start, memory, channels, between, c, _four_registers(0.0)))
        c += 4 * LANES
    while c < columns:
        store(state, c, _middle_columns(middle, start, memory, channels, between, c, splat(0.0)))
        c += LANES


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _middle_columns(
    middle: FloatArray, start: FloatArray, memory: FloatArray, channels: int, between: FloatArray, c: int, state: Lanes
) -> Lanes:
    row, count = middle.shape[1], between.shape[1]
    size, at = middle.shape[0] - channels * NODES - 2 * count, c
    for j in range(0, size, 2):
        state = (
            state
            + load_like(middle, at, state) * scalar_at(start, j)
            + load_like(middle, at + row, state) * scalar_at(start, j + 1)
        )
        at += 2 * row
    for channel in range(channels):
        state = state + _three(middle, at, row, memory, channel * LANES, state)
        at += NODES * row
    for k in range(2 * count):
        state = state + load_like(middle, at, state) * scalar_at(between, k)
        at += row
    return state


MOST_ITERATIONS = 6
SMOOTH_CHANGE = 2e-3
"""Of the static approach: the largest correction after which forces are not asked for again.

The force follows it by its tangent, but friction, moments and what a tilt does to the force follow in proportion alone.
At 2e-2 a sensor behind a resonance at 9.7 kHz erred by 7.5e-4, at 2e-3 by 4.4e-4, at 1e-4 by 3.9e-4.
"""
KINKED_CHANGE = 1e-4
"""The same where a flank touches or parts within the step."""
FINEST = SPLIT ** (LEVELS - 1)
TOUCHED = 2
"""How often a step is halved at least in which a flank touches or parts."""
ROUND = 4.0
"""Sliding speed over the slip speed at which friction has turned: tanh is 0.999."""
TURNED = 1.0
"""The same for a turn behind that reach, where vibration moves it: seen when a step was taken.

A damaged pair moves it by twice the reach; with whole steps there a record of `paper_b` erred by 1.35e-3, so by 2.6e-4.
"""
CHANNELS = 5
LAST_LEVEL, TOUCHING, ATTEMPTS, SHORTENED = range(4)
"""Places in the rows of the memory behind the excess forces, one for each mesh; only TOUCHING is that of the mesh."""


class Work(NamedTuple):
    """Working space: see `work_arrays`."""

    nodes: tuple[FloatArray, ...]
    tables: tuple[FloatArray, ...]
    excess: FloatArray
    seen: FloatArray
    state: FloatArray
    end: FloatArray
    between: FloatArray
    touching: NDArray[np.int64]
    before: NDArray[np.int64]


class Loop(NamedTuple):
    """What stays while a motion is stepped.

    A step of the scheme takes `stride` of those asked for, 1 or 2; one that is left over at the end is half of it.
    `speed_input`: number of the input that is the deviation of the speed, or -1; `tolerance_n`: how far the force may
    be bent; `approach_m`: the static approach, or that of a light contact; `events` of `event_places`; those of meshes.
    """

    scheme: Scheme
    laws: tuple[PairLaw, ...]
    stride: int
    speed_input: int
    tolerance_n: FloatArray
    approach_m: FloatArray
    events: tuple[NDArray[np.bool_], ...]


def fresh_memory(meshes: int) -> FloatArray:
    """Return what is carried from step to step beside the state, as it is at the start: (rows, LANES).

    Excess forces at the nodes of the last step, CHANNELS rows for each mesh; then, for each mesh, the level of that
    step, which slots touched at its end (`write_springs`; -1: not known), and how many steps were tried and shortened.
    """
    memory = np.zeros(((CHANNELS + 1) * meshes, LANES))
    memory[CHANNELS * meshes :, TOUCHING] = -1.0
    return memory


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _turns(law: PairLaw, node: FloatArray, pitches_0: float, pitches_1: float) -> bool:
    """Return whether the sliding of a pair turns within a step whose nodes are known, vibration included."""
    if law.places[layout.ROUGHNESSES] == 0:
        return False
    start, pitch = law.scalars[layout.START_M], law.scalars[layout.PITCH_M]
    growth = node[NODE_SLIDING_1, NODES - 1]
    before = pitches_0 + (node[NODE_SLIDING_0, 0] / node[NODE_SLIDING_1, 0] + start) / pitch
    after = pitches_1 + (node[NODE_SLIDING_0, NODES - 1] / growth + start) / pitch
    reach = TURNED * law.scalars[layout.SLIP_SPEED] / abs(growth * pitch)
    turns: bool = np.floor(max(before, after) + reach) > np.floor(min(before, after) - reach)
    return turns


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _attempt(  # noqa: PLR0912 - compiled, and cut up it would count references
    loop: Loop, level: int, pitches_0: float, pitches_1: float, speed_ratio: float, memory: FloatArray,
    pairs: tuple[FloatArray, ...], work: Work,
) -> bool:  # fmt: skip
    """Write the state at the end of a step; return False, and keep the memory as it is, if the step has an event."""
    scheme, laws = loop.scheme, loop.laws
    response, linear, legendre, extrapolation = scheme.response, scheme.linear, scheme.legendre, scheme.extrapolation
    excess, seen, start, end, between = work.excess, work.seen, work.state, work.end, work.between
    size, channels, meshes = scheme.transition.shape[1], response.shape[1], len(laws)
    tilts = channels > 3 * meshes
    first, sight, kept = size + -size % LANES, (3 if tilts else 2) * LANES, CHANNELS * meshes
    free_motion(scheme.transition, scheme.input_response, level, start, between, end)
    last = int(memory[kept, LAST_LEVEL])
    at = (last * LEVELS + level) * NODES * LANES
    ahead_0, ahead_1, ahead_2 = (
        load(extrapolation, at),
        load(extrapolation, at + LANES),
        load(extrapolation, at + 2 * LANES),
    )
    for channel in range(channels):
        guess = splat(0.0) + ahead_0 * scalar_at(memory, channel * LANES)
        guess = guess + ahead_1 * scalar_at(memory, channel * LANES + 1)
        store(excess, channel * LANES, guess + ahead_2 * scalar_at(memory, channel * LANES + 2))
    for mesh in range(meshes):
        work.touching[mesh], work.before[mesh] = 0, -1
    settled = False
    for iteration in range(MOST_ITERATIONS):
        settled = True
        for mesh in range(meshes):
            law, node, own = laws[mesh], work.nodes[mesh], first + mesh * sight
            add_response(response, level, excess, own, own + sight, end, seen)
            see(linear, mesh, seen, own, speed_ratio, node, tilts)
            from_0 = pitches_0 * scheme.places[mesh, 0] + scheme.places[mesh, 1]
            to_1 = pitches_1 * scheme.places[mesh, 0] + scheme.places[mesh, 1]
            touching = write_lane_forces(law, from_0, to_1, pairs[mesh], work.tables[mesh], node)
            if touching == NOT_HERE:
                touching = write_node_forces(
                    law, scheme.nodes, scheme.weights, from_0, to_1, pairs[mesh], node, SMOOTH_SHARE
                )
            change = correct(response, linear, level, mesh, own, node, excess)
            kinked = touching < 0 or (iteration > 0 and touching != work.before[mesh])
            work.touching[mesh], work.before[mesh] = touching, touching
            if not change <= (KINKED_CHANGE if kinked else SMOOTH_CHANGE) * loop.approach_m[mesh]:
                settled = False
        if settled:
            break
    if level < LEVELS - 1:
        if not settled:
            return False
        for mesh in range(meshes):
            node, touching, bent, rubbing = work.nodes[mesh], work.touching[mesh], 0.0, 0.0
            for q in range(NODES):
                bent += legendre[NODES - 1, q] * node[NODE_NORMAL, q]
                rubbing += legendre[NODES - 1, q] * node[NODE_FRICTION, q]
            from_0 = pitches_0 * scheme.places[mesh, 0] + scheme.places[mesh, 1]
            to_1 = pitches_1 * scheme.places[mesh, 0] + scheme.places[mesh, 1]
            if level == 0 and _turns(laws[mesh], node, from_0, to_1):
                return False
            parted = touching < 0 or touching != int(memory[kept + mesh, TOUCHING])
            if (level < TOUCHED and parted) or not max(abs(bent), abs(rubbing)) <= loop.tolerance_n[mesh]:
                return False
    add_response(response, level, excess, 0, first, end, end)
    for channel in range(channels):
        store(memory, channel * LANES, load(excess, channel * LANES))
    memory[kept, LAST_LEVEL] = level
    for mesh in range(meshes):
        touching = work.touching[mesh]
        memory[kept + mesh, TOUCHING] = touching if touching >= 0 else -1 - touching
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


def work_arrays(scheme: Scheme, laws: Sequence[PairLaw]) -> Work:
    """Return working space for `advance`.

    Of every mesh values at nodes, and pairs in lanes; excess forces, what is seen, state, end, inputs; which slots
    touch in every mesh, and did before.

    Allocated outside: compiled code that allocates nothing need not count references, which costs more than the forces.
    """
    columns, inputs = scheme.transition.shape[2], scheme.input_response.shape[2]
    return Work(
        nodes=tuple(aligned(np.zeros((NODE_ROWS, LANES))) for _ in laws),
        tables=tuple(lane_table(law, scheme.nodes, scheme.weights) for law in laws),
        excess=aligned(np.zeros((CHANNELS * len(laws), LANES))),
        seen=aligned(np.zeros(columns)),
        state=aligned(np.zeros(columns)),
        end=aligned(np.zeros(columns)),
        between=aligned(np.zeros((2, inputs))),
        touching=np.zeros(len(laws), dtype=np.int64),
        before=np.zeros(len(laws), dtype=np.int64),
    )


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _meets_event(loop: Loop, pairs: tuple[FloatArray, ...], pitches_0: float, pitches_1: float) -> bool:
    """Return whether a pair of any mesh meets an event between two angles of the first mesh."""
    scheme = loop.scheme
    for mesh in range(len(loop.laws)):
        law = loop.laws[mesh]
        centre = -scheme.linear[mesh, ROLL_0] / scheme.linear[mesh, ROLL_1]
        pitch_place = (centre - law.scalars[layout.START_M]) / law.scalars[layout.PITCH_M]
        reach = ROUND * law.scalars[layout.SLIP_SPEED] / abs(scheme.linear[mesh, ROLL_1] * law.scalars[layout.PITCH_M])
        reach = reach if law.places[layout.ROUGHNESSES] > 0 else -1.0
        rate, begins = scheme.places[mesh, 0], scheme.places[mesh, 1]
        from_0, to_1 = pitches_0 * rate + begins, pitches_1 * rate + begins
        if _has_event(law, pairs[mesh], loop.events[mesh], pitch_place, reach, from_0, to_1):
            return True
    return False


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _mark(memory: FloatArray, meshes: int, step: int, apart: NDArray[np.bool_]) -> None:
    """Mark the meshes in which no pair touches at the end of a step."""
    for mesh in range(meshes):
        apart[mesh, step] = memory[CHANNELS * meshes + mesh, TOUCHING] == 0.0


@entry(cache=True, _nrt=False, error_model="numpy")
def advance(  # noqa: PLR0912 - compiled, and cut up it would count references
    loop: Loop, pitches: FloatArray, inputs: FloatArray, memory: FloatArray, pairs: tuple[FloatArray, ...], work: Work,
    apart: NDArray[np.bool_], trajectory: FloatArray,
) -> None:  # fmt: skip
    """Fill `trajectory` (steps + 1, 2n) after row 0; mark in `apart` (meshes, steps) at which of them no pair touches.

    `pitches` (steps + 1,), `inputs` (steps + 1, m); `memory` of `fresh_memory` and of every mesh `pairs` (NODES slots,
    COLUMNS) go on from the steps before.
    """
    scheme, stride, speed_input, meshes = loop.scheme, loop.stride, loop.speed_input, len(loop.laws)
    size, m, kept = scheme.transition.shape[1], inputs.shape[1], CHANNELS * meshes
    state, end, between = work.state, work.end, work.between
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
        if until < FINEST or _meets_event(loop, pairs, pitches[i], pitches[last]):
            level = 1
        while place < until:
            length = FINEST // SPLIT**level
            a, b = place / until, (place + length) / until
            for k in range(m):
                rise = inputs[last, k] - inputs[i, k]
                between[0, k], between[1, k] = inputs[i, k] + a * rise, inputs[i, k] + b * rise
            memory[kept, ATTEMPTS] += 1.0
            a, b = place / FINEST, (place + length) / FINEST
            if not _attempt(
                loop, level, pitches[i] + a * turned, pitches[i] + b * turned, ratio, memory, pairs, work
            ):  # fmt: skip
                level += 1
                memory[kept, SHORTENED] += 1.0
                continue
            if stride == 2 and level == 0:
                write_middle(scheme.middle, state, memory, scheme.response.shape[1], between, work.seen)
                for j in range(size):
                    trajectory[i + 1, j] = work.seen[j]
                _mark(memory, meshes, i, apart)
            for j in range(size):
                state[j] = end[j]
            place += length
            if stride == 2 and place == FINEST // 2:
                _mark(memory, meshes, i, apart)
                for j in range(size):
                    trajectory[i + 1, j] = state[j]
            while level > 0 and place % (FINEST // SPLIT ** (level - 1)) == 0:
                level -= 1
        _mark(memory, meshes, last - 1, apart)
        for j in range(size):
            trajectory[last, j] = state[j]
        i = last
