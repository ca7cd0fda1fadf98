"""DrivenRate: the rate of a state at a time, compiled, for solvers that are not siggen's.

Angle and inputs are straight between the points of a grid of their own. So scipy and Runge-Kutta
solve the same equations with the same compiled mesh law; what they cost beyond it is their own.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.mesh.mesh_force import MeshLaw
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.pair_springs import pair_table
from siggen.motion.equations import Equations, PairEquations, at_speed, pair_rate, state_rate
from siggen.motion.linear_motion import LinearMotion
from siggen.motion.motion import Motion
from siggen.motion.pair_motion import PairMotion

Rate = Callable[[float, FloatArray], FloatArray]


def driven_rate(motion: Motion, speed_input: int, pitches: FloatArray, inputs: FloatArray, rate_hz: float) -> Rate:
    """Return ż (2n,) of time [s] and state (2n,); `pitches` (k,) and `inputs` (k, m) at `rate_hz` from time 0 on."""
    function, model = compiled_rate(motion, speed_input, pitches, inputs)

    def of_state(t: float, state: FloatArray) -> FloatArray:
        found = np.empty_like(state)
        function(model, t * rate_hz, state, found)
        return found

    return of_state


def compiled_rate(motion: Motion, speed_input: int, pitches: FloatArray, inputs: FloatArray) -> tuple[Any, Any]:
    """Return a compiled function of (model, place on the grid, state, found), and the model; see `driven_rate`."""
    if isinstance(motion, PairMotion):
        laws = motion.laws
        pairs = tuple(pair_table(law) for law in laws)
        return _pair_rate, (motion.pair_equations, laws, pairs, speed_input, pitches, inputs)
    assert isinstance(motion, LinearMotion)
    return _linear_rate, (motion.equations, motion.law, pitches, inputs)


@entry(cache=True)
def _pair_rate(
    model: tuple[PairEquations, tuple[PairLaw, ...], tuple[FloatArray, ...], int, FloatArray, FloatArray],
    place: float,
    state: FloatArray,
    rate: FloatArray,
) -> None:
    equations, laws, pairs, speed_input, pitches, inputs = model
    first = min(max(int(place), 0), pitches.size - 2)
    share, half = place - first, state.size // 2
    deviation = 0.0
    if speed_input >= 0:
        deviation = inputs[first, speed_input] * (1.0 - share) + inputs[first + 1, speed_input] * share
    pair_rate(
        (at_speed(equations, deviation), laws, pairs),
        state,
        pitches[first] * (1.0 - share) + pitches[first + 1] * share,
        rate,
    )
    for k in range(inputs.shape[1]):
        value = inputs[first, k] * (1.0 - share) + inputs[first + 1, k] * share
        for i in range(half):
            rate[half + i] += value * equations.external_input[k, i]


@entry(cache=True)
def _linear_rate(
    model: tuple[Equations, MeshLaw, FloatArray, FloatArray], place: float, state: FloatArray, rate: FloatArray
) -> None:
    equations, law, pitches, _ = model
    first = min(max(int(place), 0), pitches.size - 2)
    share = place - first
    state_rate(equations, law, state, pitches[first] * (1.0 - share) + pitches[first + 1] * share, rate)
