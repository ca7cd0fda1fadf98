"""Inputs on a coarse grid: finer grids that begin with what is known."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from siggen.drivetrain.drive import Drive
from siggen.drivetrain.excitation import COARSEST_HZ, MARGIN, SampledExcitation, _knots


@pytest.mark.parametrize("seed", range(20))
def test_every_other_knot_of_a_finer_grid_is_one_of_the_coarser_to_the_last_bit(seed: int) -> None:
    rng = np.random.default_rng(seed)
    first_s = float(rng.uniform(-2.0, 60.0))
    last_s, rate_hz = first_s + float(rng.uniform(0.01, 3.0)), float(rng.choice([2000.0, 4000.0, 8000.0]))
    fine, coarse = _knots(first_s, last_s, 2.0 * rate_hz)[::2], _knots(first_s, last_s, rate_hz)
    assert fine.tobytes() == coarse[MARGIN // 2 :][: fine.size].tobytes()
    assert fine.size <= coarse.size - MARGIN // 2


def test_a_grid_that_is_refined_keeps_what_it_knew_and_follows_a_line_too_fast_for_the_coarsest() -> None:
    """A spline errs by (π f/rate)⁴/24 or so: 60 Hz at 2 kHz is 3e-6 off, above the millionth; at 4 kHz below it."""
    asked = []

    def inputs(time_s: np.ndarray, _: object) -> np.ndarray:
        asked.append(time_s)
        return np.stack([np.cos(2.0 * np.pi * 60.0 * time_s), np.ones(time_s.size)], axis=1)

    drive = Drive(30.0, 0.0)
    source = SimpleNamespace(inputs=inputs, sharp_turn_rad=0.0)
    found = SampledExcitation(source, drive, 0.0, 0.5, 1e5)  # type: ignore[arg-type]
    knots = [times for times in asked if times.size > 200]
    assert len(knots) >= 2
    assert knots[1].size == pytest.approx(0.5 * COARSEST_HZ, rel=0.02)  # the new half of the grid of twice the rate
    times = np.linspace(0.0, 0.5, 4001)
    np.testing.assert_allclose(found.inputs(times, drive), inputs(times, drive), atol=2e-6)
