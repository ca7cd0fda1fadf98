"""Responses of the linearised stage against a library's solver, and against the time integration of the same forces."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.drivetrain.drive import Drive, Turning
from siggen.drivetrain.excitation import Excitation, InputSource, bearing_direction
from siggen.drivetrain.forced_motion import TOGETHER, MeanMesh, forced_motion
from siggen.drivetrain.structure import locked_load
from siggen.mesh.mesh_force import mean_mesh_stiffness
from siggen.mesh.mesh_tables import MeshTables
from siggen.motion.linear_motion import LinearMotion
from siggen.motion.response import SampleGrid, response_of
from tests.dynamics.casing_stage import make_structure

FS = 51200.0
MOTIONS = ("pinion_bearing/vertical", "casing_lid/vertical", "gear_bearing/horizontal")


class HarmonicForce(InputSource):
    """A force that is a harmonic of the pinion's rotation."""

    def __init__(self, direction: np.ndarray, amplitude_n: float, order: float) -> None:
        self._vectors, self._amplitude, self._order = direction[None, :], amplitude_n, order

    @property
    def vectors(self) -> np.ndarray:
        return self._vectors

    def inputs(self, turning: Turning) -> np.ndarray:
        return (self._amplitude * np.cos(self._order * turning.angle_rad + 0.3))[:, None]


def test_responses_solve_the_equations_of_motion() -> None:
    structure, mesh = locked_load(make_structure()), MeanMesh(3e8, 800.0)
    rng = np.random.default_rng(3)
    directions, frequencies = rng.standard_normal((3, len(structure.coordinates))), np.array([0.0, 7.0, 540.0, 9000.0])
    found = forced_motion(structure, mesh, directions, MOTIONS, frequencies)
    p = structure.mesh.vector
    for k, omega in enumerate(2.0 * np.pi * frequencies):
        dynamic = structure.stiffness + 3e8 * np.outer(p, p) - omega**2 * structure.mass
        dynamic = dynamic + 1j * omega * (structure.damping + 800.0 * np.outer(p, p))
        q = np.linalg.solve(dynamic, directions.T)
        for name in MOTIONS:
            expected = -(omega**2) * structure.motions[name] @ q
            np.testing.assert_allclose(found.acceleration[name][:, k], expected, 1e-7)
        for name, (stiff, damped) in structure.bearing_forces.items():
            expected = (stiff + 1j * omega * damped) @ q
            np.testing.assert_allclose(found.bearing_force[name][:, k], expected, rtol=1e-7, atol=1e-9)


def test_readings_of_shafts_take_what_the_rotors_do_not() -> None:
    structure, hz = locked_load(make_structure()), np.array([3.0, 120.0, 900.0, 4000.0])
    omega, place = 2.0 * np.pi * hz, structure.coordinates.index("theta_motor")
    readings = ("angle/motor", "torque/input_coupling")
    pushed = np.array([structure.mesh.vector, structure.bearing_directions["pinion_bearing/vertical"]])
    angle, torque = forced_motion(structure, MeanMesh(3e8, 800.0), pushed, (), hz, readings).shaft.values()
    # nothing else acts on the motor, so its coupling takes what its inertia gives: J ω² θ
    np.testing.assert_allclose(torque, structure.mass[place, place] * omega**2 * angle, rtol=1e-6)


def test_a_model_has_the_readings_of_its_own_shafts() -> None:
    angles = {"angle/motor", "angle/pinion", "angle/gear", "angle/load"}
    assert set(make_structure().shaft_readings) == angles | {"torque/input_coupling", "torque/output_coupling"}


@pytest.mark.parametrize("name", ["mesh", "gear_bearing/vertical"])
def test_a_harmonic_force_moves_the_integrated_gearbox_as_the_response_says(
    constant_tables: MeshTables, name: str
) -> None:
    structure = locked_load(make_structure())
    direction = structure.mesh.vector if name == "mesh" else bearing_direction(structure, *name.split("/"))
    order, speed_hz, samples = 9.0, 32.0, 25600
    source = HarmonicForce(direction, 40.0, order)
    excitation = Excitation((source,))
    motion = LinearMotion(
        structure, constant_tables, torque_nm=60.0, mesh_damping_ratio=0.07, backlash_m=80e-6, step_s=1.0 / (4 * FS),
        input_vectors=excitation.vectors,
    )  # fmt: skip
    response = response_of(
        motion, Drive(speed_hz, 0.0), SampleGrid(FS, samples, 4), excitation=excitation, settle_s=3.0
    )
    stiffness = mean_mesh_stiffness(constant_tables)
    damping = 2.0 * 0.07 * np.sqrt(stiffness * structure.mesh.mass_kg)
    frequency = np.array([order * speed_hz])
    expected = forced_motion(structure, MeanMesh(stiffness, damping), direction[None, :], MOTIONS, frequency)
    turn = np.exp(-2j * np.pi * frequency * np.arange(samples) / FS)
    for place in MOTIONS:
        line = 2.0 * (response.acceleration_m_s2[place] * turn).mean()
        # inputs linear over 5 µs, and a low-pass that is flat to 1e-6 here
        assert line == pytest.approx(expected.acceleration[place][0, 0] * 40.0 * np.exp(0.3j), rel=1e-4)


def test_a_frequency_gets_the_same_response_among_many_as_alone() -> None:
    structure, mesh = locked_load(make_structure()), MeanMesh(3e8, 800.0)
    frequencies = np.concatenate([[0.0], np.geomspace(1.0, 12000.0, 2 * TOGETHER + 5)])
    directions = np.random.default_rng(4).standard_normal((3, len(structure.coordinates)))
    together = forced_motion(structure, mesh, directions, MOTIONS, frequencies)
    for k in (0, 1, TOGETHER - 1, TOGETHER, 2 * TOGETHER + 5):
        alone = forced_motion(structure, mesh, directions, MOTIONS, frequencies[k : k + 1])
        for name in MOTIONS:
            np.testing.assert_array_equal(together.acceleration[name][:, k], alone.acceleration[name][:, 0])
