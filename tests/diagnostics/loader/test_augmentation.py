"""Random paths change the balance of harmonics and little else."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.loader.augmentation import Augmentation, augmented


def windows(count: int) -> np.ndarray:
    angle = np.arange(2304) / 288.0
    tone = np.cos(2 * np.pi * 18 * angle) + 0.5 * np.cos(2 * np.pi * 36 * angle)
    return np.tile(tone.astype(np.float32), (count, 2, 1))


def test_gains_scatter_as_stated_and_noise_stays_in_its_range() -> None:
    chosen = Augmentation(gain_db=3.0, noise_db=(-60.0, -50.0))
    found = augmented(windows(400), chosen, np.random.default_rng(0))
    assert found.dtype == np.float32
    spectrum = np.abs(np.fft.rfft(found, axis=2)) / 1152.0
    gain_db = 20.0 * np.log10(spectrum[:, :, 144])
    # 800 draws fix a standard deviation to 2.5 %; the cosine series varies over frequency by up to 40 %
    assert 1.8 < gain_db.std() < 4.5
    assert abs(gain_db.mean()) < 0.6
    rest = np.delete(spectrum, [144, 288], axis=2)
    assert 20 * np.log10(rest.max()) < -50.0
    balance = spectrum[:, :, 288] / spectrum[:, :, 144]
    assert balance.std() > 0.05


def test_without_strength_windows_come_back() -> None:
    none = Augmentation(gain_db=0.0, phase_rad=0.0, noise_db=(-200.0, -200.0))
    np.testing.assert_allclose(augmented(windows(2), none, np.random.default_rng(0)), windows(2), atol=1e-5)


def test_the_same_generator_gives_the_same_windows() -> None:
    first, second = (augmented(windows(2), Augmentation(), np.random.default_rng(1)) for _ in range(2))
    np.testing.assert_array_equal(first, second)
    assert not np.array_equal(first[0, 0], first[0, 1])  # every channel has a path of its own
    assert first.std() == pytest.approx(windows(1).std(), rel=0.5)
