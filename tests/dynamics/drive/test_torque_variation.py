from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from siggen.drivetrain.drive import Drive, Rotation
from siggen.drivetrain.excitation import Excitation, SpeedDeviation
from siggen.drivetrain.structure import Structure, rigid_rotation
from siggen.drivetrain.varying_drive import (
    Ripple,
    SpeedRamp,
    TorqueSettings,
    TorqueVariation,
    VaryingDrive,
    slow_variation,
)
from siggen.mesh.friction import constant_friction
from siggen.mesh.mesh_force import mean_mesh_stiffness
from siggen.mesh.mesh_tables import MeshTables
from siggen.mesh.pair_columns import FRICTION, POSITION, SLIDING
from siggen.motion.equations import state_rate
from siggen.motion.linear_motion import LinearMotion
from siggen.motion.pair_motion import MeanState, PairMesh, PairMotion
from siggen.motion.response import Response, SampleGrid, Wanted, response_of
from tests.dynamics.casing_stage import make_structure as casing
from tests.dynamics.pair_runs import TORQUE, law, tables

FS, STEPS = 51200.0, 4
STEP = 1.0 / (FS * STEPS)


def linear(
    structure: Structure, chosen: MeshTables, source: TorqueVariation | None = None, *, step_s: float = STEP,
    torque_nm: float = 60.0, backlash_m: float = 80e-6, integrator: str = "product",
) -> LinearMotion:  # fmt: skip
    return LinearMotion(
        structure, chosen, torque_nm=torque_nm, mesh_damping_ratio=0.07, backlash_m=backlash_m, step_s=step_s,
        integrator=integrator, input_vectors=None if source is None else source.vectors,
    )  # fmt: skip


def settings(seed: int = 0, **changes) -> TorqueSettings:
    rng = np.random.default_rng(seed)
    return replace(TorqueSettings(slow_variation(rng, 1.0, -7.0, 6.0), 0.03, 0.05, 0.4, 0.02, 50.0, 1.0), **changes)


def respond(motion: LinearMotion, drive: Rotation, source: TorqueVariation | None, samples: int, **flags) -> Response:
    excitation = None if source is None else Excitation((source,))
    return response_of(motion, drive, SampleGrid(FS, samples, STEPS), wanted=Wanted(**flags), excitation=excitation)


def run(motion, drive: Rotation, excitation: Excitation | None, steps: int, step_s: float, first_s: float = 0.0):
    """Return times, pitches, inputs and states of a run from the static start."""
    time = first_s + step_s * np.arange(steps + 1)
    pitches = drive.angle_rad(time) * (motion.teeth / (2.0 * np.pi))
    inputs = np.empty((time.size, 0)) if excitation is None else excitation.inputs(time, drive)
    states = np.empty((time.size, 2 * len(motion.structure.coordinates)))
    states[0] = motion.start(pitches[0])
    motion.advance(pitches, inputs, states)
    return time, pitches, inputs, states


def test_product_integration_of_inputs_linear_over_a_step_is_exact(
    structure: Structure, constant_tables: MeshTables
) -> None:
    source = TorqueVariation(structure, 60.0, TorqueSettings())
    motion = linear(structure, constant_tables, source, backlash_m=0.0)
    pitches = 0.3 + 540.0 * STEP * np.arange(301)
    inputs = np.random.default_rng(1).normal(0.0, 10.0, (301, 3))
    states = np.empty((301, 16))
    states[0] = motion.start(pitches[0])
    motion.advance(pitches, inputs, states)
    rates = linear(structure, constant_tables, source, backlash_m=0.0, step_s=STEP / 64, integrator="runge_kutta")
    fine = np.arange(300 * 64 + 1) / 64.0
    each = np.stack([np.interp(fine, np.arange(301), column) for column in inputs.T], axis=1)
    expected = np.empty((fine.size, 16))
    expected[0] = states[0]
    rates.advance(0.3 + 540.0 * STEP * fine, np.ascontiguousarray(each), expected)
    # Runge-Kutta steps of 76 ns on modes up to 8 kHz: (ω h)⁴/120 = 2e-12 per radian; rounding of 2e4 steps.
    scale = np.abs(expected).max(axis=0)
    assert (np.abs(states - expected[::64]).max(axis=0) / scale).max() < 1e-9


def test_integrators_agree_with_an_adaptive_solver_under_varying_torque(
    structure: Structure, ramp_tables: MeshTables
) -> None:
    source = TorqueVariation(structure, 60.0, settings(line_hz=400.0, line_ripple=0.3))
    drive = VaryingDrive(SpeedRamp(30.0, 33.0, 0.1), 0.3, Ripple(1e-3))
    excitation = Excitation((source,))
    coarse = linear(structure, ramp_tables, source)
    time, _, _, states = run(coarse, drive, excitation, 600, STEP)
    fine = linear(structure, ramp_tables, source, step_s=STEP / 8, integrator="runge_kutta")
    _, _, _, finer = run(fine, drive, excitation, 4800, STEP / 8)
    push = coarse.equations.external_input

    def rate(t: float, z: np.ndarray) -> np.ndarray:
        at, result = np.array([t]), np.empty_like(z)
        state_rate(coarse.equations, coarse._law, z, float(drive.angle_rad(at)[0]) * 18 / (2 * np.pi), result)
        result[8:] += excitation.inputs(at, drive)[0] @ push
        return result

    solution = solve_ivp(
        rate, (0.0, time[-1]), states[0], method="DOP853", t_eval=time[::10], rtol=1e-8, atol=1e-13, max_step=4 * STEP
    )
    for found in (states[::10], finer[::80]):
        error = np.sqrt(((found - solution.y.T) ** 2).mean(axis=0) / (solution.y.T**2).mean(axis=0))
        # The kinks of the tables cost the product steps 6e-5 at 4 steps per sample, the rest is the linear input.
        assert error.max() < 3e-4


def test_deviations_from_the_rotation_are_those_of_the_whole_motion(
    structure: Structure, constant_tables: MeshTables
) -> None:
    """Integrate absolute angles under the motor torque T + J dΩ/dt; nothing in that knows of a prescribed rotation."""
    source = TorqueVariation(structure, 60.0, TorqueSettings())
    drive = VaryingDrive(SpeedRamp(10.0, 50.0, 0.1), 0.0)
    motion = linear(structure, constant_tables, source, backlash_m=0.0)
    excitation = Excitation((source,))
    time, _, _, states = run(motion, drive, excitation, 12000, STEP, first_s=-0.03)
    rotation, p, torque = rigid_rotation(structure), structure.mesh.vector, structure.torque_vector
    stiffness = mean_mesh_stiffness(constant_tables)
    damping = 2.0 * 0.07 * np.sqrt(stiffness * structure.mesh.mass_kg)
    motor = (torque == 1.0).astype(float)
    k = structure.stiffness + stiffness * np.outer(p, p)
    c = structure.damping + damping * np.outer(p, p)

    def rate(t: float, z: np.ndarray) -> np.ndarray:
        accelerating = source.reduced_inertia_kg_m2 * drive.acceleration_rad_s2(np.array([t]))[0]
        force = torque * 60.0 + motor * accelerating - k @ z[:8] - c @ z[8:]
        return np.concatenate([z[8:], np.linalg.solve(structure.mass, force)])

    q = motion.equations.static_deflection + states[0, :8]
    first = np.concatenate(
        [q + rotation * drive.angle_rad(time[:1]), states[0, 8:] + rotation * drive.speed_rad_s(time[:1])]
    )
    solution = solve_ivp(
        rate,
        (time[0], time[-1]),
        first,
        method="DOP853",
        t_eval=time[::100],
        rtol=1e-11,
        atol=1e-13,
        max_step=STEP * 16,
    )
    expected = solution.y[:8].T - rotation * drive.angle_rad(time[::100])[:, None]
    found = motion.equations.static_deflection + states[::100, :8]
    # The adaptive solver's rigid angle of 20 rad is right to about 1e-10; twists of the shafts are 0.1 rad.
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-9)
    assert np.abs(np.ptp(found[:, 0] - found[:, 3])) > 0.01


def test_a_record_begins_without_a_shock(structure: Structure, ramp_tables: MeshTables) -> None:
    source = TorqueVariation(structure, 60.0, settings())
    drive = VaryingDrive(SpeedRamp(10.0, 50.0, 0.5), 0.3, Ripple(1e-3))
    usual, patient = linear(structure, ramp_tables, source), linear(structure, ramp_tables, source)
    patient.transient_s += 1.0
    first, second = (respond(motion, drive, source, 5120) for motion in (usual, patient))
    for place, values in first.acceleration_m_s2.items():
        expected = second.acceleration_m_s2[place]
        # Five decay times leave 7e-3 of the static start's error, itself a few percent of the static twist.
        assert np.sqrt(((values - expected) ** 2).mean() / (expected**2).mean()) < 1e-3


def test_light_load_with_a_pulsating_load_torque_rattles(structure: Structure, ramp_tables: MeshTables) -> None:
    def lost(load_once: float) -> float:
        source = TorqueVariation(structure, 2.0, TorqueSettings(load_once=load_once))
        motion = linear(structure, ramp_tables, source, torque_nm=2.0)
        response = respond(motion, Drive(30.0, 0.0), source, 25600)
        assert response.status == "ok"
        return response.contact_loss_share

    assert lost(0.0) == 0.0
    assert lost(3.0) > 0.01


def test_work_of_a_run_up_with_friction_becomes_kinetic_energy_and_losses() -> None:
    """Sum the power in absolute coordinates: motor less load = kinetic and elastic energy, dampers, teeth, friction."""
    structure, speed = casing(), 30.0
    source = TorqueVariation(structure, TORQUE, settings())
    nominal = 2.0 * np.pi * speed
    excitation = Excitation((SpeedDeviation(structure.coordinates, nominal), source))
    drive = VaryingDrive(SpeedRamp(15.0, 45.0, 0.25), 0.3, Ripple(1e-3))
    motion = PairMotion(
        structure, [PairMesh(law(friction=constant_friction(0.05)), mean_mesh_stiffness(tables()))], step_s=STEP / 2,
        mean=MeanState(TORQUE, speed),
        input_vectors=excitation.vectors, speed_input=0,
    )  # fmt: skip
    time, pitches, inputs, states = run(motion, drive, excitation, 60000, STEP / 2)
    n, rotation = len(structure.coordinates), rigid_rotation(structure)
    omega = drive.speed_rad_s(time)
    whole, rate = states[:, n:] + omega[:, None] * rotation, states[:, n:]
    q = states[:, :n] + motion.equations.static_deflection
    # Forces that act on the bodies, as opposed to the equations' inputs, which contain inertia: M r dΩ/dt is no force.
    load, relief = structure.coordinates.index("theta_load"), motion.load_relief_nm
    forces = structure.torque_vector * TORQUE + inputs @ motion_vectors(structure, excitation)
    forces[:, load] += relief
    forces += (structure.mass @ rotation) * rigid_push(structure, source, inputs, drive, time)[:, None]
    given = integral((forces * whole).sum(axis=1), time)
    values = dict(zip(motion.internal_names, motion.internals(states, pitches, inputs).T, strict=True))
    (table,) = motion.pairs(states, pitches, inputs)
    # What the drive gives against friction that the load is not relieved of.
    friction, arms = table[:, :, FRICTION], structure.mesh.sliding @ rotation
    taken = ((arms[0] + arms[1] * table[:, :, POSITION]) * friction).sum(axis=1) - rotation[load] * relief
    given += integral(omega * taken, time)
    teeth = integral(values["mesh_force_n"] * values["approach_rate_m_s"], time)
    rubbed = integral((table[:, :, FRICTION] * table[:, :, SLIDING]).sum(axis=1), time)
    dampers = integral(np.einsum("ti,ij,tj->t", rate, structure.damping, rate), time)
    kinetic = 0.5 * np.einsum("ti,ij,tj->t", whole, structure.mass, whole)
    elastic = 0.5 * np.einsum("ti,ij,tj->t", q, structure.stiffness, q)
    stored = (kinetic + elastic)[-1] - (kinetic + elastic)[0]
    assert stored > 50.0  # J: the train is three times as fast at the end
    assert rubbed > 1.0
    # The trapezoidal rule over force steps of the dampers of 1 % at 2.4 µs.
    assert given == pytest.approx(stored + teeth + rubbed + dampers, abs=1e-4 * rubbed)


def motion_vectors(structure: Structure, excitation: Excitation) -> np.ndarray:
    """Return the vectors of the torques as forces on bodies: each of its own body alone, no inertia."""
    torque, coordinates = structure.torque_vector, structure.coordinates
    own = np.zeros_like(excitation.vectors)
    own[1] = torque
    own[2, coordinates.index("theta_load")] = 1.0
    own[3, coordinates.index("theta_motor")] = 1.0
    return own


def rigid_push(
    structure: Structure, source: TorqueVariation, inputs: np.ndarray, drive: Rotation, time: np.ndarray
) -> np.ndarray:
    """Return the acceleration [rad/s²] that load ripple and motor ripple would give the train; held by the drive."""
    gear = rigid_rotation(structure)[structure.coordinates.index("theta_load")]
    accelerating = source.reduced_inertia_kg_m2 * drive.acceleration_rad_s2(time)
    return -(inputs[:, 2] * gear + inputs[:, 3] - accelerating) / source.reduced_inertia_kg_m2


def integral(values: np.ndarray, time: np.ndarray) -> float:
    return float(np.trapezoid(values, time))
