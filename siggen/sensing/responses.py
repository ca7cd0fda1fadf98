"""Measured accelerance of a path: what it must be to be usable, and its values between the measured frequencies.

Between measured frequencies real and imaginary part run as cubic splines (reference: standard literature). Causality:
the impulse response of a physical path is zero before time 0 (derived test).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.errors import counted

MEMORY_S = 0.6
"""Of a measured path: what comes later is cut off."""
LOWEST_HZ = 50.0
"""A measured response may begin up to here; below, the accelerance of anything on feet goes to zero."""
TOP_SHARE = 0.45
"""Share of the sampling rate that a response must reach: up to here bearing forces are simulated."""
LATE_SHARE = 1e-3
"""Largest share of the impulse response's energy that may come later than its memory: then 3 % of the amplitude."""
EARLY_SHARE = 0.05
"""Largest share of its energy before time 0. The cut at the highest frequency costs 1 %, a wrong sign 99 %."""
EDGE_PERIODS = 20.0
"""Periods of the highest frequency around time 0 that do not count: the cut smears an impulse over them."""


@dataclass(frozen=True, slots=True)
class FrequencyResponse:
    """Accelerance [m/s² per N] at equally spaced frequencies (k,); curves: (direction, input) -> (k,) complex."""

    frequency_hz: FloatArray
    curves: Mapping[tuple[str, str], ComplexArray]

    def accelerance(self, direction: str, inputs: Sequence[str], frequency_hz: FloatArray) -> ComplexArray:
        """Return the accelerance (inputs, m) along a direction at frequencies (m,).

        Below the measured frequencies it falls as f², as any body on feet; above it keeps its last value.

        Raises
        ------
        KeyError
            If a curve is missing.
        """
        from scipy.interpolate import CubicSpline

        known = self.frequency_hz
        inside = np.clip(frequency_hz, known[0], known[-1])
        below = np.minimum(frequency_hz / known[0], 1.0) ** 2 if known[0] > 0.0 else 1.0
        return np.array([CubicSpline(known, self.curves[direction, name])(inside) * below for name in inputs])

    def impulse_response(self, direction: str, name: str) -> tuple[FloatArray, FloatArray]:
        """Return times (m,) from minus to plus half the inverse frequency step, and the impulse response there."""
        step = self.frequency_hz[1] - self.frequency_hz[0]
        bins = np.arange(round(self.frequency_hz[-1] / step) + 1) * step
        # a taper over the highest tenth: without it the cut rings over the whole length
        taper = 0.5 + 0.5 * np.cos(np.pi * np.clip((bins / bins[-1] - 0.9) / 0.1, 0.0, 1.0))
        values = np.fft.irfft(self.accelerance(direction, (name,), bins)[0] * taper)
        times = (np.arange(values.size) - values.size // 2) / (values.size * step)
        return times, np.roll(values, values.size // 2)


def grid_problems(frequency_hz: FloatArray, fs_hz: float) -> Iterator[tuple[str, str]]:
    """Yield (received, allowed) of frequencies that are no grid over the band of records at `fs_hz`."""
    steps = np.diff(frequency_hz)
    if frequency_hz.size < 16 or not np.isfinite(frequency_hz).all() or frequency_hz[0] < 0.0:
        yield f"{frequency_hz.size} frequencies", "allowed: at least 16 finite frequencies from 0"
    elif not (steps[0] > 0.0 and np.allclose(steps, steps[0], rtol=1e-3, atol=0.0)):
        yield f"steps from {steps.min():g} to {steps.max():g} Hz", "allowed: ascending, equally spaced frequencies"
    elif frequency_hz[0] > LOWEST_HZ or frequency_hz[-1] < TOP_SHARE * fs_hz:
        received = f"{frequency_hz[0]:g} to {frequency_hz[-1]:g} Hz"
        yield received, f"allowed: from at most {LOWEST_HZ:g} Hz to at least {TOP_SHARE * fs_hz:g} Hz (0.45 fs_hz)"


def curve_problems(
    response: FrequencyResponse, direction: str, name: str, memory_s: float
) -> Iterator[tuple[str, str]]:
    """Yield (received, allowed) of a curve that is not finite, not causal, or rings longer than `memory_s`."""
    curve = response.curves[direction, name]
    if not np.isfinite(curve).all():
        yield f"{counted(int((~np.isfinite(curve)).sum()), 'value')} not finite", "allowed: finite numbers"
        return
    if not curve.any():
        return
    times, values = response.impulse_response(direction, name)
    energy, edge = values**2, EDGE_PERIODS / response.frequency_hz[-1]
    early = energy[times < -edge].sum() / energy.sum()
    if early > EARLY_SHARE:
        allowed = (
            f"allowed: at most {EARLY_SHARE:.0%}, a cause before its effect; is the phase of the other sign (it falls "
            "with frequency), or the frequency step too wide for the damping?"
        )
        yield f"{early:.0%} of the impulse response's energy before time 0", allowed
        return
    late_from = min(memory_s, 0.4 / (response.frequency_hz[1] - response.frequency_hz[0]))
    late = energy[times > late_from].sum() / energy.sum()
    if late > LATE_SHARE:
        allowed = f"allowed: at most {LATE_SHARE:g}; measure with a finer frequency step"
        yield f"{late:.2g} of the impulse response's energy after {late_from:.3g} s", allowed


# Frequency responses of an accelerometer: resonance on its mounting or of itself, coupling capacitor.
#
# Sources: second-order resonator 1 / (1 - x² + 2 i ζ x), x = f/f_0, and first-order high-pass i x / (1 + i x), x =
# f/f_c (reference: standard literature).


def resonance_response(frequency_hz: FloatArray, natural_hz: float, damping_ratio: float) -> ComplexArray:
    """Return reading over base motion (k,) of a mass on a spring at frequencies (k,)."""
    x = frequency_hz / natural_hz
    return np.asarray(1.0 / (1.0 - x**2 + 2j * damping_ratio * x), dtype=np.complex128)


def high_pass_response(frequency_hz: FloatArray, corner_hz: float) -> ComplexArray:
    """Return the response (k,) of a coupling capacitor: 0 at frequency 0, -3 dB at the corner."""
    x = 1j * frequency_hz / corner_hz
    return x / (1.0 + x)
