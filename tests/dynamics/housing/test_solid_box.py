"""Solid finite elements of the benchmark: an element, and a box against its plates."""

import numpy as np
import pytest

from siggen.drivetrain.housing_modes import housing_modes
from tests.dynamics.housing.boxes import IRON, iron_box
from tests.reference.housing.solid_box import solid_box
from tests.reference.housing.solid_element import CORNERS, element_matrices
from tests.reference.housing.solid_mesh import solid_mesh


def test_a_distorted_element_passes_the_patch_test() -> None:
    rng = np.random.default_rng(0)
    corners = 0.5 * CORNERS * [2.0, 1.0, 0.2] + rng.uniform(-0.04, 0.04, (8, 3))
    stiffness, mass = (matrix[0] for matrix in element_matrices(corners[None], 1.0, 0.3, 2.0))
    gradient = np.array([[1.0, 0.3, -0.2], [0.1, -0.5, 0.4], [0.2, 0.0, 0.7]])
    strain = 0.5 * (gradient + gradient.T)
    shear, lame = 1.0 / 2.6, 0.3 / (1.3 * 0.4)
    density = 0.5 * (2.0 * shear * (strain**2).sum() + lame * np.trace(strain) ** 2)
    volume = mass.sum() / 3.0 / 2.0
    moved = (corners @ gradient.T).ravel()
    # Energy of an even strain is its density times the volume, whatever the element's shape.
    assert 0.5 * moved @ stiffness @ moved == pytest.approx(density * volume, rel=1e-6)
    assert np.linalg.eigvalsh(stiffness)[:6] == pytest.approx(0.0, abs=1e-12)


def test_a_thin_element_bends_without_locking() -> None:
    corners = 0.5 * CORNERS * [1.0, 1.0, 0.01]
    stiffness, _ = element_matrices(corners[None], 1.0, 0.0, 1.0)
    bent = np.stack([corners[:, 0] * corners[:, 2], np.zeros(8), np.zeros(8)], axis=1).ravel()
    # Without a Poisson ratio: E I κ²/2 with κ 1 per length.
    assert 0.5 * bent @ stiffness[0] @ bent == pytest.approx(0.5 * 0.01**3 / 12.0, rel=1e-9)


def test_the_mesh_has_the_boxs_mass_and_is_whole() -> None:
    box = iron_box()
    mesh = solid_mesh(box, 0.02)
    corners = mesh.nodes[mesh.elements]
    volumes = np.linalg.det(np.stack([corners[:, i] - corners[:, 0] for i in (1, 3, 4)], axis=1))
    assert (volumes > 0.0).all()
    _, mass = element_matrices(corners, 1.0, 0.3, IRON.density_kg_m3)
    assert mass.sum() / 3.0 == pytest.approx(box.mass_kg, rel=2e-3)


@pytest.mark.slow
def test_plates_have_the_lowest_modes_of_the_solid_box() -> None:
    box = iron_box()
    plates, solid = housing_modes(box, 3000.0).frequency_hz[:12], solid_box(box, 0.016, 12).frequency_hz
    # 16 mm elements are 1 % stiff; bosses are no thin plates.
    np.testing.assert_allclose(plates, solid, rtol=0.08)
