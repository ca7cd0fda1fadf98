"""Products of the exponential integrator's constants with state, inputs and forces, compiled (`exponential_scheme`).

The innermost loops run over columns, which lie side by side: several are taken at once, without reordering sums.
"""

from __future__ import annotations

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.dynamics.time.exponential_scheme import NODES


@njit(cache=True, _nrt=False, inline="always")
def free_motion(
    transition: FloatArray, inputs: FloatArray, level: int, start: FloatArray, between: FloatArray, free: FloatArray
) -> None:
    """Write the state after a step, and what the mesh sees in it, without excess forces into `free` (columns,)."""
    for c in range(free.size):
        free[c] = 0.0
    for j in range(0, transition.shape[1], 2):
        first, second = start[j], start[j + 1]
        for c in range(free.size):
            free[c] += transition[level, j, c] * first + transition[level, j + 1, c] * second
    for k in range(between.shape[1]):
        first, second = between[0, k], between[1, k]
        for c in range(free.size):
            free[c] += inputs[level, 0, k, c] * first + inputs[level, 1, k, c] * second


@njit(cache=True, _nrt=False, inline="always")
def add_response(
    response: FloatArray, level: int, excess: FloatArray, first: int, last: int, values: FloatArray
) -> None:
    """Add what excess forces (channels, NODES) do to the columns from `first` up to but without `last`."""
    for channel in range(response.shape[1]):
        e_0, e_1, e_2 = excess[channel, 0], excess[channel, 1], excess[channel, 2]
        for c in range(first, last):
            values[c] += (
                response[level, channel, 0, c] * e_0
                + response[level, channel, 1, c] * e_1
                + response[level, channel, 2, c] * e_2
            )


@njit(cache=True, _nrt=False, inline="always")
def write_middle(
    middle: FloatArray, start: FloatArray, memory: FloatArray, channels: int, between: FloatArray, state: FloatArray
) -> None:
    """Write the state (2n,) in the middle of a step that was taken as a whole."""
    size = state.size
    for c in range(size):
        state[c] = 0.0
    for j in range(size):
        value = start[j]
        for c in range(size):
            state[c] += middle[j, c] * value
    row = size
    for channel in range(channels):
        e_0, e_1, e_2 = memory[channel, 0], memory[channel, 1], memory[channel, 2]
        for c in range(size):
            state[c] += middle[row, c] * e_0 + middle[row + 1, c] * e_1 + middle[row + 2, c] * e_2
        row += NODES
    for end in range(2):
        for k in range(between.shape[1]):
            value = between[end, k]
            for c in range(size):
                state[c] += middle[row, c] * value
            row += 1
