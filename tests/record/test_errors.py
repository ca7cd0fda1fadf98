"""Errors drawn from a configuration: what shares them, what does not, and what reaches the records."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.config import parse
from siggen.gearbox.design import SetDesign
from siggen.gearbox.teeth import SpecimenErrors
from siggen.record.specimen_state import specimen_state
from tests.simulated import label_names, simulate

SHORT = ["specimens=20", "duration_s=0.1", "operating_points=[{speed_hz: 30.0, torque_nm: 30.0}]"]


def made(*overrides: str) -> SetDesign:
    return load_config("tests/configs/casing.yaml", [*SHORT, *overrides])


CLASS_6 = made("manufacture={accuracy_class: 6}")
PER_STATE = made("manufacture={accuracy_class: 6, draw: state}")


def errors_of(config: SetDesign, specimen: int = 0, state: int = 0) -> SpecimenErrors:
    teeth = config.gearbox(specimen).meshes[0].teeth
    found = teeth.errors(teeth.drawn_for(state))
    assert found is not None
    return found


def places(errors: SpecimenErrors) -> np.ndarray:
    return np.concatenate([errors.pinion.errors.pitch_m, errors.gear.errors.pitch_m])


def differ(first: SpecimenErrors, second: SpecimenErrors) -> bool:
    return not np.isclose(places(first), places(second), rtol=1e-6, atol=0.0).any()


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6))
def test_drawn_gears_keep_to_their_class_and_use_their_share(specimen: int) -> None:
    errors = errors_of(CLASS_6, specimen)
    for gear in (errors.pinion, errors.gear):
        assert 0.3 <= gear.tolerance_share <= 0.5
        limit = gear.tolerances.times(gear.tolerance_share)
        used = {name: value / getattr(limit, name) for name, value in gear.found.largest.items()}
        assert max(used.values()) == pytest.approx(1.0, abs=1e-9)
        assert 0.3 <= used["runout_m"] <= 0.8 + 1e-9


def test_states_of_a_specimen_share_its_gears_or_do_not() -> None:
    np.testing.assert_array_equal(places(errors_of(CLASS_6, 3, 0)), places(errors_of(CLASS_6, 3, 2)))
    assert differ(errors_of(PER_STATE, 3, 0), errors_of(PER_STATE, 3, 2))
    assert differ(errors_of(CLASS_6, 3), errors_of(CLASS_6, 4))


def test_classes_of_a_choice_all_occur_and_gears_draw_their_own() -> None:
    config = made("manufacture={accuracy_class: {one_of: [5, 6, 7]}}")
    found = [errors_of(config, specimen) for specimen in range(40)]
    assert {one.pinion.accuracy_class for one in found} == {5, 6, 7}
    assert any(one.pinion.accuracy_class != one.gear.accuracy_class for one in found)


def parsed(raw: dict[str, Any]) -> SetDesign:
    config = parse(raw).config
    assert config is not None
    return SetDesign(config)


def misaligned(value: object) -> SetDesign:
    section = {"accuracy_class": 6, "lead_misalignment_um": value}
    return parsed({**CLASS_6.canonical(), "manufacture": section})


def test_misalignment_is_linear_across_the_face_and_drawn_with_either_sign() -> None:
    config = misaligned(8.0)
    drawn = [errors_of(config, specimen) for specimen in range(30)]
    assert {round(1e6 * one.lead_misalignment_m, 9) for one in drawn} == {8.0, -8.0}
    lead = drawn[0].lead_m(200)
    assert lead.mean() == pytest.approx(0.0, abs=1e-20)
    # Middles of the slices: half a slice short of the face at both ends.
    assert np.ptp(lead) == pytest.approx(8e-6 * 199 / 200, rel=1e-12)
    assert errors_of(CLASS_6).lead_misalignment_m == 0.0


def test_misalignment_by_the_standard_stays_within_the_helix_slopes_of_both_gears() -> None:
    config = misaligned("iso_1328")
    found = [errors_of(config, specimen) for specimen in range(80)]
    limits = [sum(g.tolerance_share * g.tolerances.helix_slope_m for g in (e.pinion, e.gear)) for e in found]
    ratio = np.array([e.lead_misalignment_m for e in found]) / limits
    assert np.abs(ratio).max() <= 1.0
    # The sum of two uniform ones of about one size: a standard deviation of 1/√6 of their reach.
    # Of 80 of them it scatters by 7 %.
    assert ratio.std() == pytest.approx(1.0 / np.sqrt(6.0), rel=0.21)


def records(config: SetDesign, ids: list[int]) -> list[SimulatedRecord]:
    found = simulate(config, ids)
    assert all(isinstance(one, SimulatedRecord) for one in found), found
    return found  # type: ignore[return-value]


def test_records_say_what_was_drawn() -> None:
    record = records(CLASS_6, [1])[0]
    errors = errors_of(CLASS_6, 0, 1)
    assert set(record.labels) == set(label_names(CLASS_6))
    assert record.labels["manufacture_draw"] == "specimen"
    assert record.labels["accuracy_class_gear"] == 6
    found = errors.gear.found.largest
    assert record.labels["cumulative_pitch_gear_um"] == pytest.approx(1e6 * found["cumulative_pitch_m"])
    assert record.labels["pitch_deviation_gear_um"] == pytest.approx(1e6 * found["pitch_m"])
    assert not {name for name in label_names(made()) if "pitch_deviation" in name or "accuracy" in name}


def test_no_share_of_the_tolerance_gives_the_bytes_of_perfect_gears() -> None:
    zero = records(made("manufacture={accuracy_class: 6, tolerance_share: 0.0}"), [1])[0]
    perfect = records(made(), [1])[0]
    for name, signal in perfect.channels.items():
        assert zero.channels[name].tobytes() == signal.tobytes()


def with_helix(config: SetDesign, **keys: object) -> SetDesign:
    section = {"accuracy_class": 6, **keys}
    return parsed({**config.canonical(), "manufacture": section})


def test_helix_slopes_are_those_of_misaligned_by_the_standard_and_forms_are_one_per_gear() -> None:
    config = with_helix(CLASS_6, helix="iso_1328", crowning_um=5.0, crowning_driven_um=0.0)
    for specimen in range(5):
        one, before = errors_of(config, specimen), errors_of(misaligned("iso_1328"), specimen)
        # Slope and form shrink alike where their total passes its limit; the form was at its own before.
        drawn = (
            made.helix.slope_m * made.tolerance_share * made.tolerances.helix_form_m / np.ptp(made.helix.form_m)
            for made in (one.pinion, one.gear)
        )
        assert sum(drawn) == pytest.approx(before.lead_misalignment_m, rel=1e-9)
        assert (one.pinion.helix.crowning_m, one.gear.helix.crowning_m) == pytest.approx((5e-6, 0.0), rel=1e-12)
        place = (np.arange(100) + 0.5) / 100
        expected = one.pinion.helix.missing_m(place) + one.gear.helix.missing_m(place)
        np.testing.assert_allclose(one.lead_m(100), expected, atol=1e-18)
        assert not np.allclose(one.pinion.helix.form_m, one.gear.helix.form_m)


def test_a_crowned_pair_at_rest_gives_way_by_up_to_the_mean_of_its_parabola() -> None:
    crown, approach = 8e-6, {}
    for crowning in (8.0, 0.0):
        config = with_helix(CLASS_6, tolerance_share=0.0, crowning_um=crowning, crowning_driven_um=0.0)
        state = specimen_state(config.gearbox(0), 0)
        pair = state.pair
        alone = np.array([0.5 * (pair.contact_end_m - pair.contact_start_m) / pair.base_pitch_m])
        approach[crowning] = np.array(
            [
                torque / pair.pinion.base_radius_m / state.static.stiffness_n_per_m(torque, alone)[0]
                for torque in (0.3, 3.0, 30.0, 90.0)
            ]
        )
    more = (approach[8.0] - approach[0.0]) / crown
    # Without load the middle alone touches; once the ends do, springs give way by the mean, a third of it.
    assert np.all(np.diff(more) > 0.0)
    assert more[0] < 0.03
    assert more[-1] == pytest.approx(1.0 / 3.0, rel=0.1)


def test_records_say_which_helix_and_crowning_were_drawn() -> None:
    keys = {"helix": "iso_1328", "crowning_um": [2.0, 6.0]}
    config = with_helix(CLASS_6, **keys)
    record = records(config, [1])[0]
    errors = errors_of(config, 0, 1)
    assert set(record.labels) == set(label_names(config))
    assert record.labels["crowning_gear_um"] == pytest.approx(1e6 * errors.gear.helix.crowning_m)
    assert record.labels["helix_slope_pinion_um"] == pytest.approx(1e6 * errors.pinion.helix.slope_m)
    assert record.labels["lead_misalignment_um"] == pytest.approx(1e6 * errors.lead_misalignment_m)
    crowned = errors_of(with_helix(CLASS_6, crowning_um=6.0))
    lead = crowned.lead_m(200)
    np.testing.assert_allclose(lead, lead[::-1], atol=1e-18)
