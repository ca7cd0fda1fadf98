"""Inputs on a coarse grid: splines as scipy evaluates them, and finer grids that begin with what is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from siggen.dynamics.drive.sampled_excitation import MARGIN, _evaluated, _knots


@pytest.mark.parametrize("seed", range(3))
def test_splines_at_ascending_times_have_the_bits_of_scipy(seed: int) -> None:
    rng = np.random.default_rng(seed)
    knots = np.cumsum(rng.uniform(0.2, 1.0, 40))
    spline = CubicSpline(knots, rng.normal(size=(40, 3)))
    span = knots[-1] - knots[0]
    times = np.sort(np.concatenate([knots, rng.uniform(knots[0] - 0.1 * span, knots[-1] + 0.1 * span, 700)]))
    assert _evaluated(spline.x, spline.c, times).tobytes() == spline(times).tobytes()


@pytest.mark.parametrize("seed", range(20))
def test_every_other_knot_of_a_finer_grid_is_one_of_the_coarser_to_the_last_bit(seed: int) -> None:
    rng = np.random.default_rng(seed)
    first_s = float(rng.uniform(-2.0, 60.0))
    last_s, rate_hz = first_s + float(rng.uniform(0.01, 3.0)), float(rng.choice([2000.0, 4000.0, 8000.0]))
    fine, coarse = _knots(first_s, last_s, 2.0 * rate_hz)[::2], _knots(first_s, last_s, rate_hz)
    assert fine.tobytes() == coarse[MARGIN // 2 :][: fine.size].tobytes()
    assert fine.size <= coarse.size - MARGIN // 2
