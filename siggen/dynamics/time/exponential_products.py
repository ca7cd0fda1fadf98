"""Products of the exponential integrator's constants with state, inputs and forces, compiled (`exponential_scheme`).

The innermost loops run over columns, which lie side by side: several are taken at once, without reordering sums.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.dynamics.time.exponential_scheme import NODES


@njit(cache=True, _nrt=False, inline="always", error_model="numpy")
def free_motion(
    transition: FloatArray, inputs: FloatArray, level: int, start: FloatArray, between: FloatArray, free: FloatArray
) -> None:
    """Write the state after a step, and what the mesh sees in it, without excess forces into `free` (columns,)."""
    for c in range(free.size):
        free[c] = 0.0
    rows, count = transition.shape[1], between.shape[1]  # rows are even: places and speeds
    for j in range(0, rows - 3, 4):
        s_0, s_1, s_2, s_3 = start[j], start[j + 1], start[j + 2], start[j + 3]
        for c in range(free.size):
            free[c] = (
                free[c]
                + (transition[level, j, c] * s_0 + transition[level, j + 1, c] * s_1)
                + (transition[level, j + 2, c] * s_2 + transition[level, j + 3, c] * s_3)
            )
    if rows % 4 != 0:
        s_0, s_1 = start[rows - 2], start[rows - 1]
        for c in range(free.size):
            free[c] += transition[level, rows - 2, c] * s_0 + transition[level, rows - 1, c] * s_1
    for k in range(0, count - 1, 2):
        s_0, s_1, s_2, s_3 = between[0, k], between[1, k], between[0, k + 1], between[1, k + 1]
        for c in range(free.size):
            free[c] = (
                free[c]
                + (inputs[level, 0, k, c] * s_0 + inputs[level, 1, k, c] * s_1)
                + (inputs[level, 0, k + 1, c] * s_2 + inputs[level, 1, k + 1, c] * s_3)
            )
    if count % 2 != 0:
        s_0, s_1 = between[0, count - 1], between[1, count - 1]
        for c in range(free.size):
            free[c] += inputs[level, 0, count - 1, c] * s_0 + inputs[level, 1, count - 1, c] * s_1


@njit(cache=True, _nrt=False, inline="always", error_model="numpy")
def add_response(
    response: FloatArray, level: int, excess: FloatArray, first: int, last: int, values: FloatArray
) -> None:
    """Add what excess forces (channels, NODES) do to the columns from `first` up to but without `last`."""
    for channel in range(response.shape[1]):
        e_0, e_1, e_2 = excess[channel, 0], excess[channel, 1], excess[channel, 2]
        for c in range(np.uint64(first), np.uint64(last)):  # never negative, which the compiler cannot know of others
            values[c] += (
                response[level, channel, 0, c] * e_0
                + response[level, channel, 1, c] * e_1
                + response[level, channel, 2, c] * e_2
            )


@njit(cache=True, _nrt=False, inline="always", error_model="numpy")
def write_middle(
    middle: FloatArray, start: FloatArray, memory: FloatArray, channels: int, between: FloatArray, state: FloatArray
) -> None:
    """Write the state (2n,) in the middle of a step that was taken as a whole."""
    size, count = state.size, between.shape[1]
    for c in range(size):
        state[c] = 0.0
    for j in range(0, size, 2):
        first, second = start[j], start[j + 1]
        for c in range(size):
            state[c] = state[c] + middle[j, c] * first + middle[j + 1, c] * second
    row = size
    for channel in range(channels):
        e_0, e_1, e_2 = memory[channel, 0], memory[channel, 1], memory[channel, 2]
        for c in range(size):
            state[c] += middle[row, c] * e_0 + middle[row + 1, c] * e_1 + middle[row + 2, c] * e_2
        row += NODES
    for end in range(2):
        for k in range(0, count - 1, 2):
            first, second = between[end, k], between[end, k + 1]
            for c in range(size):
                state[c] = state[c] + middle[row + k, c] * first + middle[row + k + 1, c] * second
        if count % 2 != 0:
            first = between[end, count - 1]
            for c in range(size):
                state[c] += middle[row + count - 1, c] * first
        row += count
