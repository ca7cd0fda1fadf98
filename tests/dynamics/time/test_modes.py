from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.drivetrain.structure import Structure
from siggen.mesh.mesh_tables import MeshTables
from siggen.motion.modes import slowest_decay_per_s
from tests.dynamics.conftest import make_stage
from tests.dynamics.integration_runs import model
from tests.dynamics.trains import eight_dof


def test_the_torsional_mode_of_the_soft_shafts_decays_slowest(
    structure: Structure, constant_tables: MeshTables
) -> None:
    equations, _, _ = model(structure, constant_tables)
    # Viscous shafts: decay = ω² c/(2 k) of the 38 Hz mode, whose strain energy is all in the shafts.
    expected = (2.0 * np.pi * 38.0) ** 2 * 0.231 / (2.0 * 330.0)
    assert slowest_decay_per_s(structure, equations, np.array([700.0])) == pytest.approx(expected, rel=0.02)


def test_modes_that_the_mesh_does_not_excite_are_left_out(constant_tables: MeshTables) -> None:
    # Isotropic bearings: motion across the line of action is never excited, so its missing damping does not matter.
    structure = eight_dof(make_stage())
    across = np.zeros(8)
    across[1], across[2] = structure.mesh.vector[2], -structure.mesh.vector[1]
    damping = structure.damping - 2134.0 * np.outer(across, across)
    bare = replace(structure, damping=damping)
    equations, _, _ = model(structure, constant_tables)
    bare_equations, _, _ = model(bare, constant_tables)
    decay = slowest_decay_per_s(bare, bare_equations, np.array([700.0]))
    assert decay == pytest.approx(slowest_decay_per_s(structure, equations, np.array([700.0])), rel=1e-6)


def test_an_undamped_structure_does_not_decay(undamped: Structure, constant_tables: MeshTables) -> None:
    equations, _, _ = model(undamped, constant_tables, damping=0.0)
    # Eigenvalues at 50000 rad/s are known to about 1e-12 of that.
    assert slowest_decay_per_s(undamped, equations, np.array([0.0])) < 1e-6
