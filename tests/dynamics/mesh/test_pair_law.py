from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.dynamics.friction.friction import constant_friction
from siggen.dynamics.mesh.pair_columns import FLANK, FRICTION, NORMAL, PENETRATION, POSITION, STIFFNESS, WHOLE
from siggen.dynamics.mesh.pair_forces import pair_forces, static_approach_m
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.mesh.pair_places import pair_table
from siggen.gears.geometry.missing_material import MissingMaterial, missing_material
from tests.dynamics.pair_runs import constant_tables, exact_involutes, gear_pair, law, tables

DOUBLE, SINGLE = 5.3, 5.85
"""Angles with two pairs and with one pair in contact: the contact ratio is 1.637."""


def loaded(
    chosen: PairLaw, approach: float, pitches: float, rate: float = 0.0, sliding: tuple[float, float] = (0.0, 0.0)
) -> np.ndarray:
    pairs = pair_table(chosen)
    pair_forces(chosen, approach, rate, pitches, *sliding, pairs)
    return pairs


def exact() -> MissingMaterial:
    return missing_material(gear_pair(), None, corner_contact=False)


def with_pinion_tooth(index: int, offset_m: float) -> MissingMaterial:
    missing = exact()
    offsets = np.zeros(18)
    offsets[index] = offset_m
    return replace(missing, pinion=replace(missing.pinion, offset_m=offsets))


@given(st.floats(0.0, 50.0), st.floats(1.0, 5000.0))
def test_the_static_approach_carries_the_force(pitches: float, force: float) -> None:
    chosen = law()
    pairs = loaded(chosen, static_approach_m(chosen, force, pitches), pitches)
    assert pairs[:, NORMAL].sum() == pytest.approx(force, rel=1e-9)


def test_static_deflection_at_the_quoted_stiffnesses() -> None:
    force = 30.0 / gear_pair().pinion.base_radius_m
    assert force == pytest.approx(1182.4, abs=0.05)
    for stiffness, ratio, expected_um in ((2.05e8, 1.0, 5.77), (1.89e8, 2.0, 3.13)):
        over = constant_tables(stiffness, ratio)
        chosen = law(exact_involutes(over), over)
        assert 1e6 * static_approach_m(chosen, force, DOUBLE) == pytest.approx(expected_um, abs=0.005)


@given(st.floats(-5e-6, 5e-6), st.floats(100.0, 3000.0))
def test_load_sharing_of_two_pairs_is_the_closed_form(error_m: float, force: float) -> None:
    chosen = law(with_pinion_tooth(4, max(error_m, 0.0)), backlash_m=1e-3)
    if error_m < 0.0:
        chosen = law(with_pinion_tooth(5, -error_m), backlash_m=1e-3)
    pairs = loaded(chosen, static_approach_m(chosen, force, DOUBLE), DOUBLE)
    newer, older = (pairs[pair % len(pairs)] for pair in (5, 4))
    k_1, k_2 = newer[STIFFNESS], older[STIFFNESS]
    # error_m = e of the older pair less e of the newer one.
    expected = np.clip(k_1 / (k_1 + k_2) * (1.0 + k_2 * error_m / force), 0.0, 1.0)
    assert newer[NORMAL] / force == pytest.approx(expected, abs=1e-9)
    assert (newer[NORMAL] + older[NORMAL]) / force == pytest.approx(1.0, rel=1e-9)


def test_the_loaded_transmission_error_is_the_closed_form() -> None:
    chosen = law(with_pinion_tooth(4, 2e-6))
    approach = static_approach_m(chosen, 1182.4, DOUBLE)
    pairs = loaded(chosen, approach, DOUBLE)
    k = pairs[:, STIFFNESS]
    assert approach == pytest.approx((1182.4 + k[4 % len(k)] * 2e-6) / k.sum(), rel=1e-9)


@given(st.floats(-1e-4, 2e-5), st.floats(-0.05, 0.05), st.floats(0.0, 18.0 * 47.0))
def test_flanks_only_push(approach: float, rate: float, pitches: float) -> None:
    pairs = loaded(law(), approach, pitches, rate)
    driving, backward = pairs[:, FLANK] > 0.0, pairs[:, FLANK] < 0.0
    assert (pairs[driving, NORMAL] >= 0.0).all()
    assert (pairs[backward, NORMAL] <= 0.0).all()
    assert (pairs[pairs[:, FLANK] == 0.0, NORMAL] == 0.0).all()
    assert not (driving.any() and backward.any())


def test_the_back_flank_is_met_after_the_whole_backlash() -> None:
    chosen = law(exact())
    assert (loaded(chosen, -79.9e-6, SINGLE)[:, NORMAL] == 0.0).all()
    pairs = loaded(chosen, -81e-6, SINGLE)
    assert pairs[:, NORMAL].sum() == pytest.approx(-1e-6 * pairs[:, STIFFNESS].sum(), rel=1e-9)
    assert static_approach_m(chosen, -1182.4, SINGLE) == pytest.approx(
        -80e-6 - static_approach_m(chosen, 1182.4, SINGLE), rel=1e-9
    )


def test_missing_material_deeper_than_the_backlash_leaves_the_back_flank_alone() -> None:
    missing = exact()
    deep = replace(missing, pinion=replace(missing.pinion, profile_m=missing.pinion.profile_m + 200e-6))
    pairs = loaded(law(deep), 5e-6, DOUBLE)
    assert (pairs[:, PENETRATION] < -100e-6).all()
    assert (pairs[:, NORMAL] == 0.0).all()
    # A tooth that stands back as a whole meets its back flank all the earlier.
    misplaced = loaded(law(with_pinion_tooth(5, 200e-6)), 5e-6, SINGLE)
    assert (misplaced[:, NORMAL] < 0.0).any()


def test_pairs_are_those_of_the_path_of_contact_and_its_corners() -> None:
    chosen, without_corners = law(), law(exact())
    pair = gear_pair()
    angles = np.linspace(0.0, 3.0, 6001)
    counts = np.array([(loaded(chosen, 0.0, a)[:, WHOLE] > 0.0).sum() for a in angles])
    assert counts.mean() == pytest.approx(pair.contact_ratio + 0.3, abs=1e-3)
    touching = np.array([(loaded(without_corners, 1e-6, a)[:, FLANK] > 0.0).sum() for a in angles])
    assert touching.mean() == pytest.approx(1.6368, abs=1e-3)


def test_damping_is_a_constant_ratio_of_the_stiffness_in_contact() -> None:
    chosen = law(exact(), damping_ratio=0.07, mass=0.2124)
    for angle in (DOUBLE, SINGLE):
        still, moving = loaded(chosen, 5e-6, angle), loaded(chosen, 5e-6, angle, rate=1e-3)
        coefficient = (moving[:, NORMAL] - still[:, NORMAL]) / 1e-3
        k = still[:, STIFFNESS]
        assert coefficient.sum() == pytest.approx(2.0 * 0.07 * np.sqrt(k.sum() * 0.2124), rel=1e-9)
        np.testing.assert_allclose(coefficient[k > 0.0] / k[k > 0.0], coefficient.sum() / k.sum(), rtol=1e-9)


def test_friction_turns_at_the_pitch_point_and_takes_power() -> None:
    pair = gear_pair()
    omega = 2.0 * np.pi * 30.0
    gear_omega = omega * 18.0 / 47.0
    rolling = (-pair.line_of_action_m * gear_omega, omega + gear_omega)
    chosen = law(friction=constant_friction(0.05))
    for angle in np.linspace(0.0, 1.0, 41):
        for row in loaded(chosen, 5e-6, 20.0 + angle, sliding=rolling):
            if row[NORMAL] > 0.0:
                sliding = row[POSITION] * omega - (pair.line_of_action_m - row[POSITION]) * gear_omega
                assert row[FRICTION] == pytest.approx(0.05 * row[NORMAL] * np.tanh(sliding / 0.02), rel=1e-9)
                assert row[FRICTION] * sliding >= 0.0
                assert (row[FRICTION] > 0.0) == (row[POSITION] > pair.pitch_point_m)
    back = loaded(chosen, -90e-6, DOUBLE, sliding=rolling)
    assert (back[:, NORMAL] < 0.0).any()
    assert (np.abs(back[:, FRICTION]) <= 0.05 * np.abs(back[:, NORMAL])).all()
    assert (back[:, FRICTION] != 0.0).any()


def test_tables_that_end_inside_the_path_of_contact_are_refused() -> None:
    short = replace(exact(), end_m=tables().end_m - 1e-4)
    with pytest.raises(ValueError, match="missing material: received"):
        law(short)


@pytest.mark.parametrize("wrong", [{"damping_ratio": -0.1}, {"backlash_m": float("nan")}])
def test_impossible_numbers_are_refused(wrong: dict) -> None:
    with pytest.raises(ValueError, match="allowed are finite values from 0"):
        law(**wrong)


def test_a_force_that_no_tooth_carries_is_refused() -> None:
    with pytest.raises(ValueError, match="allowed are forces that teeth carry"):
        static_approach_m(law(), 1e9, SINGLE)


def test_back_flanks_touch_no_longer_than_drive_flanks_do() -> None:
    """Corners are missing on either side: at any angle as many pairs carry under a torque as under its opposite."""
    chosen = law(missing_material(gear_pair()))
    for pitches in np.linspace(5.0, 6.0, 41):
        for force_n in (50.0, 1182.4):
            drive = loaded(chosen, static_approach_m(chosen, force_n, float(pitches)), float(pitches))
            back = loaded(chosen, static_approach_m(chosen, -force_n, float(pitches)), float(pitches))
            np.testing.assert_allclose(back[:, NORMAL], -drive[:, NORMAL], atol=1e-6 * force_n)
