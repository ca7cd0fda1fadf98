"""The matrix exponential against closed forms, and to the last bit for any number of numeric threads."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.motion.exponential_scheme import matrix_exponential

EPS = np.finfo(float).eps


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.3, 2.0, 40.0])
def test_the_exponential_of_a_rotation_rate_turns(angle: float) -> None:
    turned = matrix_exponential(np.array([[0.0, -angle], [angle, 0.0]]))
    expected = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    # Every squaring doubles the rounding error of the one before it: an error of the order of the angle.
    np.testing.assert_allclose(turned, expected, rtol=0.0, atol=8.0 * EPS * max(1.0, angle))


def test_a_chain_of_integrators_gives_the_powers_of_time_over_factorials() -> None:
    chain = np.diag(np.ones(3), 1)
    expected = [[1.0, 1.0, 1 / 2, 1 / 6], [0.0, 1.0, 1.0, 1 / 2], [0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0]]
    np.testing.assert_allclose(matrix_exponential(chain), expected, rtol=4.0 * EPS, atol=0.0)


@given(seed=st.integers(0, 2**32 - 1), size=st.integers(1, 20), norm=st.floats(1e-6, 30.0))
@settings(max_examples=50, deadline=None)
def test_it_is_that_of_diagonalised_matrices_and_its_inverse_that_of_the_negative(seed, size, norm) -> None:
    half = np.random.default_rng(seed).standard_normal((size, size))
    matrix = half + half.T
    matrix *= norm / np.abs(matrix).sum(axis=0).max()
    values, vectors = np.linalg.eigh(matrix)
    expected = (vectors * np.exp(values)) @ vectors.T
    # Of a symmetric matrix the error is the rounding of the products, up to `norm` doublings and `size` terms each.
    scale = 10.0 * EPS * size * max(1.0, norm) * np.exp(values.max())
    np.testing.assert_allclose(matrix_exponential(matrix), expected, rtol=0.0, atol=scale)
    product = matrix_exponential(matrix) @ matrix_exponential(-matrix)
    np.testing.assert_allclose(product, np.eye(size), rtol=0.0, atol=scale * np.exp(-values.min()))


def test_its_bits_do_not_depend_on_the_number_of_numeric_threads() -> None:
    threadpoolctl = pytest.importorskip("threadpoolctl")
    rng = np.random.default_rng(3)
    matrices = [rng.standard_normal((n, n)) / 10.0 for n in (12, 16, 20, 24, 36)]  # other algorithms differed at these
    found = []
    for threads in (1, 3, 16):
        with threadpoolctl.threadpool_limits(threads):
            found.append([matrix_exponential(matrix).tobytes() for matrix in matrices])
    assert found[0] == found[1] == found[2]
