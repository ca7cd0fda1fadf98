from __future__ import annotations

import numpy as np
import pytest

from siggen.drivetrain.drive import Drive
from siggen.drivetrain.structure import Structure
from siggen.mesh.mesh_tables import MeshTables
from siggen.motion.linear_motion import LinearMotion
from siggen.motion.response import Response, SampleGrid, Wanted, response_of

FS = 25600.0


def respond(
    structure: Structure, tables: MeshTables, samples: int = 2560, start_rad: float = 0.3, **changes
) -> Response:
    motion = LinearMotion(
        structure, tables, torque_nm=60.0, mesh_damping_ratio=0.07, backlash_m=80e-6, step_s=1.0 / (FS * 4)
    )
    return response_of(motion, Drive(30.0, start_rad), SampleGrid(FS, samples, 4), **changes)


def test_asking_for_history_changes_nothing_else(structure: Structure, ramp_tables: MeshTables) -> None:
    plain = respond(structure, ramp_tables, wanted=Wanted(internals=True))
    asked = respond(structure, ramp_tables, wanted=Wanted(internals=True), history_s=0.12)
    for name, values in plain.acceleration_m_s2.items():
        assert asked.acceleration_m_s2[name].tobytes() == values.tobytes()
        assert asked.history.acceleration_m_s2[name].size == 3072
        assert plain.history.acceleration_m_s2[name].size == 0
    for name, values in plain.bearing_force_n.items():
        assert asked.bearing_force_n[name].tobytes() == values.tobytes()
    for name, values in plain.internals.items():
        assert asked.internals[name].tobytes() == values.tobytes()
    assert asked.contact_loss_share == plain.contact_loss_share
    assert asked.tacho_s.tobytes() == plain.tacho_s.tobytes()


def test_history_and_record_are_one_motion(structure: Structure, ramp_tables: MeshTables) -> None:
    """A longer record that begins earlier, at the angle of that time, holds both."""
    asked = respond(structure, ramp_tables, history_s=0.05, settle_s=2.0)
    earlier = respond(structure, ramp_tables, 2560 + 1280, 0.3 - 2.0 * np.pi * 30.0 * 0.05, settle_s=2.0)
    for name, values in earlier.bearing_force_n.items():
        joined = np.concatenate([asked.history.bearing_force_n[name], asked.bearing_force_n[name]])
        # 2 s are tens of decay times: what is left of the two starts is below what the angles round to
        assert np.abs(joined - values).max() < 1e-6 * values.std()


def test_a_longer_settling_gives_more_history(structure: Structure, ramp_tables: MeshTables) -> None:
    settled = respond(structure, ramp_tables, settle_s=2.0, history_s=2.0)
    assert all(values.size == 51200 for values in settled.history.bearing_force_n.values())
    short = respond(structure, ramp_tables, history_s=20.0)
    sizes = {values.size for values in short.history.bearing_force_n.values()}
    assert len(sizes) == 1
    assert 0 < sizes.pop() < 20.0 * FS


@pytest.mark.parametrize("forces", [True, False])
def test_forces_that_are_not_asked_for_have_no_history(
    structure: Structure, ramp_tables: MeshTables, forces: bool
) -> None:
    response = respond(structure, ramp_tables, history_s=0.01, wanted=Wanted(bearing_forces=forces))
    assert bool(response.history.bearing_force_n) == forces
