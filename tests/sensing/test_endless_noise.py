"""Noise without end has the density that was asked for, from its first value on, however it is cut into parts."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.signal import welch

from siggen.sensing.modulation import LevelCourse
from siggen.sensing.noise import PinkStream, ShapedNoise, shape_taps

FS = 25600.0


def shape(frequency_hz: np.ndarray) -> np.ndarray:
    """A floor that rises below 200 Hz, and a hump at 3 kHz."""
    above = np.maximum(frequency_hz, frequency_hz[1])
    return 1e-3 * np.sqrt(1.0 + (200.0 / above) ** 2) * (1.0 + 4.0 * np.exp(-(((above - 3000.0) / 500.0) ** 2)))


def shaped(seed: int = 1) -> ShapedNoise:
    return ShapedNoise(shape_taps(shape, 4096, FS), FS, np.random.default_rng(seed))


def pink(seed: int = 1, high_pass_hz: float | None = None) -> PinkStream:
    return PinkStream(1e-3, 100.0, high_pass_hz, FS, np.random.default_rng(seed))


@pytest.mark.parametrize("stream", [shaped, pink, lambda: LevelCourse(0.5, 40.0, np.random.default_rng(2))])
def test_parts_of_any_length_are_one_noise(stream: Callable[[], ShapedNoise | PinkStream | LevelCourse]) -> None:
    once, parts = stream(), stream()
    whole = once.take(9000)
    joined = np.concatenate([parts.take(count) for count in (1, 4999, 4000)])
    # transforms of other lengths round otherwise
    np.testing.assert_allclose(joined, whole, atol=1e-12 * whole.std() + 1e-15, rtol=1e-12)


@pytest.mark.parametrize(
    ("noise", "density"),
    [
        (shaped(), shape),
        (pink(), lambda f: 1e-3 * np.sqrt(100.0 / f)),
        (pink(high_pass_hz=30.0), lambda f: 1e-3 * np.sqrt(100.0 / f) / np.hypot(1.0, 30.0 / f)),
    ],
)
def test_the_density_is_the_one_asked_for(
    noise: ShapedNoise | PinkStream, density: Callable[[np.ndarray], np.ndarray]
) -> None:
    values = np.concatenate([noise.take(65_536) for _ in range(16)])
    frequency_hz, power = welch(values, FS, nperseg=8192)
    for low, high in ((30.0, 100.0), (100.0, 400.0), (400.0, 2500.0), (2500.0, 4000.0)):
        band = (frequency_hz >= low) & (frequency_hz < high)
        ratio = float((power[band] / density(frequency_hz[band]) ** 2).mean())
        # 250 averages and 20 bins or more: 1.5 % of scatter; taps and poles shape within 2 % of the amplitude
        assert ratio == pytest.approx(1.0, abs=0.07)


def test_pink_noise_is_stationary_from_its_start() -> None:
    first = np.array([pink(seed, 0.7).take(1)[0] for seed in range(1500)])
    variance = pink(11, 0.7).take(2_000_000).var()
    # 1,500 first values: 4 % of scatter, three times that
    assert first.var() == pytest.approx(variance, rel=0.15)
