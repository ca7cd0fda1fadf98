"""The gear stage of paper A's kind and synthetic tables, as fixtures."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.drivetrain.gear_stage import Bearing, Coupling, GearStage, Rotor
from siggen.drivetrain.structure import Structure
from siggen.mesh.mesh_tables import MeshTables
from tests.dynamics.trains import eight_dof

PRESSURE_ANGLE = np.radians(20.0)
BASE_RADIUS_1 = 0.5 * 3.5e-3 * 18 * np.cos(PRESSURE_ANGLE)
BASE_RADIUS_2 = 0.5 * 3.5e-3 * 47 * np.cos(PRESSURE_ANGLE)
BASE_PITCH = 2.0 * np.pi * BASE_RADIUS_1 / 18
CONTACT_RATIO = 1.64


def make_stage(bearing_damping: float = 2134.0, shaft_damping: float = 0.231) -> GearStage:
    bearing = Bearing(8.5364e7, 8.5364e7, bearing_damping, bearing_damping)
    shaft = Coupling(330.0, shaft_damping)
    return GearStage(
        working_pressure_angle_rad=PRESSURE_ANGLE,
        pinion=Rotor(BASE_RADIUS_1, 0.412, 2.37e-4, bearing),
        gear=Rotor(BASE_RADIUS_2, 3.14, 1.125e-2, bearing),
        motor_inertia_kg_m2=0.016107,
        load_inertia_kg_m2=0.005153,
        input_coupling=shaft,
        output_coupling=shaft,
    )


def make_tables(rows: np.ndarray, faulty_tooth: int | None = None, contact_ratio: float = CONTACT_RATIO) -> MeshTables:
    """Return tables with these rows; row 1 belongs to one pinion tooth."""
    table_of_pair = np.zeros((18, 47), dtype=np.int32)
    if faulty_tooth is not None:
        table_of_pair[faulty_tooth] = 1
    length = contact_ratio * BASE_PITCH
    step = length / (rows.shape[1] - 1)
    return MeshTables(0.0, length, step, BASE_PITCH, np.array(rows), table_of_pair)


def arched_row(points: int) -> np.ndarray:
    """Return a pair stiffness as of involute teeth: highest in the middle of the engagement."""
    place = np.linspace(0.0, 1.0, points)
    return 2.0e8 * (0.85 + 0.6 * place * (1.0 - place))


@pytest.fixture(scope="session")
def stage() -> GearStage:
    return make_stage()


@pytest.fixture(scope="session")
def structure(stage: GearStage) -> Structure:
    return eight_dof(stage)


@pytest.fixture(scope="session")
def undamped() -> Structure:
    return eight_dof(make_stage(bearing_damping=0.0, shaft_damping=0.0))


@pytest.fixture(scope="session")
def constant_tables() -> MeshTables:
    """Mesh stiffness 3.2e8 N/m at every angle: exactly two base pitches of contact of one stiffness each."""
    return make_tables(np.full((1, 65), 1.6e8), contact_ratio=2.0)


@pytest.fixture(scope="session")
def sharp_tables() -> MeshTables:
    """Pairs that enter and leave with their full stiffness; pinion tooth 3 has a dip of 10 %."""
    row = arched_row(2049)
    place = np.linspace(0.0, 1.0, 2049)
    return make_tables(np.array([row, row * np.where((place > 0.4) & (place < 0.55), 0.9, 1.0)]), faulty_tooth=3)


@pytest.fixture(scope="session")
def ramp_tables() -> MeshTables:
    """Pairs whose stiffness rises and falls over 4 % of a pitch."""
    row = arched_row(42)
    row[[0, -1]] = 1.0
    return make_tables(row[None, :])
