"""Limits and symmetries of the whole gearbox: lines that a spectrum may have, what scales, repeats and balances."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.dynamics.friction.friction import constant_friction
from siggen.dynamics.mesh.pair_columns import FLANK, FRICTION, POSITION, SLIDING
from siggen.dynamics.structure.body import bolt_elements
from siggen.dynamics.structure.load_lock import locked_load
from siggen.dynamics.structure.structure import vector
from siggen.dynamics.time.equations import no_inputs
from siggen.dynamics.time.pair_motion import PairMotion
from siggen.gears.geometry.missing_material import MissingMaterial, missing_material
from siggen.planning.plan import planned_record
from siggen.planning.specimen import draw_specimen
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from tests.dynamics.casing_stage import PRESSURE_ANGLE, make_casing, make_structure
from tests.dynamics.pair_runs import (
    MESHES,
    RELIEF,
    TORQUE,
    columns,
    constant_tables,
    exact_involutes,
    gear_pair,
    law,
    motion,
    settled,
)

FORCE = TORQUE / gear_pair().pinion.base_radius_m
STEPS_PER_MESH = 200
STEP_S = 1.0 / (MESHES * 30.0 * STEPS_PER_MESH)


def relieved() -> MissingMaterial:
    return missing_material(gear_pair(), RELIEF)


def with_offsets(missing: MissingMaterial, pinion_m: np.ndarray | float, gear_m: np.ndarray | float) -> MissingMaterial:
    pinion, gear = missing.pinion, missing.gear
    return replace(
        missing,
        pinion=replace(pinion, offset_m=pinion.offset_m + pinion_m),
        gear=replace(gear, offset_m=gear.offset_m + gear_m),
    )


def run_over(meshes: int, missing: MissingMaterial, settle_s: float = 1.0, **changes):
    """Return the motion, angles and states over whole meshes, the end left out."""
    run = motion(make_structure(), law(missing), step_s=STEP_S, **changes)
    pitches, states = settled(run, 30.0, STEP_S, meshes * STEPS_PER_MESH, settle_s)
    return run, pitches[:-1], states[:-1]


def velocity(run: PairMotion, states: np.ndarray, name: str) -> np.ndarray:
    return states[:, len(run.structure.coordinates) + run.structure.coordinates.index(name)]


def test_contact_ratio_and_friction_arms_are_those_of_the_geometry() -> None:
    chosen = law(missing_material(gear_pair(), None, corner_contact=False), friction=constant_friction(0.05))
    run = motion(locked_load(make_structure()), chosen, step_s=STEP_S)
    pitches, states = settled(run, 30.0, STEP_S, STEPS_PER_MESH)
    pairs = run.pairs(states[:-1], pitches[:-1])[0]
    touching = pairs[:, :, FLANK] > 0.0
    # Counted at 200 angles per mesh, so each end is known to a two-hundredth.
    assert touching.sum(axis=1).mean() == pytest.approx(1.6368, abs=2.0 / STEPS_PER_MESH)
    pair = gear_pair()
    arm_1, arm_2 = pairs[:, :, POSITION], pair.line_of_action_m - pairs[:, :, POSITION]
    both = columns(run, states[:-1], pitches[:-1])
    friction = np.where(touching, pairs[:, :, FRICTION], 0.0)
    np.testing.assert_allclose((arm_1 * friction).sum(axis=1), both["friction_moment_pinion_nm"], atol=1e-9)
    np.testing.assert_allclose((arm_2 * friction).sum(axis=1), both["friction_moment_gear_nm"], atol=1e-9)
    # Sliding is about zero at the pitch point and carries its sign away from it; vibration adds 0.01 m/s.
    sliding, distance = pairs[:, :, SLIDING][touching], (pairs[:, :, POSITION] - pair.pitch_point_m)[touching]
    away = np.abs(distance) > 1e-4
    assert (np.sign(sliding[away]) == np.sign(distance[away])).all()
    assert (friction[touching] * sliding >= 0.0).all()


def test_a_disturbance_dies_out_where_nothing_excites() -> None:
    over = constant_tables()
    run = motion(make_structure(), law(exact_involutes(over), over), step_s=STEP_S, stiffness=3.14e8)
    pitches = MESHES * 30.0 * STEP_S * np.arange(round(2.0 / STEP_S) + 1)
    states = np.empty((pitches.size, 22))
    states[0] = run.start(0.0)
    states[0, 11 + run.structure.coordinates.index("y_c")] = 1e-3
    states[0, 11 + run.structure.coordinates.index("theta_m")] = 1e-2
    run.advance(pitches, no_inputs(pitches), states)
    moving = [i for i, name in enumerate(run.structure.coordinates) if name[0] in "xy"]
    first, last = (
        np.abs(np.array([run.rate(z, 0.0)[11:] for z in states[at]])) for at in (slice(0, 9), slice(-9, None))
    )
    assert first[:, moving].max() > 1.0
    assert last[:, moving].max() < 1e-9


def lines(signal: np.ndarray, revolutions_per_signal: int, shaft_orders: int) -> np.ndarray:
    """Return spectral lines; line k is k/revolutions orders of the shaft whose revolutions are counted."""
    return np.abs(np.fft.rfft(signal))[: revolutions_per_signal * shaft_orders]


def test_alike_pits_on_all_teeth_make_mesh_harmonics_only() -> None:
    missing = relieved()
    dent = 3e-6 * np.exp(-(((np.linspace(0.0, 1.0, missing.pinion.profile_m.shape[1]) - 0.5) / 0.03) ** 2))
    alike = replace(missing, pinion=replace(missing.pinion, profile_m=missing.pinion.profile_m + dent))
    single = replace(
        missing,
        pinion=replace(
            missing.pinion,
            profile_m=np.concatenate([missing.pinion.profile_m, missing.pinion.profile_m + dent]),
            kind_of_tooth=np.eye(18, dtype=np.int32)[4],
        ),
    )
    sidebands = {}
    for name, teeth in (("all", alike), ("one", single)):
        run, _, states = run_over(18, teeth, settle_s=1.0)
        spectrum = lines(velocity(run, states, "y_c"), 1, 18 * 12)
        others = np.delete(spectrum, np.arange(0, spectrum.size, 18))
        sidebands[name] = others.max() / spectrum[18]
    assert sidebands["all"] < 1e-8  # rounding; measured 2e-11
    assert sidebands["one"] > 1e-2


@pytest.mark.parametrize(("which", "teeth"), [("pinion", 18), ("gear", 47)])
def test_an_eccentric_gear_makes_sidebands_at_its_own_speed(which: str, teeth: int) -> None:
    runout = 5e-6 * np.cos(2.0 * np.pi * np.arange(teeth) / teeth)
    missing = with_offsets(relieved(), runout, 0.0) if which == "pinion" else with_offsets(relieved(), 0.0, runout)
    run, _, states = run_over(teeth, missing, settle_s=1.0)
    spectrum = lines(velocity(run, states, "y_c"), 1, teeth * 6)
    # One revolution of the eccentric gear: line k is its order k. Next to the mesh lines the first sidebands stand out;
    # what is left between them falls with every further multiple of the shaft.
    for mesh in (teeth, 2 * teeth):
        first = spectrum[[mesh - 1, mesh + 1]].max()
        assert first > 3.0 * spectrum[[mesh - 2, mesh + 2]].max()
        assert first > 20.0 * spectrum[[mesh - 4, mesh + 4]].max()
    perfect, _, still = run_over(teeth, relieved(), settle_s=1.0)
    floor = np.delete(lines(velocity(perfect, still, "y_c"), 1, teeth * 6), np.arange(0, teeth * 6, teeth))
    assert floor.max() < 1e-6 * spectrum[teeth]
    # The other gear turns 18/47 as fast: it has no line on this grid, so one more run of it must repeat exactly.
    again, _, twice = run_over(2 * teeth, missing, settle_s=1.0)
    signal = velocity(again, twice, "y_c")
    half = signal.size // 2
    assert np.abs(signal[:half] - signal[half:]).max() < 1e-6 * signal.std()


def test_small_errors_add_a_response_in_proportion() -> None:
    # Without corners and relief every pair in the path of contact carries, whatever errors of 0.1 µm its teeth have.
    exact = missing_material(gear_pair(), None, corner_contact=False)
    errors = 1e-7 * np.random.default_rng(3).normal(size=47)
    base, once, twice = (
        run_over(47, with_offsets(exact, 0.0, factor * errors), settle_s=0.3)[2] for factor in (0.0, 1.0, 2.0)
    )
    added = (once - base)[:, 11:]
    np.testing.assert_allclose((twice - base)[:, 11:], 2.0 * added, atol=1e-9 * np.abs(added).max())
    assert np.abs(added[:, 4:]).max() > 1e-6


def test_a_perfect_pair_repeats_after_every_mesh() -> None:
    run, _, states = run_over(6, relieved(), settle_s=1.0)
    for name in ("y_1", "x_1", "y_c", "phi_c"):
        signal = velocity(run, states, name).reshape(6, STEPS_PER_MESH)
        assert np.abs(signal - signal[0]).max() < 1e-8 * signal.std(), name  # what is left of the transient


@pytest.mark.parametrize(
    "name", ["configs/paper_a", "tests/configs/linear_pits", "configs/paper_b", "configs/quickstart"]
)
def test_halving_the_step_of_a_shipped_set_changes_its_signals_by_less_than_a_thousandth(name: str) -> None:
    config = load_config(f"{name}.yaml", ["duration_s=0.1", "specimens=1"])
    steps = config.dynamics.steps_per_sample
    levels = []
    for factor in (1, 2):
        chosen = load_config(
            f"{name}.yaml",
            ["duration_s=0.1", "specimens=1", f"dynamics.steps_per_sample={factor * steps}"],
        )
        record = planned_record(chosen, chosen.records_per_specimen - 1)
        specimen = draw_specimen(chosen, 0)
        response, _ = record_response(chosen, specimen, specimen_state(chosen, specimen, record.state_id), record)
        levels.append([signal.std() for signal in response.acceleration_m_s2.values()])
    np.testing.assert_allclose(levels[0], levels[1], rtol=1e-3)


@pytest.mark.parametrize("coefficient", [0.0, 0.05])
def test_the_bolts_hold_the_torques_of_motor_and_load(coefficient: float) -> None:
    structure, casing = make_structure(), make_casing()
    held = locked_load(structure) if coefficient else structure
    run = motion(held, law(relieved(), friction=constant_friction(coefficient)), step_s=STEP_S)
    pitches, states = settled(run, 30.0, STEP_S, 18 * STEPS_PER_MESH, 3.0 if coefficient else 1.0)
    inner = columns(run, states[:-1], pitches[:-1])
    n = len(structure.coordinates)
    moved = states[:-1, :n] + run.equations.static_deflection
    moment = np.zeros(len(moved))
    for element in bolt_elements(casing, PRESSURE_ANGLE):
        v = vector(structure.coordinates, element.direction)
        moment += element.direction["phi_c"] * element.stiffness * (moved @ v)
    load = structure.coordinates.index("theta_l")
    lock = held.stiffness[load, load] - structure.stiffness[load, load]
    torque = TORQUE * (1.0 + 47.0 / 18.0) + lock * inner["theta_l_rad"].mean()
    assert abs(moment.mean()) == pytest.approx(torque, rel=1e-5)
    assert torque == pytest.approx(108.33, abs=0.005) if not coefficient else torque < 108.33


def test_ten_seconds_put_mesh_and_pinion_lines_on_bins_but_not_the_gears() -> None:
    config = load_config("configs/paper_a.yaml")
    per_bin = config.fs_hz / config.samples
    assert (config.samples, per_bin) == (512_000, 0.1)
    shaft = 30.0
    for frequency in (shaft, 18 * shaft, 7 * shaft):
        assert frequency / per_bin == pytest.approx(round(frequency / per_bin), abs=1e-9)
    wheel = shaft * 18 / 47
    assert wheel == pytest.approx(11.489, abs=5e-4)
    assert abs(wheel / per_bin - round(wheel / per_bin)) > 0.1
