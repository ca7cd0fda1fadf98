"""Numbers of raw records: damage and level leave them alone, each leak moves its own."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.audit.label_digits import digit_columns
from diagnostics.audit.mesh_clock import clock_drift
from diagnostics.audit.quiet_ends import quiet_ends
from diagnostics.audit.stored_samples import stored_numbers, without_ends
from diagnostics.audit.time_templates import level_course, template_products, whitened_codes

FS_HZ, TEETH, RATE_HZ = 12_800.0, 18, 31.7
TIME_S = np.arange(16_384) / FS_HZ
STEP = 2.0**-8


def noise(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(TIME_S.size)


def strokes(rate_hz: float = RATE_HZ) -> np.ndarray:
    """Return one stroke a turn that rings at 2 kHz: what a damaged tooth gives."""
    phase = TIME_S * rate_hz % 1.0 / rate_hz
    return np.asarray(np.exp(-300.0 * phase) * np.sin(2 * np.pi * 2000.0 * phase))


@pytest.mark.parametrize("level", [1.0, 30.0])
def test_repeats_beyond_chance_do_not_depend_on_the_level_and_show_lost_samples(level: float) -> None:
    stored = np.round(level * noise(1) / STEP) * STEP
    held = stored.copy()
    held[99::100] = held[98::100][: held[99::100].size]
    # of independent counts a standard normal number; 4 comes in 1 of 16,000
    assert abs(stored_numbers(stored)["repeats"]) < 4.0
    assert stored_numbers(held)["repeats"] > 10.0


def test_a_clipped_peak_shows_and_the_converters_end_that_records_share_does_not() -> None:
    peaks = [np.abs(noise(seed)).max() for seed in range(4)]
    clipped = [np.clip(noise(seed), -0.9 * peaks[seed], 0.9 * peaks[seed]) for seed in range(4)]
    full = [np.clip(noise(seed), -2.0, 2.0) for seed in range(4)]
    for signals, is_found in ((clipped, True), (full, False)):
        rows = [stored_numbers(np.round(signal / STEP) * STEP) for signal in signals]
        columns = {f"{name} of a": np.array([row[name] for row in rows]) for name in rows[0]}
        found = without_ends(columns)["samples as large as the largest of a"]
        assert bool(np.all(found > 1.0)) == is_found


def test_a_clock_that_is_slow_shows_as_a_drift_of_its_size_and_damage_as_none() -> None:
    mesh = np.sin(2 * np.pi * TEETH * RATE_HZ * TIME_S) + 0.3 * np.sin(4 * np.pi * TEETH * RATE_HZ * TIME_S)
    pulses_s = (0.3 + np.arange(40)) / RATE_HZ
    damaged = mesh + 3.0 * strokes() + 0.1 * noise(2)
    # phases of segments scatter by 0.1/sqrt(1900), less than 1e-5 of the turns between them
    assert clock_drift(damaged, FS_HZ, pulses_s, TEETH) == pytest.approx(0.0, abs=1e-5)
    slow = np.interp(0.999 * TIME_S, TIME_S, damaged)
    assert clock_drift(slow, FS_HZ, pulses_s, TEETH) == pytest.approx(-1e-3, abs=2e-5)
    assert np.isnan(clock_drift(damaged, FS_HZ, pulses_s[:5], TEETH))


def test_crosstalk_and_a_low_pass_show_at_the_end_of_the_band() -> None:
    first, second = noise(4), noise(5)
    shared = "last 1/8 of the band that a and b share"
    # 1000 bins: independent noise scatters by 0.02
    assert abs(quiet_ends({"a": first, "b": second}, FS_HZ)[shared]) < 0.08
    assert quiet_ends({"a": first, "b": second + 0.2 * first}, FS_HZ)[shared] > 0.12
    passed = np.fft.irfft(np.fft.rfft(first) * (np.fft.rfftfreq(first.size) < 0.45), first.size)
    top = "level of the highest bins of a"
    assert quiet_ends({"a": passed}, FS_HZ)[top] < quiet_ends({"a": first}, FS_HZ)[top] - 20.0


def test_noise_far_below_that_of_a_record_is_found_again_in_another_one() -> None:
    common = 0.3 * noise(6)
    # records start at any angle
    turned = [np.roll(50.0 * strokes(), 97 * seed) * (seed % 2) for seed in range(8)]
    own = [whitened_codes(noise(10 + k) + turned[k] + common * (k < 4)) for k in range(8)]
    products = template_products(own, [level_course(noise(20 + k)) for k in range(8)])
    assert len(products) == 5
    product = products["spectra, lines 2048 to 8192"]
    same, other = product[:4, :4][np.triu_indices(4, 1)], product[4:, 4:][np.triu_indices(4, 1)]
    # 12288 numbers: independent spectra scatter by 1/110
    assert same.mean() > 0.02
    assert abs(other.mean()) < 0.015


def test_digits_single_precision_and_signs_of_zero_are_columns_where_they_vary() -> None:
    exact = np.random.default_rng(7).uniform(20.0, 40.0, 6)
    half = np.arange(6) < 3
    assert digit_columns("speed", exact) == {}
    assert "few digits of speed" in digit_columns("speed", np.where(half, np.round(exact, 1), exact))
    single = np.where(half, exact.astype(np.float32), exact)
    assert "single precision of speed" in digit_columns("speed", single)
    assert set(digit_columns("share", np.where(half, -0.0, 0.0))) == {"sign of zero of share"}
