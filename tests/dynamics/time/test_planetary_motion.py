"""Six meshes in motion: which orders of the carrier a sensor on the ring shows, and what each mesh carries."""

from __future__ import annotations

import numpy as np
import pytest
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
ORDERS = 2000
"""12 kHz: above all modes."""
IN_THREE = 3 * 2**14
"""Steps per turn that planets share alike, so that steps do not part them."""


def run(per_turn, late_m=0.0, kind=PairMotion, faulty="", turns=1):
    """One turn of the carrier and some more; the transient takes a tenth of one."""
    assert planetary_problems(TEETH) == ()
    structure = planetary_structure(planetary_stage(3, TEETH.sun, TEETH.planet, TEETH.ring))
    mean = MeanState(60.0, CARRIER_HZ * TEETH.ring / TEETH.sun)
    motion = kind(structure, meshes(structure, TEETH, late_m, faulty), mean=mean, step_s=1.0 / (CARRIER_HZ * per_turn))
    pitches = TEETH.ring * np.arange(round((turns + 1) * per_turn) + 1) / per_turn
    states = np.empty((pitches.size, 2 * len(structure.coordinates)))
    states[0] = motion.start(0.0)
    motion.advance(pitches, no_inputs(pitches), states)
    return motion, pitches, states


def power(motion, pitches, states, turns=1):
    """Return the power of the radial acceleration at a fixed place of the ring, by orders of the carrier / turns."""
    names = motion.structure.coordinates
    last = slice((pitches.size - 1) // (turns + 1), pitches.size - 1)
    n, turned = len(names), 2.0 * np.pi * pitches[last] / TEETH.ring
    static, omega = motion.equations.static_deflection, 2.0 * np.pi * CARRIER_HZ
    x, y = (states[last, i] + static[i] for i in (names.index("x_ring"), names.index("y_ring")))
    u, v = (states[last, n + i] for i in (names.index("x_ring"), names.index("y_ring")))
    speed = np.cos(turned) * (u - omega * y) - np.sin(turned) * (v + omega * x)
    lines = np.fft.rfft(speed)
    return np.abs(lines * np.arange(lines.size))[: turns * ORDERS] ** 2


def share_of_others(found):
    return found[np.arange(found.size) % 3 != 0].sum() / found.sum()


@pytest.fixture(scope="module")
def healthy():
    return run(IN_THREE)


@pytest.mark.slow  # records of tests/cli/test_planetary_sets.py prove these three by command
def test_a_healthy_set_shows_multiples_of_its_planets_alone_and_none_at_the_mesh_frequency(healthy):
    found = power(*healthy)
    assert share_of_others(found) < 1e-4  # -40 dB
    assert found[78] > 1e4 * max(found[76], found[77])
    assert all(TEETH.carries_line(order) for order in np.argsort(found)[::-1][:6].tolist())


@pytest.mark.slow
def test_a_planet_out_of_place_brings_back_all_orders():
    assert share_of_others(power(*run(IN_THREE, late_m=20e-6))) > 1e-3  # ten times what a healthy set may have


@pytest.mark.slow
def test_a_damaged_tooth_of_the_ring_changes_heights_and_adds_no_line(healthy):
    found, before = power(*run(IN_THREE, faulty="ring")), power(*healthy)
    assert share_of_others(found) < 1e-4
    orders = np.arange(found.size)
    away = np.abs((orders + 38) % 77 - 38) > 1  # from harmonics of the mesh, beside which a healthy set has its lines
    assert found[away].sum() / found.sum() > 5.0 * before[away].sum() / before.sum()


@pytest.mark.slow
def test_a_damaged_tooth_of_the_sun_adds_lines_at_sums_of_passing_planets_and_turns_of_the_sun_alone():
    """Over 25 turns, after which all teeth of the sun stand again as they did: 3 i + 102/25 j."""
    found = power(*run(IN_THREE // 4, faulty="sun", turns=25), turns=25)
    places = np.arange(found.size)
    assert found[places % 3 != 0].sum() < 1e-4 * found.sum()
    assert found[places % 75 != 0].sum() > 1e-3 * found.sum()  # ten times what may stand elsewhere


BEGUN = 1 / 16
"""Of a turn: nearly five pitches of every mesh."""


def approach_rate(kind, per_turn):
    """Return the rate of the first mesh's approach over the beginning, 2^13 times per turn."""
    motion, _, states = run(per_turn, kind=kind, turns=BEGUN - 1.0)
    n = len(motion.structure.coordinates)
    return states[:: per_turn // 2**13, n:] @ motion.structure.meshes[0].vector


def test_both_kinds_of_steps_tend_to_what_an_adaptive_solver_gives_of_loads_that_jump():
    """Those of these tables do where pairs enter: a step that passes over it errs by its length, whatever its order.

    Exponential steps are a tenth as long there. The solver agrees with itself to 2e-5.
    """
    motion, _, states = run(2**13, turns=BEGUN - 1.0)
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
