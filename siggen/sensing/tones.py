"""Lines that have nothing to do with the gears: mains hum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry

BLOCK_SAMPLES = 256
"""Samples whose cosines are taken once; about the square root of a record's length."""


@dataclass(frozen=True, slots=True)
class Lines:
    """Sinusoids a cos(2π f t + φ); arrays are (lines,)."""

    frequency_hz: FloatArray
    amplitude: FloatArray
    phase_rad: FloatArray

    @property
    def rms(self) -> float:
        """Root mean square of all lines together, of different frequencies."""
        return float(np.sqrt(0.5 * (self.amplitude**2).sum()))


def harmonic_lines(fundamental_hz: float, amplitude: float, harmonics: int, rng: np.random.Generator) -> Lines:
    """Return harmonics 1.. of amplitude 1/h, with random phases."""
    order = np.arange(1.0, harmonics + 1.0)
    return Lines(fundamental_hz * order, amplitude / order, _phases(harmonics, rng))


def lines_signal(lines: Lines, fs_hz: float, samples: int, first: int = 0) -> FloatArray:
    """Return the lines (samples,) from sample `first` on.

    Lines from half the sampling rate on are left out, as the anti-aliasing filter of a recorder does.
    """
    signal = np.zeros(samples)
    phasors = lines.amplitude * np.exp(1j * lines.phase_rad)
    for frequency, phasor in zip(lines.frequency_hz, phasors, strict=True):
        if frequency < 0.5 * fs_hz:
            step_rad = 2.0 * np.pi * frequency / fs_hz
            _add_line(signal, step_rad, abs(phasor), float(np.angle(phasor)) + step_rad * first)
    return signal


@entry(cache=True)
def _add_line(signal: FloatArray, step_rad: float, amplitude: float, phase_rad: float) -> None:
    """Add a cos(step i + phase), as a cos(p) cos(step k) - a sin(p) sin(step k) with the phase p at a block's start."""
    cosine, sine = np.empty(BLOCK_SAMPLES), np.empty(BLOCK_SAMPLES)
    for k in range(BLOCK_SAMPLES):
        cosine[k], sine[k] = np.cos(step_rad * k), np.sin(step_rad * k)
    for first in range(0, signal.size, BLOCK_SAMPLES):
        phase = step_rad * first + phase_rad
        real, imaginary = amplitude * np.cos(phase), amplitude * np.sin(phase)
        for k in range(min(BLOCK_SAMPLES, signal.size - first)):
            signal[first + k] += real * cosine[k] - imaginary * sine[k]


def _phases(count: int, rng: np.random.Generator) -> FloatArray:
    return rng.uniform(0.0, 2.0 * np.pi, count)
