from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.drivetrain.drive import Drive
from siggen.drivetrain.excitation import (
    Excitation,
    InputSource,
    Unbalance,
    bearing_direction,
    shaft_directions,
    turning_sense,
)
from siggen.drivetrain.gear_stage import Bearing, GearStage
from siggen.drivetrain.structure import Structure, vector
from siggen.drivetrain.varying_drive import SpeedRamp, VaryingDrive
from siggen.mesh.mesh_tables import MeshTables
from siggen.motion.linear_motion import LinearMotion
from siggen.motion.response import Response, SampleGrid, response_of
from tests.dynamics.casing_stage import make_structure as casing
from tests.dynamics.conftest import BASE_RADIUS_1, BASE_RADIUS_2, make_stage
from tests.dynamics.trains import eight_dof

FS, SPEED = 51200.0, 32.0
MASS, STIFFNESS, DAMPING = 0.412, 0.412 * (2.0 * np.pi * 40.0) ** 2, 12.0


def single_mass(stage: GearStage) -> Structure:
    """Return a stage whose pinion shakes on soft bearings by itself: the mesh couples the rotations alone."""
    soft = replace(stage.pinion, bearing=Bearing(STIFFNESS, STIFFNESS, DAMPING, DAMPING))
    structure = eight_dof(replace(stage, pinion=soft))
    rotations = vector(structure.coordinates, {"theta_pinion": BASE_RADIUS_1, "theta_gear": -BASE_RADIUS_2})
    return replace(structure, meshes=(replace(structure.mesh, vector=rotations),))


def respond(structure: Structure, tables: MeshTables, drive: Drive, *sources: InputSource, samples: int) -> Response:
    excitation = Excitation(sources)
    motion = LinearMotion(
        structure, tables, torque_nm=60.0, mesh_damping_ratio=0.07, backlash_m=80e-6, step_s=1.0 / (4 * FS),
        input_vectors=excitation.vectors,
    )  # fmt: skip
    motion.transient_s = 3.0  # the soft bearings decay at 14.6/s
    return response_of(motion, drive, SampleGrid(FS, samples, 4), excitation=excitation)


def line(signal: np.ndarray, frequency_hz: float) -> complex:
    """Return the amplitude and phase of a line over whole periods."""
    return complex(2.0 * (signal * np.exp(-2j * np.pi * frequency_hz * np.arange(signal.size) / FS)).mean())


@pytest.mark.parametrize("speed_hz", [20.0, 40.0, 80.0], ids=["below", "at", "above"])
def test_unbalance_shakes_a_rotor_on_springs_as_in_closed_form(
    stage: GearStage, constant_tables: MeshTables, speed_hz: float
) -> None:
    structure, moment, phase = single_mass(stage), 2e-5, 0.7
    source = Unbalance(shaft_directions(structure, "pinion_bearing"), moment, 1.0, phase)
    response = respond(structure, constant_tables, Drive(speed_hz, 0.0), source, samples=25600)
    omega = 2.0 * np.pi * speed_hz
    closed = moment * omega**2 / (STIFFNESS - MASS * omega**2 + 1j * DAMPING * omega) * np.exp(1j * phase)
    found = {
        axis: line(response.acceleration_m_s2[f"pinion_bearing/{axis}"], speed_hz)
        for axis in ("horizontal", "vertical")
    }
    # Inputs linear over steps of 5 µs: (ω h)²/8 = 1e-6; the low-pass is flat to 1e-6 here.
    assert abs(found["horizontal"] + omega**2 * closed) < 1e-5 * abs(omega**2 * closed)
    # The rotor turns from horizontal to vertical, a quarter later.
    assert abs(found["vertical"] + omega**2 * closed * np.exp(-0.5j * np.pi)) < 1e-5 * abs(omega**2 * closed)


def test_unbalance_is_the_inertia_of_an_eccentric_mass_also_while_the_speed_changes(structure: Structure) -> None:
    drive = VaryingDrive(SpeedRamp(10.0, 50.0, 0.2), 0.4)
    source = Unbalance(shaft_directions(structure, "gear_bearing"), 2e-4, -18 / 47, 0.9)
    time, h = np.linspace(0.02, 0.18, 400), 1e-4

    def place(t: np.ndarray) -> np.ndarray:
        angle = -18 / 47 * drive.angle_rad(t) + 0.9
        return np.stack([np.cos(angle), np.sin(angle)], axis=1)

    second = (place(time + h) - 2.0 * place(time) + place(time - h)) / h**2
    # Differences of second order: (ω h)²/12 = 1e-5 of the force.
    expected = -2e-4 * second
    np.testing.assert_allclose(source.inputs(drive.turning(time)), expected, atol=3e-5 * np.abs(expected).max())


def test_shafts_turn_against_each_other_and_as_the_pitch_lines_move() -> None:
    # Grounded: the gear stands at +x of the pinion, whose pitch line moves along +y there. Casing: at -horizontal.
    for structure, pinion in ((eight_dof(make_stage()), 1.0), (casing(), -1.0)):
        assert turning_sense(structure, "pinion_bearing") == pinion
        assert turning_sense(structure, "gear_bearing") == -pinion


@pytest.mark.parametrize("place", ["pinion_bearing", "gear_bearing"])
@pytest.mark.parametrize("axis", ["vertical", "horizontal"])
def test_a_bearing_pushes_shaft_and_casing_apart_with_equal_forces(place: str, axis: str) -> None:
    structure = casing()
    direction = dict(zip(structure.coordinates, bearing_direction(structure, place, axis), strict=True))
    gear = place.removesuffix("_bearing")
    assert np.hypot(direction[f"x_{gear}"], direction[f"y_{gear}"]) == pytest.approx(1.0)
    for way in "xy":
        assert direction[f"{way}_{gear}"] + direction[f"{way}_casing"] == pytest.approx(0.0, abs=1e-12)
    along = shaft_directions(structure, place)
    np.testing.assert_allclose(along @ along.T, np.eye(2), atol=1e-12)
