"""The realism quantities on signals whose values are known in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest

from diagnostics.indicators.line_levels import line_levels, synchronous_ratio_db
from diagnostics.indicators.record import record_result
from diagnostics.records.gear_train import pair_train
from diagnostics.records.recording import Recording
from diagnostics.signal.order_domain import speed_variation_percent
from diagnostics.signal.spectrum import noise_density, order_lines

TEETH = (18, 47)
STEPS, REVOLUTIONS = 512, 60
TURN = np.arange(STEPS * REVOLUTIONS) / STEPS


def tone(order: float, amplitude: float, phase: float = 0.3) -> np.ndarray:
    return amplitude * np.cos(2 * np.pi * order * TURN + phase)


def turns(signal: np.ndarray) -> np.ndarray:
    return signal.reshape(REVOLUTIONS, STEPS)


def test_sidebands_asymmetry_and_harmonics_of_planted_lines() -> None:
    signal = tone(18, 2.0) + tone(17, 0.2) + tone(19, 0.4) + tone(16, 0.1) + tone(20, 0.06)
    signal = signal + tone(36, 1.0) + tone(54, 4.0) + tone(72, 0.2) + tone(90, 0.02)
    found = line_levels(order_lines(turns(signal), 2.0), TEETH)
    # lines on whole bins leak nowhere with a Hann window: only rounding is left
    expected = {
        "sideband1_db": 20 * math.log10(0.3 / 2.0),
        "sideband2_db": 20 * math.log10(0.08 / 2.0),
        "asymmetry_db": 20 * math.log10(2.0),
        "harmonic2_db": 20 * math.log10(0.5),
        "harmonic3_db": 20 * math.log10(2.0),
        "harmonic4_db": -20.0,
        "harmonic5_db": -40.0,
        "strongest_sideband_db": 20 * math.log10(0.2),
    }
    assert {name: found[name] for name in expected} == pytest.approx(expected, abs=1e-6)


def test_noise_density_is_that_of_white_noise_over_a_mesh_line() -> None:
    rng = np.random.default_rng(4)
    duration_s, sigma, mesh = 2.0, 0.5, 3.0
    rate_hz = TURN.size / duration_s
    density = sigma**2 / (rate_hz / 2)
    signal = tone(18, mesh) + tone(17, 0.5) + tone(18 + 18 / 47, 0.5) + sigma * rng.standard_normal(TURN.size)
    found = noise_density(order_lines(turns(signal), duration_s), TEETH)
    # some 500 bins are kept, of which a Hann window leaves about 250 independent: 6 % is one sigma, 20 % three
    assert found == pytest.approx(density, rel=0.2)
    level = line_levels(order_lines(turns(signal), duration_s), TEETH)["noise_density_db"]
    assert level == pytest.approx(10 * math.log10(density / (0.5 * mesh**2)), abs=1.0)


def test_noise_density_of_a_record_too_short_for_gear_lines_leaves_out_the_pinion_only() -> None:
    short = tone(18, 3.0)[: 10 * STEPS] + 0.1 * np.random.default_rng(1).standard_normal(10 * STEPS)
    found = noise_density(order_lines(short.reshape(10, STEPS), 1 / 3), TEETH)
    assert found == pytest.approx(0.01 / (10 * STEPS * 3 / 2), rel=0.6)  # 80 bins, some 40 independent: 4 sigma


def test_a_signal_of_mesh_lines_and_noise_shows_no_sideband() -> None:
    rng = np.random.default_rng(5)
    signal = tone(18, 1.0) + tone(36, 1.0) + 0.3 * rng.standard_normal(TURN.size)
    assert line_levels(order_lines(turns(signal), 2.0), TEETH)["strongest_sideband_db"] == -math.inf


@pytest.mark.parametrize("wanted_db", [-4.0, 0.0, 9.0])
def test_synchronous_ratio_is_unbiased_where_few_revolutions_are_averaged(wanted_db: float) -> None:
    rng = np.random.default_rng(6)
    sigma = math.sqrt(0.5) * 10 ** (-wanted_db / 20)
    found = synchronous_ratio_db(turns(tone(18, 1.0) + sigma * rng.standard_normal(TURN.size)))
    # 30720 samples fix either variance to about 1 %, hence 0.1 dB; uncorrected, -4 dB would read -3 dB
    assert found == pytest.approx(wanted_db, abs=0.15)


def test_pure_noise_has_no_synchronous_part_and_a_pure_line_no_rest() -> None:
    rng = np.random.default_rng(7)
    found = [synchronous_ratio_db(turns(rng.standard_normal(TURN.size))) for _ in range(20)]
    assert all(math.isnan(value) or value < -15 for value in found)
    assert any(math.isnan(value) for value in found)
    assert math.isnan(synchronous_ratio_db(turns(tone(18, 1.0))))


def test_speed_variation_of_a_slow_sine_and_none_of_steady_pulses() -> None:
    time_s = np.linspace(0.0, 20.0, 200_001)
    phase = 30 * time_s + 30 * 0.01 / (2 * np.pi * 0.2) * (1 - np.cos(2 * np.pi * 0.2 * time_s))
    pulses = np.interp(np.arange(int(phase[-1])), phase, time_s)
    # 0.2 Hz passes a limit of 2.5 Hz nearly whole: 1 % amplitude is 0.707 % rms
    assert speed_variation_percent(pulses) == pytest.approx(100 * 0.01 / math.sqrt(2), rel=0.02)
    assert speed_variation_percent(np.arange(60) / 30) < 1e-10
    assert math.isnan(speed_variation_percent(np.array([0.0, 0.1])))


def test_fast_speed_ripple_is_not_slow_variation() -> None:
    pulses = np.cumsum(1 / 30 * (1 + 0.01 * np.cos(np.pi * np.arange(300))))
    # alternating +-1 % from revolution to revolution: a mean of 5 revolutions leaves a fifth, 0.2 %
    assert speed_variation_percent(pulses) == pytest.approx(0.2, rel=0.05)


def test_quantities_of_a_record_in_time_agree_with_its_lines() -> None:
    fs_hz, speed_hz = 12_800.0, 29.3
    time_s = np.arange(2 * 12_800) / fs_hz
    turn = speed_hz * time_s + 0.37
    signal = np.cos(2 * np.pi * 18 * turn) * (1 + 0.2 * np.cos(2 * np.pi * turn))
    tacho_s = (np.arange(1, int(turn[-1]) + 1) - 0.37) / speed_hz
    record = Recording({"record_id": 0}, {"a": signal}, tacho_s, fs_hz, pair_train(TEETH))
    found = record_result(record).channels["a"].values
    # amplitude modulation of index m has sidebands m/2; the ratio of six sidebands is m
    assert found["sideband1_db"] == pytest.approx(-20.0, abs=0.01)
    assert found["asymmetry_db"] == pytest.approx(0.0, abs=0.01)
    assert found["sideband_index_pinion_h1"] == pytest.approx(0.1, rel=1e-3)
    assert found["sideband_ratio_pinion_h1_k3"] == pytest.approx(0.2, rel=1e-3)
    assert found["rms"] == pytest.approx(float(np.sqrt(np.mean(signal**2))))
