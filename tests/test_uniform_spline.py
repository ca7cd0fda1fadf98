"""The spline on equal steps is scipy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from siggen.uniform_spline import UniformSpline


@pytest.mark.parametrize("count", [4, 5, 61])
def test_a_spline_on_equal_steps_is_scipys_between_and_beyond_its_ends(count: int) -> None:
    rng = np.random.default_rng(count)
    knots, values = 3.0 + 0.25 * np.arange(count), rng.normal(size=(count, 3))
    places = np.concatenate([knots, rng.uniform(knots[0] - 0.3, knots[-1] + 0.3, 300)])
    np.testing.assert_allclose(UniformSpline(3.0, 0.25, values)(places), CubicSpline(knots, values)(places), atol=1e-12)
