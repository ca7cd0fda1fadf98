"""Recordings of the user against a set: features on known signals, what gives a set away, what lies within it."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.io import wavfile

from diagnostics.audit.reference_comparison import WindowSet, discriminator_auc, reference_comparison, reference_windows
from diagnostics.signal.window_features import FEATURES, RATE_HZ, signal_windows, window_features
from siggen.errors import UsageError


def feature(values: np.ndarray, name: str) -> float:
    return float(values[FEATURES.index(name)])


def test_features_of_gaussian_noise_and_of_a_tone_in_noise_are_those_of_the_theory() -> None:
    noise = np.random.default_rng(1).standard_normal(12_800)
    found = window_features(noise)
    assert found.size == len(set(FEATURES)) == 64
    assert feature(found, "kurtosis") == pytest.approx(3.0, abs=0.15)
    # half of the samples of white noise cross zero; mean over median of an exponential law is 1/ln 2. 250 independent
    # bins fix a median to 0.4 dB: three sigma are allowed
    assert feature(found, "rate of zero crossings") == pytest.approx(0.5, abs=0.02)
    assert feature(found, "tonality 1000-1500 Hz [dB]") == pytest.approx(10 * math.log10(1 / math.log(2)), abs=1.2)
    assert feature(found, "floor 2000-2500 Hz [dB]") == pytest.approx(10 * math.log10(math.log(2) / 6400), abs=1.2)
    # Rayleigh envelope: variation sqrt(4/pi - 1)
    assert feature(found, "envelope variation 1500-3000 Hz") == pytest.approx(math.sqrt(4 / math.pi - 1), abs=0.03)
    tone = window_features(noise + 0.5 * np.sin(2 * np.pi * 2750 * np.arange(12_800) / RATE_HZ))
    assert feature(tone, "top 2500-3000 Hz [dB]") > feature(found, "top 2500-3000 Hz [dB]") + 15
    assert feature(tone, "share of lines 2500-3000 Hz") > 0.0


def test_features_know_neither_level_nor_offset_and_windows_are_resampled() -> None:
    rng = np.random.default_rng(2)
    window = rng.standard_normal(12_800)
    assert window_features(7.0 * window + 3.0) == pytest.approx(window_features(window), rel=1e-6, abs=1e-6)
    time_s = np.arange(60_000) / 25_600.0
    windows = signal_windows(np.sin(2 * np.pi * 1000 * time_s), 25_600.0)
    assert windows.shape == (2, 12_800)
    assert np.argmax(np.abs(np.fft.rfft(windows[0]))) == 1000


def windows(owners: int, shift: float, seed: int, per_owner: int = 6, scatter: float = 1.0) -> WindowSet:
    """Owners scatter, windows scatter less; two features are shifted."""
    rng = np.random.default_rng(seed)
    middle = scatter * rng.standard_normal((owners, 64))
    middle[:, :2] += shift
    owner = np.repeat(np.arange(owners), per_owner)
    values = middle[owner] + 0.3 * rng.standard_normal((owner.size, 64))
    return WindowSet(values, owner.astype(str), np.full(owner.size, "x"))


def test_alike_recordings_lie_within_the_spread_and_shifted_features_are_ranked_first() -> None:
    alike = reference_comparison(windows(8, 0.0, 1), windows(20, 0.0, 2), 0)
    assert alike.telling == 0
    assert all(place.farther >= 0.05 for place in alike.places)
    assert 0.2 < alike.discriminator_auc < 0.8
    assert alike.gearbox_distance == pytest.approx(1.0, abs=0.15)
    apart = reference_comparison(windows(8, 5.0, 1), windows(20, 0.0, 2), 0)
    assert {gap.name for gap in apart.gaps[:2]} == set(FEATURES[:2])
    assert apart.telling == 2
    assert apart.discriminator_auc > 0.95
    far = reference_comparison(windows(4, 0.0, 1, scatter=4.0), windows(20, 0.0, 2), 0)
    assert all(place.farther == 0.0 for place in far.places)


def test_many_windows_of_few_recordings_give_no_verdict() -> None:
    assert math.isnan(discriminator_auc(windows(3, 5.0, 1, per_owner=200), windows(20, 0.0, 2), 0))


def test_a_folder_is_read_one_recording_a_file_or_subfolder_and_says_what_is_missing(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    rng = np.random.default_rng(1)
    (tmp_path / "machine").mkdir()
    for name in ("machine/a.wav", "machine/b.wav", "alone.wav"):
        wavfile.write(tmp_path / name, 12_800, rng.standard_normal(30_000).astype(np.float32))
    found = reference_windows(tmp_path)
    assert "30000 rows; 12800 Hz" in caplog.text
    assert {name: int(np.sum(found.owner == name)) for name in ("alone.wav", "machine")} == {
        "alone.wav": 2,
        "machine": 4,
    }
    assert len(found.medians()[0]) == 3
    np.save(tmp_path / "no_rate.npy", rng.standard_normal(30_000))
    with pytest.raises(UsageError, match=r"a column of times with its unit, time \[s\], or write it as WAV"):
        reference_windows(tmp_path)
    (tmp_path / "no_rate.npy").unlink()
    with pytest.raises(UsageError, match="no such folder"):
        reference_windows(tmp_path / "nothing")
    short = tmp_path / "short"
    short.mkdir()
    wavfile.write(short / "a.wav", 48_000, rng.standard_normal(30_000).astype(np.float32))
    with pytest.raises(UsageError, match="whole second"):
        reference_windows(short)
