"""Limits and symmetries of the whole gearbox: lines that a spectrum may have, what scales, repeats and balances."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.gearbox.plan import planned_record
from siggen.gears.missing_material import MissingMaterial, missing_material
from siggen.mesh.friction import constant_friction
from siggen.mesh.pair_columns import FLANK, FRICTION, POSITION, SLIDING
from siggen.motion.pair_motion import PairMotion
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from tests.dynamics.casing_stage import make_structure
from tests.dynamics.pair_runs import (
    MESHES,
    RELIEF,
    columns,
    gear_pair,
    law,
    motion,
    settled,
)

STEPS_PER_MESH = 200
STEP_S = 1.0 / (MESHES * 30.0 * STEPS_PER_MESH)


def relieved() -> MissingMaterial:
    return missing_material(gear_pair(), RELIEF)


def run_over(meshes: int, missing: MissingMaterial, settle_s: float = 1.0, **changes):
    """Return the motion, angles and states over whole meshes, the end left out."""
    run = motion(make_structure(), law(missing), step_s=STEP_S, **changes)
    pitches, states = settled(run, 30.0, STEP_S, meshes * STEPS_PER_MESH, settle_s)
    return run, pitches[:-1], states[:-1]


def velocity(run: PairMotion, states: np.ndarray, name: str) -> np.ndarray:
    return states[:, len(run.structure.coordinates) + run.structure.coordinates.index(name)]


def test_contact_ratio_and_friction_arms_are_those_of_the_geometry() -> None:
    chosen = law(missing_material(gear_pair(), None, corner_contact=False), friction=constant_friction(0.05))
    run = motion(make_structure(), chosen, step_s=STEP_S)
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
        spectrum = lines(velocity(run, states, "y_casing"), 1, 18 * 12)
        others = np.delete(spectrum, np.arange(0, spectrum.size, 18))
        sidebands[name] = others.max() / spectrum[18]
    assert sidebands["all"] < 1e-8  # rounding; measured 2e-11
    assert sidebands["one"] > 1e-2


@pytest.mark.parametrize(
    "name", ["configs/paper_a", "tests/configs/linear_pits", "configs/paper_b", "configs/quickstart"]
)
def test_halving_the_step_of_a_shipped_set_changes_its_signals_by_less_than_a_thousandth(name: str) -> None:
    config = load_config(f"{name}.yaml", ["duration_s=0.1", "specimens=1"])
    steps = config.config.dynamics.steps_per_sample
    levels = []
    for factor in (1, 2):
        chosen = load_config(
            f"{name}.yaml",
            ["duration_s=0.1", "specimens=1", f"dynamics.steps_per_sample={factor * steps}"],
        )
        record = planned_record(chosen, chosen.records_per_specimen - 1)
        specimen = chosen.gearbox(0)
        response, _ = record_response(specimen, specimen_state(specimen, record.state_id), record)
        levels.append([signal.std() for signal in response.acceleration_m_s2.values()])
    np.testing.assert_allclose(levels[0], levels[1], rtol=1e-3)


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
