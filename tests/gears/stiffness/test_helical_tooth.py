"""Twisted finite elements of a helical tooth: rigid motions, the limit of no helix, both hands, a known body."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest

SKIP = "the finite-element check needs the extra 'fem': pip install -e '.[fem]'"
pytest.importorskip("skfem", reason=SKIP)
pytest.importorskip("gmsh", reason=SKIP, exc_type=ImportError)

from siggen.mesh.stiffness_options import StiffnessOptions  # noqa: E402
from siggen.mesh.tooth_compliance import tooth_compliance  # noqa: E402
from tests.reference.finite_elements.calibration import ToothShape  # noqa: E402
from tests.reference.finite_elements.extruded_body import face_line  # noqa: E402
from tests.reference.finite_elements.helical_body import HelicalBody  # noqa: E402
from tests.reference.finite_elements.helical_tooth import helical_bench_pair, line_compliances, line_rolls  # noqa: E402
from tests.reference.finite_elements.tooth_mesh import tooth_mesh  # noqa: E402

pytestmark = pytest.mark.slow
GEAR = ToothShape(18, 2.0).gear()


def plane_values(basis, x, y):
    """Values of a vector field on the degrees of freedom: nodes and middles of edges."""
    values = np.zeros(basis.N)
    for dofs in (basis.nodal_dofs, basis.facet_dofs):
        values[dofs[0]], values[dofs[1]] = x(basis.doflocs[:, dofs[0]]), y(basis.doflocs[:, dofs[1]])
    return values


@pytest.mark.parametrize("motion", ["along the axis", "across it", "about an axis across it"])
def test_rigid_motions_need_no_forces_away_from_the_bore(motion: str) -> None:
    """In components that turn with the section a shift by (1, 0) is (cos τs, -sin τs), written here by hand."""
    twist, width = 0.05, 4.0
    body = HelicalBody(tooth_mesh(GEAR, np.array([[np.tan(radians(20.0))]]), 0.3), face_line(width, 0.5), twist)
    p, w = np.zeros((body.plane.N, 1, body.line.y.size)), np.zeros((body.axial.N, 1, body.line.y.size))
    at = body.axial.doflocs
    for i, s in enumerate(body.line.y):
        c, sine = np.cos(twist * s), np.sin(twist * s)
        if motion == "along the axis":
            w[:, 0, i] = 1.0
            continue
        far = s if motion == "about an axis across it" else 1.0
        p[:, 0, i] = plane_values(body.plane, lambda x, a=far * c: a + 0 * x[0], lambda x, b=-far * sine: b + 0 * x[0])
        if motion == "about an axis across it":  # u = (z, 0, -x) in space
            w[:, 0, i] = -(c * at[0] - sine * at[1])
    forces, axial = body._product((p[body.free], w[body.free_axial]))
    radius = np.hypot(*body.plane.doflocs[:, body.free])
    away, away_axial = radius > 0.8 * radius.max(), np.hypot(*at[:, body.free_axial]) > 0.8 * radius.max()
    # Against what the same size of motion costs where the bore holds it; quadratic elements across the face leave 1e-5.
    size = np.abs(forces).max() + np.abs(axial).max()
    assert np.abs(forces[away]).max() < 1e-4 * size
    assert np.abs(axial[away_axial]).max() < 1e-4 * size


def test_a_small_helix_is_a_spur_tooth_and_both_hands_are_alike() -> None:
    spur, near, right, left = (line_compliances(helical_bench_pair(h), "pinion")[0, 0] for h in (0.0, 1.0, 15.0, -15.0))
    # Measured 3e-4 at 1 degree: the square of its slope.
    assert near == pytest.approx(spur, rel=1e-3)
    assert left == pytest.approx(right, rel=1e-3)
    assert right > 1.05 * spur


@pytest.mark.parametrize("which", ["pinion", "gear"])
def test_a_tooth_and_its_body_are_those_of_finite_elements(which: str) -> None:
    """Of the spur tooth 1.7 and 3.5 % stand: mesh, and a face that is no plane stress; without the plate it is 34 %."""
    pair = helical_bench_pair(20.0)
    across = (np.arange(100) + 0.5) / 100 - 0.5
    found = tooth_compliance(pair, which, line_rolls(pair, which, across)[0], StiffnessOptions()).total.mean()
    expected = line_compliances(pair, which)[0, 0] / (pair.youngs_modulus_pa * pair.face_width_m)
    assert found == pytest.approx(expected, rel=0.05)
