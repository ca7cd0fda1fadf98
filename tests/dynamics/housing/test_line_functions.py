"""Functions along an edge: what they are at its ends, and their integrals."""

import numpy as np
import pytest
from scipy.integrate import quad

from siggen.dynamics.housing.line_functions import LineFunctions

LENGTH = 0.3


@pytest.mark.parametrize("mirrored", [False, True])
def test_cubics_have_unit_value_or_slope_at_an_end_and_bubbles_nothing(mirrored: bool) -> None:
    line = LineFunctions(LENGTH, 7, mirrored)
    values = line.at(np.array([0.0, LENGTH]))
    ends = np.concatenate([values[0].T, values[1].T])  # v(0), v(l), v'(0), v'(l)
    expected = np.eye(4)
    if mirrored:  # V even, V odd, S even, S odd
        expected = np.array([[1, 1, 0, 0], [1, -1, 0, 0], [0, 0, 1, 1], [0, 0, -1, 1]], dtype=float)
    np.testing.assert_allclose(ends[:, :4], expected, atol=1e-12)
    np.testing.assert_allclose(ends[:, 4:], 0.0, atol=1e-11)


def test_derivatives_are_those_of_the_values() -> None:
    line, x, step = LineFunctions(LENGTH, 9, False), np.linspace(0.01, 0.29, 7), 1e-5
    before, at, after = line.at(x - step), line.at(x), line.at(x + step)
    for d in (1, 2):
        # Central differences: third derivatives of degree 12 times step² over 6.
        np.testing.assert_allclose((after[d - 1] - before[d - 1]) / (2 * step), at[d], rtol=2e-4, atol=1e-3)


@pytest.mark.parametrize(("a", "b", "i", "k"), [(0, 0, 1, 6), (1, 1, 2, 9), (2, 2, 3, 3), (2, 0, 5, 1), (0, 1, 10, 4)])
def test_integrals_are_those_of_an_adaptive_rule(a: int, b: int, i: int, k: int) -> None:
    line = LineFunctions(LENGTH, 8, True)
    found = quad(lambda x: float(np.prod(line.at(np.array([x]))[[a, b], [i, k], 0])), 0.0, LENGTH, epsabs=1e-13)[0]
    assert line.integrals()[a, b, i, k] == pytest.approx(found, rel=1e-9, abs=1e-12)


def test_functions_of_a_mirrored_line_are_even_or_odd() -> None:
    line, x = LineFunctions(LENGTH, 6, True), np.linspace(0.0, LENGTH, 9)
    sign = np.where(np.array(line.names.parity) == 0, 1.0, -1.0)[:, None]
    np.testing.assert_allclose(line.at(x)[0], sign * line.at(LENGTH - x)[0], atol=1e-13)
