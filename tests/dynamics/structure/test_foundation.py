"""A base under the bolts: its limit cases are the ground, a free mass, and the mass of all that stands on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.drivetrain.forced_motion import MeanMesh, forced_motion
from siggen.drivetrain.gear_stage import Base
from siggen.drivetrain.makers import on_base
from siggen.drivetrain.structure import assembled, locked_load
from tests.dynamics.casing_stage import make_casing, make_stage, make_structure
from tests.dynamics.trains import casing_structure, eight_dof

LID = "casing_lid/vertical"
MESH = MeanMesh(3e8, 800.0)
FREQUENCIES = np.array([20.0, 300.0, 2000.0])


def standing_on(base: Base):
    return locked_load(assembled(on_base(make_structure().drivetrain, base)))


def test_a_heavy_base_on_stiff_mounts_is_the_ground() -> None:
    ground, base = locked_load(make_structure()), standing_on(Base(2e9, 2e8, (900.0, 900.0, 900.0), 0.1))
    for structure in (ground, base):
        assert np.array_equal(structure.stiffness, structure.stiffness.T)
    direction = ground.mesh.vector[None, :]
    fixed = forced_motion(ground, MESH, direction, (LID,), FREQUENCIES).acceleration[LID]
    found = forced_motion(base, MESH, base.mesh.vector[None, :], (LID,), FREQUENCIES).acceleration[LID]
    np.testing.assert_allclose(found, fixed, rtol=1e-5)  # masses are 1e8 apart, mounts and bolts 1e7


def test_above_its_mounts_and_below_the_bolts_everything_moves_as_one_mass() -> None:
    base = standing_on(Base(100.0, 9.0, (2.0, 2.0, 2.0), 0.02))
    push = np.zeros((1, len(base.coordinates)))
    push[0, base.coordinates.index("y_base")] = 1.0
    found = forced_motion(base, MESH, push, ("pinion_bearing/vertical", "gear_bearing/vertical"), np.array([20.0]))
    at_centre = sum(
        row[0, 0] * share
        for row, share in zip(found.acceleration.values(), (1.0 - 0.04875 / 0.0975, 0.04875 / 0.0975), strict=True)
    )
    # 124 kg; 1 % below resonance correction of the mounts (2/20)², 1 % of the bolts
    assert abs(at_centre) == pytest.approx(1.0 / (100.0 + 20.0 + 4.0), rel=0.03)


def test_a_rigid_motion_of_gearbox_and_base_stretches_the_mounts_alone() -> None:
    base = standing_on(Base(100.0, 9.0, (10.0, 20.0, 30.0), 0.1))
    for first, together in (
        (("x_pinion", "x_gear", "x_casing"), "x_base"),
        (("y_pinion", "y_gear", "y_casing"), "y_base"),
    ):
        moved = np.array([1.0 if name in (*first, together) else 0.0 for name in base.coordinates])
        mount = 100.0 * (2.0 * np.pi * (10.0 if together == "x_base" else 20.0)) ** 2
        assert moved @ base.stiffness @ moved == pytest.approx(mount, rel=1e-6)


def test_the_lock_lets_the_whole_drive_swing_once_per_second_nearly_without_ringing() -> None:
    """Rigid teeth: all inertia on one spring, by the eigenvalues of the first order; shafts give 1e-3 of it."""
    stage = locked_load(make_structure())
    direction, size = stage.mesh.vector, len(stage.coordinates)
    stiffness = stage.stiffness + 1e9 * np.outer(direction, direction)
    inverse = np.linalg.inv(stage.mass)
    rates = np.block([[np.zeros((size, size)), np.eye(size)], [-inverse @ stiffness, -inverse @ stage.damping]])
    found = np.linalg.eigvals(rates)
    slowest = found[np.argmin(np.abs(found))]
    assert abs(slowest) / (2.0 * np.pi) == pytest.approx(1.0, rel=0.01)
    assert -slowest.real / abs(slowest) == pytest.approx(0.95, rel=0.01)


def test_a_bearing_that_ties_its_axes_pushes_across_and_takes_no_energy_by_it() -> None:
    """A force k x along y and k y along x: springs alone, so what is damped is what it was."""
    plain, tied = make_stage(), make_stage()
    bearing = replace(tied.pinion.bearing, stiffness_xy_n_per_m=4e7)
    tied = replace(tied, pinion=replace(tied.pinion, bearing=bearing))
    for made in (eight_dof, lambda stage: casing_structure(stage, make_casing())):
        one, other = (made(stage) for stage in (plain, tied))
        np.testing.assert_array_equal(one.damping, other.damping)
        rows = [one.coordinates.index(name) for name in ("x_pinion", "y_pinion")]
        assert other.damping[*rows] == pytest.approx(0.0, abs=1e-9 * other.damping[rows[0], rows[0]])
        added = (other.stiffness - one.stiffness)[np.ix_(rows, rows)]
        # whatever way the coordinates lie: softer along one diagonal by what it is stiffer along the other
        np.testing.assert_allclose(np.linalg.eigvalsh(added), [-4e7, 4e7], rtol=1e-9)
