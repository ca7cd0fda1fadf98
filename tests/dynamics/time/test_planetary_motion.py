"""Six meshes in motion, where loads of tables jump; what a sensor shows of them: tests/cli/test_planetary_sets.py."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

from siggen.gears.planetary import PlanetarySet, planetary_problems
from siggen.motion.equations import no_inputs
from siggen.motion.exponential_motion import ExponentialMotion
from siggen.motion.pair_motion import MeanState, PairMotion
from tests.dynamics.planetary_set import meshes, planetary_stage
from tests.dynamics.trains import planetary_structure
from tests.gears.builders import even_places

TEETH = PlanetarySet(25, 26, 77, even_places(3))
"""One harmonic in three is in step at all planets; planets with even teeth."""
CARRIER_HZ = 6.0
BEGUN = 1 / 16
"""Of a turn: nearly five pitches of every mesh."""


def run(per_turn, kind=PairMotion):
    """Return the beginning of a turn of the carrier."""
    assert planetary_problems(TEETH) == ()
    structure = planetary_structure(planetary_stage(3, TEETH.sun, TEETH.planet, TEETH.ring))
    mean = MeanState(60.0, CARRIER_HZ * TEETH.ring / TEETH.sun)
    motion = kind(structure, meshes(structure, TEETH), mean=mean, step_s=1.0 / (CARRIER_HZ * per_turn))
    pitches = TEETH.ring * np.arange(round(BEGUN * per_turn) + 1) / per_turn
    states = np.empty((pitches.size, 2 * len(structure.coordinates)))
    states[0] = motion.start(0.0)
    motion.advance(pitches, no_inputs(pitches), states)
    return motion, states


def approach_rate(kind, per_turn):
    """Return the rate of the first mesh's approach over the beginning, 2^13 times per turn."""
    motion, states = run(per_turn, kind)
    n = len(motion.structure.coordinates)
    return states[:: per_turn // 2**13, n:] @ motion.structure.meshes[0].vector


def test_both_kinds_of_steps_tend_to_what_an_adaptive_solver_gives_of_loads_that_jump():
    """Those of these tables do where pairs enter: a step that passes over it errs by its length, whatever its order.

    Exponential steps are a tenth as long there. The solver agrees with itself to 2e-5.
    """
    motion, states = run(2**13)
    n, p = len(motion.structure.coordinates), motion.structure.meshes[0].vector
    times = np.arange(len(states)) / (CARRIER_HZ * 2**13)
    found = solve_ivp(
        lambda t, z: motion.rate(np.ascontiguousarray(z), TEETH.ring * CARRIER_HZ * t),
        (0.0, times[-1]), states[0], "RK45", times,
        rtol=1e-6, atol=1e-6 * np.repeat([1e-6, 2e-2], n), max_step=0.1 / (TEETH.ring * CARRIER_HZ),
    )  # fmt: skip
    wanted = p @ found.y[n:]

    def apart(kind, per_turn):
        return np.sqrt(np.mean((approach_rate(kind, per_turn) - wanted) ** 2) / np.mean(wanted**2))

    assert apart(ExponentialMotion, 2**19) < 1e-3
    long, short = (apart(PairMotion, per_turn) for per_turn in (2**15, 2**17))
    assert 0.15 * long < short < 0.5 * long  # a quarter, but for where steps meet the jumps
    assert apart(ExponentialMotion, 2**17) < 0.2 * short
