"""Modes of a stiff pencil against another solver."""

import numpy as np
import pytest
from scipy.linalg import eigh

from siggen.drivetrain.stiff_pencil import lowest_modes


def pencil(n: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(3)
    stiffness, mass = (rng.standard_normal((n, n)) for _ in range(2))
    return stiffness @ stiffness.T + 0.1 * np.eye(n), mass @ mass.T + n * np.eye(n)


@pytest.mark.parametrize("n", [5, 60])
def test_modes_are_those_of_lapack(n: int) -> None:
    stiffness, mass = pencil(n)
    expected = eigh(stiffness, mass, eigvals_only=True)
    found = lowest_modes(stiffness, mass, np.sqrt(expected[n // 2] * (1 + 1e-9)))
    count = max(3, n // 2 + 1)
    # Errors are those of the stiffness over its lowest value: 1e-16 x 1e4.
    np.testing.assert_allclose(found.omega_squared, expected[:count], rtol=1e-9)
    np.testing.assert_allclose(found.shapes.T @ mass @ found.shapes, np.eye(count), atol=1e-9)
    np.testing.assert_allclose(
        found.shapes.T @ stiffness @ found.shapes, np.diag(found.omega_squared), atol=1e-9 * expected.max()
    )


def test_equal_frequencies_keep_orthogonal_shapes() -> None:
    rng = np.random.default_rng(1)
    turn = np.linalg.qr(rng.standard_normal((40, 40)))[0]
    stiffness = turn @ np.diag(np.repeat(np.arange(1.0, 21.0), 2)) @ turn.T
    found = lowest_modes(0.5 * (stiffness + stiffness.T), np.eye(40), 3.0)
    np.testing.assert_allclose(found.omega_squared, np.repeat(np.arange(1.0, 10.0), 2)[: found.omega_squared.size])
    np.testing.assert_allclose(found.shapes.T @ found.shapes, np.eye(found.omega_squared.size), atol=1e-10)


def test_a_free_body_is_refused() -> None:
    stiffness, mass = pencil(10)
    stiffness[:, 0] = stiffness[0, :] = 0.0
    with pytest.raises(ValueError, match="free to move"):
        lowest_modes(stiffness, mass, 1.0)


def test_the_largest_entry_of_a_shape_is_positive() -> None:
    stiffness, mass = pencil(30)
    shapes = lowest_modes(stiffness, mass, 10.0).shapes
    assert (shapes.max(axis=0) >= -shapes.min(axis=0)).all()


@pytest.mark.parametrize("n", [3, 4, 7, 12])
def test_every_mode_of_a_small_pencil_is_that_of_lapack_whatever_rows_are_exchanged(n: int) -> None:
    for seed in range(20):
        found = np.random.default_rng(seed).standard_normal((n, n))
        stiffness = found @ found.T + 0.1 * np.eye(n)
        expected, shapes = eigh(stiffness, np.eye(n))
        modes = lowest_modes(stiffness, np.eye(n), np.sqrt(1.1 * expected[-1]))
        np.testing.assert_allclose(modes.omega_squared, expected, rtol=1e-9)
        # two modes may be near: errors of shapes are 1e-15 over the relative distance of their values
        np.testing.assert_allclose(np.abs((modes.shapes * shapes).sum(axis=0)), 1.0, atol=1e-8)
