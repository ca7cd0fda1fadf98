"""Teeth that give way across the face: Green's function, its limits, and the pair against a full matrix."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.mesh.face_force import mean_width, own_law
from siggen.mesh.line_kernel import tooth_kernel, tooth_matrix, unit_tooth
from tests.gears.contact.faces import BENDING, KAPPA, REST, WIDTH, face, solve

LENGTH, COMPLIANCE = 4e-3, 3e-9


def test_the_kernel_is_greens_function_of_a_tooth_with_free_ends() -> None:
    cells, fine = 50, 40
    y = (np.arange(cells * fine) + 0.5) * WIDTH / (cells * fine)
    low, high = np.minimum(y[:, None], y) / LENGTH, np.maximum(y[:, None], y) / LENGTH
    face = WIDTH / LENGTH
    expected = face / cells * np.cosh(low) * np.cosh(face - high) / np.sinh(face)
    means = expected.reshape(cells, fine, cells, fine).mean(axis=(1, 3))
    found = tooth_matrix(unit_tooth(cells, WIDTH, LENGTH))
    # midpoints at the bend of the diagonal: 1/fine² of a cell's share
    np.testing.assert_allclose(found, means, atol=5e-5 * means.max())
    scaled = tooth_kernel(unit_tooth(cells, WIDTH, LENGTH), COMPLIANCE, WIDTH, KAPPA)
    np.testing.assert_allclose(tooth_matrix(scaled), COMPLIANCE * WIDTH / KAPPA * found, rtol=1e-12)


def test_the_pair_carries_as_a_full_matrix_of_line_and_teeth_does() -> None:
    lead = np.linspace(0.0, 40e-6, 200)
    slices = face(lead=lead, teeth=BENDING, rest=0.25 * REST)
    answer, loads = solve(slices, 14e-6, 0.2e-3)
    deflection = _line(slices, loads) + tooth_matrix(slices.teeth) @ loads
    wanted = 14e-6 + 0.2e-3 * slices.face_m - lead - 0.25 * REST * answer.force_n
    touching = loads > 0.0
    assert 0.1 < touching.mean() < 0.9
    np.testing.assert_allclose(deflection[touching], wanted[touching], atol=1e-13)
    assert (wanted[~touching] < deflection[~touching] + 1e-13).all()


def _line(slices, loads: np.ndarray) -> np.ndarray:
    """(K + β) u from the exponentials one by one, and what slices get by their own width."""
    from siggen.mesh.face_slices import contact_half_width
    from siggen.mesh.line_kernel import diagonal, strengths

    width, growth, _ = contact_half_width(slices, float(loads @ loads))
    strength, slope = np.zeros(5), np.zeros(5)
    strengths(slices.kernel, width, strength, slope)
    offset = np.abs(np.arange(loads.size)[:, None] - np.arange(loads.size))
    own, own_slope = diagonal(slices.kernel, width)
    matrix, change = ((values * slices.kernel.decay ** offset[..., None]).sum(axis=-1) for values in (strength, slope))
    np.fill_diagonal(matrix, own)
    np.fill_diagonal(change, own_slope)
    beta = 0.25 * growth * (loads @ change @ loads) / (loads @ loads)
    shared = mean_width(slices, float(loads @ loads))
    own_terms = [own_law(load, 1.0, shared)[0] * load if load > 0.0 else 0.0 for load in loads.tolist()]
    return np.asarray(matrix @ loads + beta * loads + own_terms)


def test_teeth_that_bend_give_way_to_a_tilt_and_shed_less_under_a_short_gap() -> None:
    stiff, soft = face(), face(teeth=BENDING, rest=0.25 * REST)
    one, two = (solve(s, 8e-6, 0.05e-3)[0] for s in (stiff, soft))
    assert two.force_n == pytest.approx(one.force_n, rel=0.02)
    assert two.tilting_n_m < 0.5 * one.tilting_n_m
    step = 1e-8
    for slices, answer in ((stiff, one), (soft, two)):
        ahead, behind = (solve(slices, 8e-6, 0.05e-3 + s)[0].moment_n_m for s in (step, -step))
        # the part of the curvature that an even load does not have is left out
        assert answer.tilting_n_m == pytest.approx((ahead - behind) / (2.0 * step), rel=0.02)
