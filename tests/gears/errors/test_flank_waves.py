"""Waves over all teeth go on from pair to pair, and a contact of finite width follows them as derived."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.gears.flank_waves import ORDERS, FlankWaves, half_width_m, missing_m, with_waves
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import missing_material
from siggen.mesh.lubrication import effective_modulus, relative_radius
from tests.dynamics.pair_runs import gear_pair
from tests.gears.errors.unloaded_transmission_error import unloaded_transmission_error_m

PAIR = gear_pair()
LOAD = 5e4


def waves(pair: GearPair, which: str, *numbers: int, amplitude_m: float = 1e-7) -> FlankWaves:
    count, form = len(numbers), np.zeros(ORDERS.size, dtype=complex)
    own = np.zeros((pair.member(which).teeth, ORDERS.size), dtype=complex)
    return FlankWaves(np.array(numbers, float), np.full(count, amplitude_m), np.arange(count) + 0.4, form, own)


@pytest.mark.parametrize("which", ["pinion", "gear"])
@pytest.mark.parametrize("number", [3, 127, 400])
def test_the_next_pair_goes_on_with_the_wave_of_the_last(which: str, number: int) -> None:
    position = np.linspace(PAIR.contact_start_m + PAIR.base_pitch_m, PAIR.contact_end_m, 50)
    now = missing_m(PAIR, which, waves(PAIR, which, number), position, 0.0)
    following = missing_m(PAIR, which, waves(PAIR, which, number), position - PAIR.base_pitch_m, 0.0)
    np.testing.assert_allclose(following, np.roll(now, 1, axis=0), atol=1e-7 * 1e-4)


@pytest.mark.parametrize(("which", "number"), [("pinion", 127), ("gear", 215)])
def test_a_wave_is_one_line_at_its_number_times_the_shaft(which: str, number: int) -> None:
    none = {side: waves(PAIR, side) for side in ("pinion", "gear")}
    teeth = missing_material(PAIR, corner_contact=False, points=2049)
    wavy = with_waves(teeth, PAIR, **{**none, which: waves(PAIR, which, number)}, line_load_n_per_m=0.0)
    revolution = PAIR.member(which).teeth  # base pitches per turn of that gear
    samples = 16384
    error = unloaded_transmission_error_m(PAIR, wavy, np.arange(samples) * revolution / samples)
    lines = 2.0 * np.abs(np.fft.rfft(error)) / samples
    # linear reading of 2049 points: (2π/points per wave)²/8
    assert lines[number] == pytest.approx(1e-7, rel=5e-3)
    lines[number] = 0.0
    assert lines[1:].max() < 1e-9


def test_a_contact_follows_a_wave_by_the_mean_under_a_flat_punch() -> None:
    """1/(π √(b² - x²)) over the width by Gauss-Chebyshev nodes, along the flank's arc: no Bessel function."""
    position = np.array([0.5 * (PAIR.contact_start_m + PAIR.contact_end_m)])
    drawn = waves(PAIR, "pinion", 240)
    width = float(half_width_m(PAIR, position, LOAD)[0])
    nodes = width * np.cos(np.pi * (np.arange(64) + 0.5) / 64)
    # an arc x on a flank of radius ρ = s turns the gear by x/ρ and moves the contact by R_b x/ρ
    along = position + nodes * PAIR.pinion.base_radius_m / position
    expected = missing_m(PAIR, "pinion", drawn, along, 0.0).mean(axis=1)
    np.testing.assert_allclose(missing_m(PAIR, "pinion", drawn, position, width)[:, 0], expected, atol=1e-7 * 1e-3)
    ratio = np.abs(expected).max() / np.abs(missing_m(PAIR, "pinion", drawn, position, 0.0)).max()
    assert 0.1 < ratio < 0.95


def test_a_common_form_repeats_every_tooth_and_an_own_form_does_not() -> None:
    position = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 400)
    none = waves(PAIR, "gear")
    amplitudes = np.where(ORDERS == 5, 1e-6 + 0j, 0.0)
    common = missing_m(PAIR, "gear", FlankWaves(*[none.waves] * 3, amplitudes, none.own_m), position, 0.0)
    assert (common == common[0]).all()
    # five cycles from one end of the flank to the other
    crossings = np.flatnonzero(np.diff(np.sign(common[0])))
    assert len(crossings) == 10
    own = none.own_m.copy()
    own[7, 4] = 1e-6
    alone = missing_m(PAIR, "gear", FlankWaves(*[none.waves] * 3, none.common_m, own), position, 0.0)
    assert np.flatnonzero(alone.any(axis=1)).tolist() == [7]


def test_waves_of_no_height_change_no_bit() -> None:
    teeth = missing_material(PAIR)
    flat = with_waves(teeth, PAIR, waves(PAIR, "pinion"), waves(PAIR, "gear"), LOAD)
    for which in ("pinion", "gear"):
        before, after = getattr(teeth, which), getattr(flat, which)
        assert (after.profile_m == before.profile_m[0]).all()
        np.testing.assert_array_equal(after.offset_m, before.offset_m)


def test_the_half_width_is_that_of_hertz() -> None:
    position = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 9)
    modulus = effective_modulus(PAIR.youngs_modulus_pa, PAIR.poisson_ratio)
    radius = relative_radius(position, PAIR.line_of_action_m)
    expected = np.sqrt(4.0 * LOAD * radius / (np.pi * 0.5 * modulus))
    np.testing.assert_allclose(half_width_m(PAIR, position, LOAD), expected)


def test_below_the_base_circles_where_tables_may_begin_waves_are_finite_and_above_them_unchanged() -> None:
    line = PAIR.line_of_action_m
    inside = np.linspace(0.05, 0.95, 19) * line
    outside = np.array([-0.02, 0.0, 1.0, 1.02]) * line
    position = np.sort(np.concatenate([inside, outside]))
    width = half_width_m(PAIR, position, LOAD)
    assert np.all(width[np.isin(position, outside)] == 0.0)
    for which in ("pinion", "gear"):
        found = missing_m(PAIR, which, waves(PAIR, which, 127), position, width)
        assert np.isfinite(found).all()
        alone = missing_m(PAIR, which, waves(PAIR, which, 127), inside, half_width_m(PAIR, inside, LOAD))
        assert np.array_equal(found[:, np.isin(position, inside)], alone)
