from __future__ import annotations

from math import cos

import numpy as np
import pytest

from siggen.gears.errors import FLANK_POINTS, GearErrors, deviations, with_errors
from siggen.gears.missing_material import MissingMaterial, TipRelief, missing_material
from tests.gears.builders import pair_18_47
from tests.gears.erroneous_gears import drawn, only_eccentric
from tests.gears.errors.unloaded_transmission_error import unloaded_transmission_error_m

PAIR = pair_18_47(module_m=3e-3, bores_m=(10e-3, 15e-3))
RELIEF = TipRelief(8e-6, 0.25 * PAIR.base_pitch_m)
HUNTING = 18 * 47


def perfect() -> MissingMaterial:
    return missing_material(PAIR, RELIEF)


def erroneous(seed: int = 1, share: float = 0.4) -> MissingMaterial:
    pinion, gear = (drawn(PAIR, which, seed, share=share) for which in ("pinion", "gear"))
    return with_errors(perfect(), PAIR, pinion, gear)


def test_tables_hold_what_a_machine_measures() -> None:
    ideal, missing = perfect(), erroneous()
    position = np.linspace(missing.start_m, missing.end_m, missing.pinion.profile_m.shape[1])
    middle = 0.5 * (PAIR.contact_start_m + PAIR.contact_end_m)
    for which in ("pinion", "gear"):
        teeth, found = getattr(missing, which), deviations(PAIR, which, drawn(PAIR, which, 1))
        arc = teeth.offset_m / cos(PAIR.pinion.pressure_angle_rad)
        np.testing.assert_allclose(arc, found.cumulative_pitch_m, atol=1e-18)
        own = teeth.profile_m - getattr(ideal, which).profile_m
        inside = (position >= PAIR.contact_start_m) & (position <= PAIR.contact_end_m)
        # The tables' 2049 points miss peaks between them: below 1 %.
        np.testing.assert_allclose(np.ptp(own[:, inside], axis=1), found.profile_m, rtol=0.01)
        np.testing.assert_allclose([np.interp(middle, position, row) for row in own], 0.0, atol=2e-8)


def test_a_flank_has_no_kinks() -> None:
    """Its curvature stays as it is on a grid four times as fine; at a kink it would be four times as large."""
    largest = []
    for points in (2049, 8193):
        ideal = missing_material(PAIR, RELIEF, points=points)
        missing = with_errors(ideal, PAIR, *(drawn(PAIR, which, 1) for which in ("pinion", "gear")))
        position = np.linspace(missing.start_m, missing.end_m, points)
        inside = (position > PAIR.contact_start_m) & (position < PAIR.contact_end_m)
        own = (missing.pinion.profile_m - ideal.pinion.profile_m)[:, inside]
        largest.append(np.abs(np.diff(own, n=2)).max(axis=1) / np.diff(position)[0] ** 2)
    assert (largest[1] < 1.1 * largest[0]).all()  # peaks of the curvature lie between the points of the coarse grid


def test_the_gears_profile_runs_against_the_position() -> None:
    sloped = GearErrors(0.0, 0.0, np.zeros(47), np.full(47, 6e-6), np.zeros((47, FLANK_POINTS)))
    missing = with_errors(perfect(), PAIR, only_eccentric(PAIR, "pinion", 0.0), sloped)
    own = missing.gear.profile_m - perfect().gear.profile_m
    # Most is missing at the tip, which is in contact first, and the corner beyond it misses the same.
    assert own[3, 0] == pytest.approx(3e-6, rel=1e-6)
    assert own[3, -1] == pytest.approx(-3e-6, rel=1e-6)
    # a difference of profiles of up to 0.1 mm: rounding leaves 1e-20 m of each
    assert (np.diff(own[3]) <= 2e-20).all()


def loop(missing: MissingMaterial, pitches: float) -> float:
    """Return the least missing material, pair by pair in plain Python."""
    length = missing.end_m - missing.start_m
    points = missing.pinion.profile_m.shape[1]
    least = np.inf
    for pair in range(int(pitches) - 4, int(pitches) + 4):
        position = PAIR.contact_start_m + (pitches - pair) * PAIR.base_pitch_m
        if not missing.start_m <= position < missing.end_m:
            continue
        total = 0.0
        for teeth, count in ((missing.pinion, 18), (missing.gear, 47)):
            row = teeth.profile_m[teeth.kind_of_tooth[pair % count]]
            at = (position - missing.start_m) / length * (points - 1)
            total += float(np.interp(at, np.arange(points), row)) + teeth.offset_m[pair % count]
        least = min(least, total)
    return least


def test_the_unloaded_transmission_error_is_that_of_the_first_pair_that_touches() -> None:
    missing = erroneous()
    # Over the whole hunting period, at angles that fall nowhere regular.
    pitches = np.linspace(0.0, HUNTING, 1511)[:-1] + 0.0137
    expected = [loop(missing, float(angle)) for angle in pitches]
    np.testing.assert_allclose(unloaded_transmission_error_m(PAIR, missing, pitches), expected, atol=1e-17)


def lines(missing: MissingMaterial) -> np.ndarray:
    """Return amplitudes of the unloaded error over lines per hunting period: mesh 846, shafts 47 and 18 [m]."""
    per_mesh = 64
    error = unloaded_transmission_error_m(PAIR, missing, np.arange(HUNTING * per_mesh) / per_mesh)
    return np.asarray(2.0 * np.abs(np.fft.rfft(error)) / error.size)


def test_the_unloaded_transmission_error_shows_the_orders_of_both_shafts() -> None:
    spectrum = lines(erroneous())
    orders = {"pinion": 47, "gear": 18}
    for which, line in orders.items():
        errors = drawn(PAIR, which, 1)
        whole, stepped = (
            2.0 / len(places) * np.abs(np.fft.fft(places)[1]) * cos(PAIR.pinion.pressure_angle_rad)
            for places in (deviations(PAIR, which, errors).cumulative_pitch_m, errors.pitch_m)
        )
        # The foremost of two teeth is felt, up to a pitch early or late: that turns what goes in steps of a tooth by up
        # to 2π/18 against the eccentricity, 0.35 of it.
        assert spectrum[line] == pytest.approx(whole, abs=0.35 * stepped), which
    others = np.delete(spectrum[1:400], [n - 1 for n in range(1, 400) if n % 47 == 0 or n % 18 == 0])
    assert others.max() < 0.25 * min(spectrum[line] for line in orders.values())
