from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.gears.missing_material import MissingMaterial, missing_material
from siggen.mesh.friction import constant_friction
from siggen.mesh.node_forces import pair_forces, static_approach_m
from siggen.mesh.pair_columns import FRICTION, NORMAL, PENETRATION, POSITION, STIFFNESS
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.pair_springs import pair_table
from tests.dynamics.pair_runs import gear_pair, law, tables

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


def test_a_force_that_no_tooth_carries_is_refused() -> None:
    with pytest.raises(ValueError, match="allowed are forces that teeth carry"):
        static_approach_m(law(), 1e9, SINGLE)
