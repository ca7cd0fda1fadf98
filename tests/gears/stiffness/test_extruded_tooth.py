"""Extruded finite elements of a tooth: plane limits, torsion, tetrahedra of another assembly; a pair with contact."""

from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest

SKIP = "the finite-element check needs the extra 'fem': pip install -e '.[fem]'"
pytest.importorskip("skfem", reason=SKIP)
pytest.importorskip("gmsh", reason=SKIP, exc_type=ImportError)

from siggen.mesh.body_coupling import ring_torsion  # noqa: E402
from tests.reference.contact.face_contact import FaceCase, approach_at, land_of_gap  # noqa: E402
from tests.reference.finite_elements.calibration import ToothShape  # noqa: E402
from tests.reference.finite_elements.extruded_body import ExtrudedBody, face_line  # noqa: E402
from tests.reference.finite_elements.face_compliance import face_compliance, load_on, tilt_load  # noqa: E402
from tests.reference.finite_elements.face_kernel import rule_errors  # noqa: E402
from tests.reference.finite_elements.face_losses import KINDS, loss  # noqa: E402
from tests.reference.finite_elements.resolved_contact import STRAIN, resolved_pair  # noqa: E402
from tests.reference.finite_elements.single_pair import library, small_pair  # noqa: E402
from tests.reference.finite_elements.spatial_pair import spatial_pair  # noqa: E402
from tests.reference.finite_elements.tooth_compliance_fem import (  # noqa: E402
    lines_of_action,
    nodal_functionals,
    tooth_compliance,
)
from tests.reference.finite_elements.tooth_mesh import tooth_mesh  # noqa: E402

pytestmark = pytest.mark.slow
GEAR = ToothShape(18, 2.0).gear()
ROLL = np.array([np.tan(radians(20.0))])


def test_uniform_load_tends_to_plane_stress_on_narrow_and_to_plane_strain_on_wide_faces():
    stress, strain = (tooth_compliance(GEAR, ROLL, p, 0.2)[0] for p in (None, STRAIN))
    widths = ((0.02, 1.0), (6.0, 1.0), (20.0, 2.0), (40.0, 2.0))
    narrow, middle, half, wide = (face_compliance(GEAR, ROLL, b, 0.2, e, 1).uniform[0] for b, e in widths)
    # Measured 4e-4 on this mesh: the thickness strain of plane stress jumps from element to element, ours does not.
    assert narrow == pytest.approx(stress, rel=1e-3)
    # The two ends are worth 1/b; measured 2e-4 without them.
    assert 2.0 * wide - half == pytest.approx(strain, rel=1e-3)
    assert strain < wide < half < middle < stress


def test_mean_twist_of_the_body_is_exact_wherever_across_the_face_the_load_stands():
    """Averaged over a cylinder in the body, the tangential displacement is that of a twisted ring."""
    width, radius = 4.0, 0.5 * (GEAR.bore_radius_m + GEAR.root_radius_m)
    mesh = tooth_mesh(GEAR, ROLL[None, :], 0.05)
    _, way = lines_of_action(GEAR, ROLL[None, :])
    body = ExtrudedBody(mesh, face_line(width, 1.0))
    push = nodal_functionals(body.plane, mesh.load_points.reshape(-1, 2), way.reshape(-1, 2)).toarray().T
    loads = [body.line.load(q) for q in (lambda y: np.ones_like(y) / width, lambda y: 2 * y / width**2)]
    u = body.displacements(np.repeat(push, 2, axis=1), np.column_stack(loads))
    # quadratic elements: mean over the face by the line's own weights
    mean = u @ body.line.load(lambda y: np.ones_like(y) / width)
    angle = np.arange(360) * 2 * pi / 360
    probes = body.plane.probes(radius * np.array([np.sin(angle), np.cos(angle)]))
    x, y = (probes @ mean).reshape(2, 360, 2)
    twist = (-x * np.cos(angle)[:, None] + y * np.sin(angle)[:, None]).mean(axis=0)
    exact = GEAR.base_radius_m * radius * (GEAR.bore_radius_m**-2 - radius**-2) / (4 * pi / 2.6) / width
    # Measured 6e-4, falling with the square of the edges: the polygons of bore and elements.
    np.testing.assert_allclose(twist, exact, rtol=1.5e-3)


def test_tilt_compliance_is_that_of_quadratic_tetrahedra_of_another_assembly():
    from scipy.sparse.linalg import splu
    from skfem import Basis, ElementTetP2, ElementVector, MeshTet
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    width, size, layers = 3.0, 0.3, 8
    crossing, way = lines_of_action(GEAR, ROLL[None, :])
    mesh = tooth_mesh(GEAR, ROLL[None, :], size)
    count, heights = mesh.points.shape[1], np.linspace(0.0, width, layers + 1)
    points = np.vstack([np.tile(mesh.points, layers + 1), np.repeat(heights, count)])
    low = np.sort(mesh.triangles, axis=0)
    # Each prism is cut along its vertices' order, so that neighbours agree on the diagonals.
    cuts = np.hstack([np.vstack([low[: i + 1] + count, low[i:]]) for i in range(3)])
    tets = np.hstack([cuts + layer * count for layer in range(layers)])
    basis = Basis(MeshTet(points, tets), ElementVector(ElementTetP2()))
    stiffness = linear_elasticity(*lame_parameters(1.0, 0.3)).assemble(basis)
    fixed = basis.get_dofs(lambda p: np.hypot(p[0], p[1]) < mesh.bore_radius * (1 + 1e-9)).all()
    free = np.setdiff1d(np.arange(basis.N), fixed)
    spots = np.linspace(0.0, width, 2 * layers + 1)
    simpson = np.tile([2.0, 4.0], layers + 1)[: spots.size] * width / layers / 6
    simpson[[0, -1]] /= 2
    load = np.zeros(basis.N)
    at = mesh.load_points[0, 0]
    for spot, weight in zip(spots, simpson * (2 * spots / width - 1) / width, strict=True):
        dofs = np.flatnonzero(np.abs(basis.doflocs - np.append(at, spot)[:, None]).max(axis=0) < 1e-9)
        load[dofs] = weight * np.append(way[0, 0], 0.0)
    answer = np.zeros(basis.N)
    answer[free] = splu(stiffness[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A").solve(load[free])
    inside = np.clip(spots, 1e-6, width - 1e-6)
    read = basis.probes(np.vstack([np.repeat(crossing[0, 0][:, None], spots.size, axis=1), inside]))
    along = (read @ answer).reshape(3, -1)[:2].T @ way[0, 0]
    tetrahedra = float(simpson @ (along * (2 * spots / width - 1)))
    body = face_compliance(GEAR, ROLL, width, size, 0.4, 10)
    ours = tilt_load(10) @ body.modes[0] @ tilt_load(10)
    # Two meshes of 0.3 modules: measured 0.14 %.
    assert ours == pytest.approx(tetrahedra, rel=1e-2)


def test_rigid_ring_torsion_and_one_length_hold_for_a_gear_that_was_not_fitted():
    gear = ToothShape(30, 2.5).gear()
    mate = ToothShape(30, 2.5).gear()
    roll = np.array([0.5, 0.9]) * gear.tip_roll_rad
    face = face_compliance(gear, roll, 7.0, 0.2, 0.6, 10)
    twist = np.full(2, ring_torsion(mate, 0.3))
    # Two teeth loaded low and high, as a pair is.
    errors = rule_errors(face.modes.sum(axis=0), face.uniform, twist, 7.0)
    # The goal is 10 % of tilt and part-face loads; measured 3.4 %.
    assert np.abs(errors).max() < 0.10
    assert face.under(load_on(0.0, 0.2, 10))[0] > 1.5 * face.uniform[0]


def test_rigid_teeth_only_add_to_the_approach_of_the_contact():
    case = FaceCase(cell_m=0.4e-3)
    land = land_of_gap(case, 0.5)
    contact, line = approach_at(case, land, 1200.0, 4.0)
    pair = spatial_pair(case, np.full((land.size, land.size), 4e-9), land, np.zeros(land.size), 1200.0)
    assert pair.approach_m == pytest.approx(contact + 4.8e-6, rel=1e-6)
    # Both gradients stop at 1e-8 of the force.
    np.testing.assert_allclose(pair.line_load, line, rtol=1e-5, atol=1e-4 * line.max())


def test_rule_meets_the_losses_of_spalls_on_part_of_the_face():
    for share, start in ((0.5, None), (0.3, 0.0)):
        rigid, spatial, rule = (loss(kind, share, start, 0.2e-3) for kind in KINDS)
        # The goal is 10 % of the loss; measured 5 % in the middle and 3 % at one end.
        assert rule == pytest.approx(spatial, rel=0.10)
        assert rigid < 0.75 * spatial


def test_pair_stiffness_meets_finite_elements_with_the_contact_resolved():
    pair = small_pair()
    pitch = pair.line_of_action_m * 17 / 60
    for load in (100e3, 300e3):
        plane = resolved_pair(pair, pitch, load, STRAIN, 10, 0.12)
        ours = library(pair, np.array([pitch]), load)[0]
        # Plane strain is the stiff bound of a face; the goal of 5 % holds against it already (measured -3 %).
        assert ours == pytest.approx(206.0 / plane.total, rel=0.05)
        assert plane.total > plane.teeth + 2.0
