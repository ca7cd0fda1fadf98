"""Film, pressure and friction in every contact, and the rough lands of pitted flanks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.damage.part import Damage
from siggen.mesh.asperities import asperity_table, mixed_contact
from siggen.mesh.contact_names import OF_CONTACT_ALONE
from siggen.mesh.friction import composite_friction
from siggen.mesh.node_forces import pair_forces
from siggen.mesh.pair_columns import (
    ASPERITY_SHARE,
    CARRYING,
    COEFFICIENT,
    DAMPING,
    FRICTION,
    NORMAL,
    POSITION,
    ROUGH,
    STIFFNESS,
)
from siggen.mesh.pair_internals import PairContact, pair_internal_names, pair_internals
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.pair_springs import pair_table
from siggen.mesh.tooth_law import DampingLaw
from tests.dynamics.lubricated import FORCE, LINE, MODULUS, PITCH_POINT, RANGE, mesh
from tests.dynamics.pair_runs import contact_law, gear_pair
from tests.gears.pit_shapes import chord_pit

PAIR = gear_pair()
HEALTHY_M, PITTED_M = 0.57e-6, 2.04e-6
FRICTION_LAW = composite_friction(asperity_table(mesh(), [HEALTHY_M, PITTED_M], RANGE, 10.0 * FORCE), 0.09)
DEDENDUM = PITCH_POINT - 3e-3
"""Well before the pitch point, where teeth slide."""
HALF_PIT = (chord_pit(PAIR, 1e-3, DEDENDUM, semi_face_m=5e-3),)
THROUGH = (chord_pit(PAIR, 0.5e-3, DEDENDUM),)
ALONE = (PITCH_POINT - PAIR.contact_start_m) / PAIR.base_pitch_m
ON_PIT = (DEDENDUM - PAIR.contact_start_m) / PAIR.base_pitch_m


def law(damage: Damage = (), damping: float | DampingLaw = 0.07) -> PairLaw:
    return contact_law(damage, damping_ratio=damping, friction=FRICTION_LAW)


def loaded(chosen: PairLaw, approach: float, pitches: float, rate: float = 0.0) -> np.ndarray:
    pairs = pair_table(chosen)
    pair_forces(chosen, approach, rate, pitches, -2.4, 260.0, pairs)
    return pairs


def internals(pairs: np.ndarray, contact: PairContact | None) -> dict[str, float]:
    names = pair_internal_names(len(pairs), contact)
    return dict(zip(names, pair_internals(pairs[None], LINE, contact)[0], strict=True))


def test_land_at_damage_rubs_more_by_its_share_of_the_load_and_never_above_the_boundary() -> None:
    healthy, pitted, through = (loaded(law(damage), 12e-6, ON_PIT)[0] for damage in ((), HALF_PIT, THROUGH))
    fluid = mixed_contact(FRICTION_LAW.table, 0, DEDENDUM, healthy[NORMAL])[1]
    assert fluid < healthy[COEFFICIENT] < through[COEFFICIENT] < 0.09
    assert (healthy[ROUGH], through[ROUGH]) == (0.0, 1.0)
    # Beside half a face of pit the other half carries. Its ends are pointed: land is rough as far as chords are long,
    # 0.1 mm beyond an end (most of √(0.4 e) - e, e before it, in mm). The load is higher there.
    assert 0.02 < pitted[ROUGH] < 0.1
    share = (pitted[COEFFICIENT] - healthy[COEFFICIENT]) / (through[COEFFICIENT] - healthy[COEFFICIENT])
    assert share == pytest.approx(pitted[ROUGH], abs=0.1)


@pytest.mark.parametrize("place", [PITCH_POINT, PITCH_POINT + 5e-5, DEDENDUM])
def test_friction_never_gives_power_and_turns_without_a_kink(place: float) -> None:
    chosen, slip = law(), FRICTION_LAW.slip_speed_m_s
    pitches = (place - PAIR.contact_start_m) / PAIR.base_pitch_m

    def friction(slide: float) -> float:
        pairs = pair_table(chosen)
        pair_forces(chosen, 12e-6, 0.0, pitches, slide, 0.0, pairs)
        return float(pairs[0, FRICTION])

    slides = slip * np.linspace(-3.0, 3.0, 61)
    found = np.array([friction(slide) for slide in slides])
    assert (found * slides >= 0.0).all()
    assert found[30] == 0.0
    # One slope on either side of v = 0; of tanh it differs from the tangent by a third of 1e-3 squared.
    left, right = (friction(side * 1e-3 * slip) / (side * 1e-3 * slip) for side in (-1.0, 1.0))
    assert left == pytest.approx(right, rel=1e-9)
    assert left == pytest.approx(friction(3e-3 * slip) / (3e-3 * slip), rel=1e-5)


def test_friction_before_and_behind_a_pit_is_the_healthy_one_to_the_bit() -> None:
    plain, pitted = law(), law(HALF_PIT)
    for pitches in (ALONE + 0.1, ON_PIT + 1.0, 4.3):
        np.testing.assert_array_equal(
            loaded(plain, 5e-6, pitches)[:, : DAMPING + 1], loaded(pitted, 5e-6, pitches)[:, : DAMPING + 1]
        )


def test_damping_follows_the_asperities() -> None:
    parts = DampingLaw(0.04, 0.02, 0.05)
    pairs = loaded(law(damping=parts), 5e-6, ON_PIT)
    touching = pairs[:, NORMAL] > 0.0
    total = pairs[touching, STIFFNESS].sum()
    for row in pairs[touching]:
        ratio = 0.04 + 0.02 * (1.0 - row[ASPERITY_SHARE]) + 0.05 * row[ASPERITY_SHARE]
        expected = 2.0 * ratio * np.sqrt(0.2124 / total) * row[STIFFNESS]
        assert row[DAMPING] == pytest.approx(expected, rel=1e-12)
    rough = loaded(law(THROUGH, parts), 12e-6, ON_PIT)[0]
    assert rough[ASPERITY_SHARE] > 2.0 * loaded(law(damping=parts), 12e-6, ON_PIT)[0, ASPERITY_SHARE]
    assert rough[DAMPING] / rough[STIFFNESS] > pairs[0, DAMPING] / pairs[0, STIFFNESS]
    with pytest.raises(ValueError, match="without a friction law; allowed: with one"):
        contact_law(damping_ratio=parts)


def test_damping_of_equal_parts_is_the_constant_one() -> None:
    shared, constant = law(damping=DampingLaw(0.05, 0.02, 0.02)), law(damping=0.07)
    for rate in (-0.01, 0.02):
        first, second = (loaded(chosen, 5e-6, 0.4, rate)[:, NORMAL] for chosen in (shared, constant))
        np.testing.assert_allclose(first, second, rtol=1e-12)


def test_contact_values_are_those_of_the_pitch_point() -> None:
    contact = PairContact(MODULUS, 0.02, mesh(), (HEALTHY_M, PITTED_M))
    chosen = law()
    low, high = 0.0, 2e-5
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if loaded(chosen, middle, ALONE)[0, NORMAL] < FORCE else (low, middle)
    inner = internals(loaded(chosen, high, ALONE), contact)
    assert inner["pair_0_force_n"] == pytest.approx(FORCE, rel=1e-6)
    assert inner["pair_0_load_share"] == pytest.approx(1.0)
    # Single contact: 0.565 GPa; smooth film 1.01 µm, at a film ratio of 1.8 nearly a whole one.
    assert inner["pair_0_hertz_pressure_pa"] == pytest.approx(0.565e9, rel=2e-3)
    assert inner["pair_0_central_film_m"] == pytest.approx(1.013e-6, rel=1e-3)
    assert inner["pair_0_film_ratio"] == pytest.approx(inner["pair_0_central_film_m"] / HEALTHY_M, rel=1e-12)
    assert inner["pair_0_asperity_share"] == pytest.approx(0.009, abs=0.001)


def test_internals_add_up_and_half_a_face_is_thinner_lubricated() -> None:
    contact = PairContact(MODULUS, 0.02, mesh(), (HEALTHY_M, PITTED_M))
    pairs = loaded(law(HALF_PIT), 5e-6, ON_PIT, 1e-3)
    whole = loaded(law(), 5e-6, ON_PIT, 1e-3)
    inner, plain = internals(pairs, contact), internals(whole, contact)
    assert inner["mesh_force_n"] == pytest.approx(pairs[:, NORMAL].sum(), rel=1e-12)
    assert inner["friction_moment_pinion_nm"] == pytest.approx((pairs[:, POSITION] * pairs[:, FRICTION]).sum())
    moments = inner["pair_0_friction_moment_pinion_nm"] + inner["pair_0_friction_moment_gear_nm"]
    assert moments == pytest.approx(LINE * inner["pair_0_friction_n"], rel=1e-12)
    assert inner["pair_0_film_ratio"] < plain["pair_0_film_ratio"]
    # Half the face carries 0.77 of the force: the pressure grows with the root of the line load.
    loads = inner["pair_0_force_n"] / pairs[0, CARRYING] / (plain["pair_0_force_n"] / whole[0, CARRYING])
    assert 1.5 < loads < 1.6
    ratio = inner["pair_0_hertz_pressure_pa"] / plain["pair_0_hertz_pressure_pa"]
    assert ratio == pytest.approx(loads**0.5, rel=1e-9)


def test_a_pair_apart_has_no_force_and_what_only_a_contact_has_is_undefined() -> None:
    contact = PairContact(MODULUS, 0.02, mesh(), (HEALTHY_M, PITTED_M))
    apart = internals(loaded(law(), -20e-6, ALONE), contact)
    undefined = {name for name, value in apart.items() if np.isnan(value)}
    assert undefined == {name for name in apart if name.endswith(OF_CONTACT_ALONE)}
    assert {name.removeprefix("pair_0_") for name in undefined if name.startswith("pair_0_")} == set(OF_CONTACT_ALONE)
    for name in set(apart) - undefined:
        if not name.endswith(("position_m", "sliding_m_s")):
            assert apart[name] == 0.0, name
    dry = replace(contact, oil=None)
    assert "pair_0_central_film_m" not in pair_internal_names(2, dry)
    assert "pair_0_hertz_pressure_pa" not in pair_internal_names(2, None)


def test_a_back_flank_carries_and_rubs_without_film() -> None:
    contact = PairContact(MODULUS, 0.02, mesh(), (HEALTHY_M, PITTED_M))
    back = internals(loaded(law(), -90e-6, ALONE), contact)
    assert back["pair_0_force_n"] < 0.0
    assert 0.0 < back["pair_0_friction_n"] * np.sign(back["pair_0_sliding_m_s"]) < -0.2 * back["pair_0_force_n"]
    assert all(np.isnan(back[f"pair_0_{name}"]) for name in OF_CONTACT_ALONE)
