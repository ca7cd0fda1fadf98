"""OrderSpectrum: amplitudes of a record over whole revolutions of a shaft."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.signal.order_domain import SAMPLES_PER_TOOTH, angle_grid, resample_to_angle
from diagnostics.signal.synchronous_average import hann_weights


@dataclass(frozen=True, slots=True)
class OrderSpectrum:
    """Hann spectrum of a record over whole pinion revolutions: pinion orders (n,) and amplitudes (n,) [m/s^2]."""

    order: np.ndarray
    amplitude_m_s2: np.ndarray
    revolutions: int


def order_spectrum(signal: np.ndarray, tacho_s: np.ndarray, fs_hz: float, teeth_pinion: int) -> OrderSpectrum:
    """Return the Hann spectrum of a record over all its whole pinion revolutions."""
    from scipy import fft

    grid = angle_grid(tacho_s, teeth_pinion * SAMPLES_PER_TOOTH)
    steps = resample_to_angle(signal, fs_hz, grid)
    amplitude = 4.0 * np.abs(fft.rfft(steps * hann_weights(steps.size))) / steps.size
    return OrderSpectrum(np.arange(amplitude.size) / grid.revolutions, amplitude, grid.revolutions)


def strongest_harmonic(spectrum: OrderSpectrum, teeth_pinion: int) -> int:
    """Return the mesh harmonic with the largest line among those whose sidebands lie inside the band."""
    bins = np.arange(teeth_pinion, int(spectrum.order[-1]) - teeth_pinion, teeth_pinion) * spectrum.revolutions
    return int(spectrum.amplitude_m_s2[bins].argmax()) + 1
