"""Windows as another transfer path and another noise would have shown them, for training only.

Every channel of every window passes a random smooth filter: gain in dB and phase are short cosine series over
frequency. A classifier that relies on the exact balance of mesh harmonics, which belongs to the path, loses it.
Source: derived (domain randomisation).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Augmentation:
    """How far windows are changed.

    Attributes
    ----------
    gain_db : float
        Standard deviation of the filter's gain at any frequency [dB].
    phase_rad : float
        Standard deviation of its phase [rad].
    terms : int
        Terms of the cosine series; more make the filter rougher.
    noise_db : (float, float)
        Range of the added white noise against the level of the window [dB].
    """

    gain_db: float = 2.0
    phase_rad: float = 0.5
    terms: int = 8
    noise_db: tuple[float, float] = (-60.0, -30.0)


def augmented(windows: np.ndarray, chosen: Augmentation, rng: np.random.Generator) -> np.ndarray:
    """Return filtered and noisy copies.

    Parameters
    ----------
    windows : (batch, channels, samples) float32
        Of training records.
    chosen : Augmentation
        How far they are changed.
    rng : numpy.random.Generator
        Draws filters and noise.
    """
    shape = windows.shape[:2]
    spectrum = np.fft.rfft(windows, axis=2)
    place = np.arange(spectrum.shape[2]) / max(spectrum.shape[2] - 1, 1)
    series = np.cos(np.pi * np.arange(chosen.terms)[:, None] * place) / np.sqrt((1 + chosen.terms) / 2.0)
    gain = 10.0 ** (chosen.gain_db / 20.0 * (rng.standard_normal((*shape, chosen.terms)) @ series))
    phase = chosen.phase_rad * (rng.standard_normal((*shape, chosen.terms)) @ series)
    filtered = np.fft.irfft(spectrum * gain * np.exp(1j * phase), n=windows.shape[2], axis=2)
    level = np.sqrt((windows.astype(np.float64) ** 2).mean(axis=2, keepdims=True))
    noise = level * 10.0 ** (rng.uniform(*chosen.noise_db, size=(*shape, 1)) / 20.0)
    return np.asarray(filtered + noise * rng.standard_normal(windows.shape), dtype=np.float32)
