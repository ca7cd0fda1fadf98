"""Products of the exponential integrator's constants with state, inputs and forces, compiled (`exponential_scheme`).

Columns lie side by side: many are one value of lanes, whose sum stays in registers from the first row to the last. Four
registers are added to together where there are so many columns, so that none waits for the addition before. No sum is
reordered.
"""

from __future__ import annotations

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.dynamics.time.exponential_scheme import NODES
from siggen.lanes import LANES, Lanes, load_like, scalar_at, splat, splat_of, store

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
