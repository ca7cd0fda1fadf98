"""The kernel across the face: its limit, the fit by exponentials, and the solver of its matrix."""

from __future__ import annotations

from math import exp, log

import numpy as np
import pytest

from siggen.lanes import LANES
from siggen.mesh.line_kernel import (
    EXPONENTIALS,
    RowMatrix,
    add_row_products,
    diagonal,
    kernel_family,
    line_kernel,
    products,
    reckoned_width,
    solve_rows,
    strengths,
    tooth_kernel,
    tooth_matrix,
    unit_tooth,
)

CELL, DEPTH, CELLS = 0.1e-3, 2.2e-3, 200


def fitted(half_width: float) -> np.ndarray:
    kernel = line_kernel(kernel_family(CELLS, CELL, DEPTH), DEPTH, 0.3)
    strength, slope = np.zeros(EXPONENTIALS), np.zeros(EXPONENTIALS)
    strengths(kernel, half_width, strength, slope)
    offset = np.abs(np.arange(CELLS)[:, None] - np.arange(CELLS))
    matrix = (strength * kernel.decay ** offset[..., None]).sum(axis=-1)
    np.fill_diagonal(matrix, diagonal(kernel, half_width)[0])
    return matrix


def kernel_matrix(cells: int, cell_m: float, half_width_m: float, poisson_ratio: float) -> np.ndarray:
    """Return the kernel (cells, cells) by its integrals over cells: the near field less what lies below."""
    ends = np.arange(cells)[:, None] + np.array([-0.5, 0.5])
    near = np.arcsinh(2.0 * np.exp(0.5) * cell_m / half_width_m * ends)
    y = cell_m * ends
    below = np.arcsinh(y / DEPTH) + y / (2.0 * (1.0 - poisson_ratio) * np.hypot(y, DEPTH))
    row = 0.5 * np.diff(near - below, axis=1).ravel()
    offset = np.arange(cells)
    return np.asarray(row[np.abs(offset[:, None] - offset)])


def test_an_endless_line_has_the_secant_of_weber_and_banaschek():
    # middle of a face of 364 h in wide cells; the ends' share falls as (h/L)²
    matrix = kernel_matrix(1601, 5.0 * CELL, 67e-6, 0.3)
    assert matrix[800].sum() == pytest.approx(log(2.0 * DEPTH / 67e-6) - 0.3 / 1.4, abs=1e-5)


@pytest.mark.parametrize("half_width_um", [20.0, 67.0, 150.0, 250.0])
def test_the_exponentials_are_the_kernel(half_width_um):
    # the energy's width: e^-1/4 of the secant's
    exact = kernel_matrix(CELLS, CELL, exp(-0.25) * half_width_um * 1e-6, 0.3)
    error = fitted(half_width_um * 1e-6) - exact
    assert np.abs(error).max() < 1e-3
    assert np.abs(error.sum(axis=1)).max() < 6e-3


@pytest.mark.parametrize("half_width_um", [20.0, 67.0, 150.0, 250.0])
def test_the_kernel_of_the_energy_is_positive_definite_with_its_softening(half_width_um):
    width, slope, _ = reckoned_width(half_width_um * 1e-6, CELL)
    assert np.linalg.eigvalsh(fitted(width)).min() > 0.25 * slope + 0.06


@pytest.mark.parametrize("coupled", [True, False])
def test_slopes_are_derivatives(coupled):
    kernel = line_kernel(kernel_family(CELLS, CELL, DEPTH), DEPTH, 0.3, coupled=coupled)
    values, step = [], 1e-6
    for scale in (1.0 - step, 1.0, 1.0 + step):
        strength, slope = np.zeros(EXPONENTIALS), np.zeros(EXPONENTIALS)
        strengths(kernel, 67e-6 * scale, strength, slope)
        values.append((np.append(strength, diagonal(kernel, 67e-6 * scale)[0]), slope))
    found = (values[2][0] - values[0][0]) / (2.0 * step)
    np.testing.assert_allclose(np.append(values[1][1], diagonal(kernel, 67e-6)[1]), found, rtol=1e-6, atol=1e-8)


def test_the_width_of_a_wide_contact_is_reckoned_with_smoothly():
    widths = np.geomspace(0.05e-3, 0.6e-3, 2001)
    answers = np.array([reckoned_width(a, CELL) for a in widths])
    np.testing.assert_array_equal(answers[widths <= 0.15e-3, 0], widths[widths <= 0.15e-3])
    found = np.gradient(np.log(answers[:, 0]), np.log(widths))
    np.testing.assert_allclose(answers[1:-1, 1], found[1:-1], atol=2e-3)


def test_rows_are_solved_like_a_full_matrix():
    rng = np.random.default_rng(5)
    kernel = line_kernel(kernel_family(CELLS, CELL, DEPTH), DEPTH, 0.3)
    strength, slope = np.zeros(EXPONENTIALS), np.zeros(EXPONENTIALS)
    strengths(kernel, 67e-6, strength, slope)
    teeth = tooth_kernel(unit_tooth(CELLS, CELLS * CELL, 4e-3), 3e-9, CELLS * CELL, 5.6e-12)
    matrix = fitted(67e-6) + tooth_matrix(teeth)
    own = np.diag(matrix) + rng.random(CELLS)
    np.fill_diagonal(matrix, own)
    rows = np.sort(rng.choice(CELLS, 120, replace=False))
    right = rng.random((CELLS, LANES))
    x = right.copy()
    room = np.zeros((CELLS, LANES)), np.zeros((CELLS, LANES))
    padded = np.append(rows, np.zeros(80, np.int64))
    found = RowMatrix(kernel.decay, strength, teeth.strength, teeth.decay, own)
    assert solve_rows(found, padded, 120, x, *room)
    np.testing.assert_allclose(matrix[np.ix_(rows, rows)] @ x[rows], right[rows], atol=1e-12)
    product, other = np.zeros(CELLS), np.zeros(CELLS)
    products(kernel.decay, strength, slope, right[:, 0].copy(), product, other)
    add_row_products(teeth.strength, teeth.decay, right[:, 0].copy(), product)
    np.testing.assert_allclose(product, matrix @ right[:, 0] - own * right[:, 0], atol=1e-12)
    assert not solve_rows(found._replace(diagonal=own - 30.0), padded, 120, x, *room)
