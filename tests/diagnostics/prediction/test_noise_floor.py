"""Roughness of the floor: scatter alone for white noise, the analytic value behind a mode, blind to gains and lines."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.prediction.noise_floor import BAND_HZ, BIN_HZ, DIFFERENCE, QUANTILE, ROUGHNESS, floor_roughness

FS_HZ = 6_400.0
LONG_S = 60


def white(seed: int, duration_s: float = LONG_S) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(round(duration_s * FS_HZ))


def log_gain(frequency_hz: np.ndarray, natural_hz: float, damping: float) -> np.ndarray:
    """Return the log of the squared gain of one mode."""
    x = frequency_hz / natural_hz
    return np.asarray(-np.log((1 - x**2) ** 2 + (2 * damping * x) ** 2))


def behind_mode(noise: np.ndarray, natural_hz: float, damping: float) -> np.ndarray:
    frequency_hz = np.fft.rfftfreq(noise.size, 1 / FS_HZ)
    gain = np.exp(0.5 * log_gain(frequency_hz, natural_hz, damping))
    return np.fft.irfft(np.fft.rfft(noise) * gain, noise.size)


def analytic_level(natural_hz: float, damping: float) -> np.ndarray:
    """Return the log gain of every bin at the quantile that is taken, its mean taken off."""
    lows = np.arange(BAND_HZ[0], BAND_HZ[1] - 1.0, BIN_HZ)
    bins = [np.quantile(log_gain(np.linspace(low, low + BIN_HZ, 200), natural_hz, damping), QUANTILE) for low in lows]
    return np.array(bins) - np.mean(bins)


def off_line(level: np.ndarray) -> np.ndarray:
    x = np.log(BAND_HZ[0] + BIN_HZ * (np.arange(level.size) + 0.5))
    return level - np.polyval(np.polyfit(x, level, 1), x)


@pytest.mark.parametrize("duration_s", [15, 60])
def test_white_noise_is_as_rough_as_the_estimate_scatters(duration_s: int) -> None:
    found = floor_roughness({name: white(k, duration_s) for k, name in enumerate("abcd")}, FS_HZ)
    # N half-overlapping Hann segments count as N/(1 + 2/36). The lower 30 % of 16 bins, neighbours of which fall below
    # it together (correlation of the indicators 0.27), scatter by sqrt(0.3 0.7 1.57/16)/0.348 = 0.41 of one bin.
    expected = 0.41 / np.sqrt((4 * duration_s - 1) / (1 + 2 / 36))
    # four times 20 degrees of freedom: a root mean square scatters by 1/sqrt(160) = 8 %
    assert found[ROUGHNESS] == pytest.approx(expected, rel=0.25)
    assert found[DIFFERENCE] == pytest.approx(expected * np.sqrt(3 / 4), rel=0.25)


@pytest.mark.parametrize("damping", [0.02, 0.04, 0.2])
def test_a_mode_makes_the_floor_as_rough_as_its_gain(damping: float) -> None:
    found = floor_roughness({"a": behind_mode(white(7), 700.0, damping)}, FS_HZ)
    expected = np.sqrt(np.mean(off_line(analytic_level(700.0, damping)) ** 2))
    # scatter 0.027 adds in quadrature; a Hann window 6 Hz wide fills up slopes of peaks 28 Hz wide by some per cent
    assert found[ROUGHNESS] == pytest.approx(expected, rel=0.05)
    assert DIFFERENCE not in found


def test_light_damping_is_rougher_than_heavy() -> None:
    light, heavy = (floor_roughness({"a": behind_mode(white(3), 700.0, z)}, FS_HZ)[ROUGHNESS] for z in (0.02, 0.2))
    assert light > 2.0 * heavy


def test_channels_differ_by_their_modes_and_not_by_their_gains() -> None:
    noise, ratios = white(5), (0.03, 0.03)
    first, second = (behind_mode(noise, f, z) for f, z in zip((600.0, 900.0), ratios, strict=True))
    same = floor_roughness({"a": first, "b": 30.0 * first}, FS_HZ)
    assert same[DIFFERENCE] < 1e-9
    assert same[ROUGHNESS] == pytest.approx(floor_roughness({"a": first}, FS_HZ)[ROUGHNESS], rel=1e-9)
    # of two channels, each lies half their difference off the mean
    expected = 0.5 * np.std(analytic_level(600.0, 0.03) - analytic_level(900.0, 0.03))
    assert floor_roughness({"a": first, "b": second}, FS_HZ)[DIFFERENCE] == pytest.approx(expected, rel=0.05)


def test_lines_of_both_shafts_do_not_make_a_floor_rough() -> None:
    noise, rng = white(9), np.random.default_rng(10)
    time_s = np.arange(noise.size) / FS_HZ
    orders_hz = np.unique(np.r_[35.0 * np.arange(1, 90), 35.0 * 18 / 47 * np.arange(1, 235)])
    lines = sum(rng.uniform(0.05, 0.5) * np.cos(2 * np.pi * f * time_s + rng.uniform(0, 7)) for f in orders_hz)
    plain, with_lines = (floor_roughness({"a": x}, FS_HZ)[ROUGHNESS] for x in (noise, noise + lines))
    mode = np.sqrt(np.mean(off_line(analytic_level(700.0, 0.04)) ** 2))
    # Lines of up to 20 dB at every order of both shafts stand in about half of every bin, unevenly: the quantile rises
    # with them here and there, but by far less than behind a mode.
    assert plain < with_lines < 0.3 * mode


@pytest.mark.parametrize(("fs_hz", "samples"), [(2_560.0, 25_600), (6_400.0, 640)])
def test_nothing_is_said_where_rate_or_length_do_not_reach(fs_hz: float, samples: int) -> None:
    assert floor_roughness({"a": np.random.default_rng(0).standard_normal(samples)}, fs_hz) == {}


def test_a_silent_channel_gives_numbers() -> None:
    found = floor_roughness({"a": np.zeros(64_000), "b": white(1)}, FS_HZ)
    assert np.isfinite(list(found.values())).all()
