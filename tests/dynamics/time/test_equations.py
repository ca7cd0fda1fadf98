from __future__ import annotations

import numpy as np
import pytest

from siggen.drivetrain.structure import Structure
from siggen.mesh.mesh_force import mesh_law, mesh_stiffness
from siggen.mesh.mesh_tables import MeshTables
from siggen.motion.equations import approach_of, equations_of_motion, start_state
from tests.dynamics.conftest import BASE_RADIUS_1
from tests.dynamics.integration_runs import FIRST_PITCHES, model, rate


@pytest.mark.parametrize("torque", [60.0, -25.0])
def test_static_force_and_approach_follow_from_the_torque(
    torque: float, structure: Structure, constant_tables: MeshTables
) -> None:
    law = mesh_law(constant_tables, 700.0, 80e-6)
    equations = equations_of_motion(structure, law, torque, 3.2e8)
    force = torque / BASE_RADIUS_1
    # The softest mode (38 Hz) and the mesh mode (7.8 kHz) differ by 4e4 in stiffness: 1e-16 becomes 1e-11.
    assert equations.static_force == pytest.approx(force, rel=1e-10)
    assert equations.static_approach == pytest.approx(force / 3.2e8 + np.sign(torque) * 40e-6, rel=1e-10)
    vertical = structure.coordinates.index("y_pinion")
    expected = -force * structure.mesh.vector[vertical] / structure.stiffness[vertical, vertical]
    assert equations.static_deflection[vertical] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("torque", [60.0, -25.0])
def test_the_start_is_an_equilibrium_at_the_actual_stiffness(
    torque: float, structure: Structure, sharp_tables: MeshTables
) -> None:
    equations, law, start = model(structure, sharp_tables, torque=torque)
    approach, approach_rate = approach_of(equations, 0, start)
    penetration = approach - np.sign(torque) * 40e-6
    assert mesh_stiffness(law, FIRST_PITCHES) * penetration == pytest.approx(torque / BASE_RADIUS_1, rel=1e-9)
    assert approach_rate == 0.0
    # At the mean stiffness instead the pinion's rotation would start with R_b1 times 5 % of 2 kN over J_1, 1e4 rad/s².
    assert np.abs(rate(equations, law, start, FIRST_PITCHES)).max() < 1e-3


def test_deviations_do_not_depend_on_the_twist_of_the_shafts(structure: Structure, constant_tables: MeshTables) -> None:
    equations, _, start = model(structure, constant_tables)
    assert abs(equations.static_deflection[0] - equations.static_deflection[3]) > 0.1
    assert np.abs(start).max() < 1e-12


def test_start_state_has_no_rigid_rotation(structure: Structure, sharp_tables: MeshTables) -> None:
    equations, law, _ = model(structure, sharp_tables)
    start = start_state(structure, law, equations, 12.7)
    ratio = 18.0 / 47.0
    rigid = np.array([1.0, 0.0, 0.0, 1.0, 0.0, 0.0, ratio, ratio])
    momentum = rigid @ structure.mass @ start[:8]
    # Modes of the structure reach over 4e4 in stiffness, so its rigid vector is known to about 1e-11.
    assert abs(momentum) < 1e-10 * np.abs(structure.mass @ start[:8]).max()
