from __future__ import annotations

import numpy as np
import pytest

from siggen.drivetrain.gear_stage import GearStage
from siggen.drivetrain.structure import Structure, vector
from tests.dynamics.trains import eight_dof


def rigid_rotation(structure: Structure) -> np.ndarray:
    """Return the motion of both shafts turning together without any deformation."""
    ratio = (
        -structure.mesh.vector[structure.coordinates.index("theta_pinion")]
        / structure.mesh.vector[structure.coordinates.index("theta_gear")]
    )
    turns = {"theta_motor": 1.0, "theta_pinion": 1.0, "theta_gear": ratio, "theta_load": ratio}
    return np.array([turns.get(name, 0.0) for name in structure.coordinates])


def test_rigid_rotation_deforms_nothing_and_torques_balance_on_it(stage: GearStage) -> None:
    structure = eight_dof(stage)
    rigid = rigid_rotation(structure)
    # A product of numbers of size 330 and 66 mm with rounded ratios: 1e-12 of the largest entry is rounding.
    assert np.abs(structure.stiffness @ rigid).max() < 1e-12 * np.abs(structure.stiffness).max()
    assert np.abs(structure.damping @ rigid).max() < 1e-12 * np.abs(structure.damping).max()
    assert abs(structure.mesh.vector @ rigid) < 1e-15
    assert abs(structure.torque_vector @ rigid) < 1e-14


def test_mesh_force_acts_along_the_line_of_action_with_the_base_radii(stage: GearStage) -> None:
    structure = eight_dof(stage)
    p = dict(zip(structure.coordinates, structure.mesh.vector, strict=True))
    assert p["x_pinion"] == -p["x_gear"] == pytest.approx(np.sin(stage.working_pressure_angle_rad))
    assert p["y_pinion"] == -p["y_gear"] == pytest.approx(np.cos(stage.working_pressure_angle_rad))
    radii = stage.pinion.base_radius_m, -stage.gear.base_radius_m
    assert (p["theta_pinion"], p["theta_gear"]) == pytest.approx(radii, rel=1e-14)


def test_unknown_coordinates_are_named() -> None:
    with pytest.raises(ValueError, match=r"theta_9.*allowed are a, b"):
        vector(("a", "b"), {"theta_9": 1.0})
