from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from siggen.drivetrain.drive import Drive
from siggen.drivetrain.structure import rigid_rotation
from siggen.gears.missing_material import MissingMaterial, missing_material
from siggen.mesh.friction import constant_friction
from siggen.mesh.pair_columns import FLANK, FRICTION, POSITION, SLIDING
from siggen.motion.equations import no_inputs
from siggen.motion.linear_motion import LinearMotion
from siggen.motion.response import Response, SampleGrid, Wanted, response_of
from tests.dynamics.casing_stage import make_stage, make_structure, torsional
from tests.dynamics.pair_runs import (
    MESHES,
    RELIEF,
    TORQUE,
    columns,
    gear_pair,
    law,
    motion,
    settled,
    tables,
)
from tests.dynamics.trains import eight_dof

FORCE = TORQUE / (0.5 * 3e-3 * 18 * np.cos(np.radians(20.0)))
STEPS_PER_MESH = 400


def exact() -> MissingMaterial:
    return missing_material(gear_pair(), None, corner_contact=False)


def corners() -> MissingMaterial:
    return missing_material(gear_pair(), None)


def parabolic_corners() -> MissingMaterial:
    """Return corner gaps as the parabolas 70 Δs² before and 24 Δs² after the path of contact [m]."""
    pair, missing = gear_pair(), corners()
    position = np.linspace(missing.start_m, missing.end_m, missing.pinion.profile_m.shape[1])
    before, after = pair.contact_start_m - position, position - pair.contact_end_m
    return replace(
        missing,
        pinion=replace(missing.pinion, profile_m=24.0 * np.maximum(after, 0.0)[None] ** 2),
        gear=replace(missing.gear, profile_m=70.0 * np.maximum(before, 0.0)[None] ** 2),
    )


def whole_meshes(run_of, meshes: int, speed_hz: float = 30.0, settle_s: float = 0.4):
    """Return the motion, its angles and its states over whole meshes, the end left out; steps of 5 µs at most."""
    steps = max(60, round(STEPS_PER_MESH * 30.0 / speed_hz))
    step = 1.0 / (MESHES * speed_hz * steps)
    run = run_of(step)
    pitches, states = settled(run, speed_hz, step, meshes * steps, settle_s)
    return run, pitches[:-1], states[:-1]


@pytest.mark.parametrize(("speed", "low", "high"), [(2.0, 1164.0, 1218.0), (30.0, 697.0, 1604.0)])
def test_corner_contact_alone_makes_the_mesh_force_of_an_independent_computation(
    speed: float, low: float, high: float
) -> None:
    chosen = law(parabolic_corners())
    run, pitches, states = whole_meshes(
        lambda step: motion(make_structure(), chosen, speed_hz=speed, step_s=step), 3, speed
    )
    force = columns(run, states, pitches)["mesh_force_n"]
    # Its teeth have a root of another form: mean stiffness 3.14e8 instead of 3.17e8 N/m, hence 1 % of the swing.
    assert force.min() == pytest.approx(low, abs=0.01 * (high - low) + 0.5)
    assert force.max() == pytest.approx(high, abs=0.01 * (high - low) + 0.5)
    assert force.mean() == pytest.approx(FORCE, rel=1e-4)


def test_only_relief_or_corners_let_the_ripple_vanish_with_the_speed() -> None:
    swings = {}
    for name, missing in (("sharp", exact()), ("relief", missing_material(gear_pair(), RELIEF)), ("corner", corners())):
        for speed in (0.5, 2.0):
            run, pitches, states = whole_meshes(
                lambda step, speed=speed, missing=missing: motion(
                    make_structure(), law(missing), speed_hz=speed, step_s=step
                ), 1, speed,
            )  # fmt: skip
            swings[name, speed] = np.ptp(columns(run, states, pitches)["mesh_force_n"])
    assert swings["relief", 0.5] < swings["relief", 2.0] < 0.02 * FORCE
    assert swings["corner", 0.5] < swings["corner", 2.0] < 0.06 * FORCE
    # A pair that enters with its full stiffness is loaded by the whole deflection at once: 1.7 times the force.
    assert min(swings["sharp", 0.5], swings["sharp", 2.0]) > 0.6 * FORCE


@pytest.mark.parametrize("coefficient", [0.0, 0.05])
def test_power_is_balanced(coefficient: float) -> None:
    structure = make_structure()
    chosen = law(friction=constant_friction(coefficient))
    run, pitches, states = whole_meshes(lambda step: motion(structure, chosen, step_s=step), 18, settle_s=3.0)
    names, n = structure.coordinates, len(structure.coordinates)
    inner = columns(run, states, pitches)
    velocity = dict(zip(names, states[:, n:].T, strict=True))
    omega = 2.0 * np.pi * 30.0
    p_in = (TORQUE * (omega + velocity["theta_motor"])).mean()
    p_out = ((TORQUE * 47.0 / 18.0 - run.load_relief_nm) * (omega * 18.0 / 47.0 + velocity["theta_load"])).mean()
    pairs = run.pairs(states, pitches)[0]
    # what the load is not relieved of, which keeps the train turning as a whole, on bodies by their inertia
    arms = structure.mesh.sliding @ rigid_rotation(structure)
    p_drive = omega * ((arms[0] + arms[1] * pairs[:, :, POSITION]) * pairs[:, :, FRICTION]).sum(axis=1).mean()
    p_drive -= run.load_relief_nm * omega * 18.0 / 47.0
    p_friction = (pairs[:, :, FRICTION] * pairs[:, :, SLIDING]).sum(axis=1).mean()
    assert abs(p_drive) <= 0.02 * p_friction
    p_mesh = (inner["mesh_force_n"] * inner["approach_rate_m_s"]).mean()
    moved = np.gradient(inner["approach_m"], np.diff(pitches).mean() / (30.0 * 18.0))[1:-1]
    rate = inner["approach_rate_m_s"][1:-1]
    # differences over two steps of 5 µs follow a vibration of 5 kHz to 4e-3
    assert np.abs(moved - rate).max() < 1e-2 * np.abs(rate).max()
    p_dampers = np.einsum("ti,ij,tj->t", states[:, n:], structure.damping, states[:, n:]).mean()
    assert p_in == pytest.approx(5655.0, abs=1.0)
    assert abs(p_in + p_drive - p_out - p_friction - p_mesh - p_dampers) < 0.002
    if coefficient:
        # Loss factor of the textbook with equal sharing, 0.171 μ P; relief keeps the load near the pitch point.
        assert p_friction == pytest.approx(0.171 * 0.05 * 5655.0, rel=0.25)
        assert abs(velocity["theta_pinion"].mean()) < 1e-6
    else:
        assert p_friction == 0.0


def test_a_perfect_pair_of_gears_makes_only_mesh_harmonics() -> None:
    run, _, states = whole_meshes(
        lambda step: motion(make_structure(), law(friction=constant_friction(0.05)), step_s=step),
        18,
        settle_s=4.0,
    )
    n = len(run.structure.coordinates)
    for name in ("y_casing", "phi_casing", "x_pinion"):
        line = np.abs(np.fft.rfft(states[:, n + run.structure.coordinates.index(name)]))[: 18 * 12]
        others = np.ones(len(line), dtype=bool)
        others[::18] = False
        # What is left is the end of the locked load's slow motion, e^-24 of its 0.1 rad/s.
        assert line[others].max() < 1e-6 * line[18], name


def test_without_missing_material_and_mesh_damping_it_is_the_linear_law() -> None:
    structure, step = eight_dof(make_stage()), 1.0 / 204800
    pairs = motion(structure, law(exact(), damping_ratio=0.0, backlash_m=0.0), step_s=step)
    linear = LinearMotion(
        structure, tables(), torque_nm=TORQUE, mesh_damping_ratio=0.0, backlash_m=0.0, step_s=step,
        integrator="runge_kutta",
    )  # fmt: skip
    pitches = 0.3 + 540.0 * step * np.arange(4001)
    trajectories = []
    for run in (pairs, linear):
        states = np.empty((4001, 16))
        states[0] = run.start(pitches[0])
        run.advance(pitches, no_inputs(pitches), states)
        trajectories.append(states)
    first, second = trajectories
    # Rounding of forces of 1e3 N over 4000 steps; both laws jump at the same angles. Free rotation is left out.
    for i, name in enumerate(structure.coordinates):
        if name[0] in "xy":
            np.testing.assert_allclose(first[:, i], second[:, i], atol=1e-8 * np.abs(second[:, i]).max())


def test_agrees_with_an_adaptive_solver() -> None:
    chosen, coarse, samples = law(friction=constant_friction(0.05)), 1.0 / 204800, 1200
    times, errors = coarse * np.arange(samples + 1), []
    run = motion(make_structure(), chosen)
    solution = solve_ivp(
        lambda t, z: run.rate(z, 0.3 + 540.0 * t), (0.0, times[-1]), run.start(0.3), method="DOP853",
        t_eval=times, rtol=1e-9, atol=1e-13, max_step=coarse / 2,
    )  # fmt: skip
    for divided in (1, 8):
        run = motion(make_structure(), chosen, step_s=coarse / divided)
        states = np.empty((samples * divided + 1, 22))
        states[0] = run.start(0.3)
        pitches = 0.3 + 540.0 * coarse / divided * np.arange(samples * divided + 1)
        run.advance(pitches, no_inputs(pitches), states)
        difference = states[::divided, 11:] - solution.y[11:].T
        errors.append(np.sqrt((difference**2).mean(axis=0) / (solution.y[11:] ** 2).mean(axis=1)).max())
    # The damper's share of the force steps where a pair touches, so the error falls with the first power of the step.
    assert errors[0] < 1e-3
    assert errors[1] < errors[0] / 4.0


def casing_response(steps: int, **changes) -> Response:
    run = motion(make_structure(), law(corners()), step_s=1.0 / (51200 * steps), **changes)
    return response_of(run, Drive(30.0, 0.3), SampleGrid(51200.0, 5120, steps), wanted=Wanted(internals=True))


def test_bearing_forces_and_internals_are_those_of_the_mesh() -> None:
    response = casing_response(4)
    assert response.status == "ok"
    assert response.contact_loss_share == 0.0
    sine, cosine = np.sin(np.radians(20.0)), np.cos(np.radians(20.0))
    # 0.1 s are 54 meshes; the filter's aliases leave 1e-5.
    assert response.bearing_force_n["pinion_bearing/vertical"].mean() == pytest.approx(-FORCE * cosine, rel=1e-4)
    assert response.bearing_force_n["gear_bearing/horizontal"].mean() == pytest.approx(-FORCE * sine, rel=1e-4)
    inner = response.internals
    total = sum(inner[f"pair_{slot}_force_n"] for slot in range(2))
    np.testing.assert_allclose(total, inner["mesh_force_n"], rtol=1e-12)
    assert {"x_casing_m", "y_casing_m", "phi_casing_rad", "friction_moment_pinion_nm"} <= inner.keys()


def test_lost_contact_leaves_the_mean_force() -> None:
    run, pitches, states = whole_meshes(
        lambda step: motion(torsional(make_stage()), law(exact(), damping_ratio=0.01), speed_hz=340.0, torque_nm=5.0,
                            step_s=step), 180, 340.0)  # fmt: skip
    force = columns(run, states, pitches)["mesh_force_n"]
    apart = (run.pairs(states, pitches)[0][:, :, FLANK] == 0.0).all(axis=1)
    assert 0.01 < apart.mean() < 0.9
    assert run.steps_apart(states, pitches) == apart.sum()
    assert (force[apart] == 0.0).all()
    assert force.mean() == pytest.approx(FORCE * 5.0 / TORQUE, rel=0.03)  # not periodic: 180 meshes of a rattle


@pytest.mark.slow
def test_errors_of_teeth_repeat_after_the_hunting_period() -> None:
    rng = np.random.default_rng(5)
    missing = missing_material(gear_pair(), RELIEF)
    missing = replace(
        missing,
        pinion=replace(missing.pinion, offset_m=rng.normal(0.0, 1e-6, 18)),
        gear=replace(missing.gear, offset_m=rng.normal(0.0, 1e-6, 47)),
    )
    run, _, states = whole_meshes(
        lambda step: motion(make_structure(), law(missing), speed_hz=60.0, step_s=step), 2 * 846, 60.0, settle_s=2.0
    )
    y = states[:, 11 + run.structure.coordinates.index("y_casing")]
    period = 846 * STEPS_PER_MESH // 2  # 60 Hz
    # What is left of the transient, e^-34, and rounding.
    assert np.abs(y[:period] - y[period:]).max() < 1e-6 * y.std()
    revolution = 18 * 200
    assert np.abs(y[:period] - y[revolution : period + revolution]).max() > 0.1 * y.std()
