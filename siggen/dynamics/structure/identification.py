"""Stiffness and damping of a bearing, bolt or coupling from a measured resonance and the mass that moves on it.

Derived from the oscillator with one degree of freedom, m ẍ + c ẋ + k x = f: k = m ω_n², c = 2 ζ m ω_n. Paper B (Luo,
Baddour, Liang, MSSP 119 (2019) 155-181) names this step; its own equations were not read. A free decay gives ζ by the
logarithmic decrement, a resonance curve by the two frequencies at 1/√2 of the peak. Both are exact for this oscillator,
without the usual assumption of small damping: with ζ = sin φ the squares of the half-power frequencies of a
displacement are ω_n² (cos 2φ ± sin 2φ); an acceleration has the same form in 1/ω², and for a velocity ω_1 ω_2 = ω_n²,
ω_2 - ω_1 = 2 ζ ω_n.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, isfinite, pi, sin, sqrt

import numpy as np
from numpy.typing import ArrayLike

from siggen.arrays import FloatArray

QUANTITIES = ("displacement", "velocity", "acceleration")
FEWEST_PEAKS = 3


@dataclass(frozen=True, slots=True)
class Resonance:
    """Undamped natural frequency [Hz] and damping ratio of one mode.

    Raises
    ------
    ValueError
        If the frequency is not positive or the ratio outside 0 to 1.
    """

    frequency_hz: float
    damping_ratio: float

    def __post_init__(self) -> None:
        """Refuse what is no resonance."""
        if not (isfinite(self.frequency_hz) and self.frequency_hz > 0.0):
            raise ValueError(f"frequency_hz: received {self.frequency_hz}; allowed are finite values above 0")
        if not 0.0 <= self.damping_ratio < 1.0:
            raise ValueError(f"damping_ratio: received {self.damping_ratio}; allowed are 0 to below 1")


@dataclass(frozen=True, slots=True)
class Support:
    """Stiffness and damping: N/m and N s/m; of a coupling N m/rad and N m s/rad."""

    stiffness_n_per_m: float
    damping_n_s_per_m: float


def identified_support(resonance: Resonance, moving_mass_kg: float, elements: int = 1) -> Support:
    """Return one of `elements` equal supports that carry a moving mass together.

    Parameters
    ----------
    resonance : Resonance
        Measured mode in which only this mass moves on these supports.
    moving_mass_kg : float
        Mass [kg], or inertia [kg m²] of a coupling (see `series_inertia`).
    elements : int
        Supports side by side, for example 2 bearings of a shaft or 4 bolts of a casing.

    Raises
    ------
    ValueError
        If the mass is not positive or there is no element.
    """
    if not (isfinite(moving_mass_kg) and moving_mass_kg > 0.0):
        raise ValueError(f"moving_mass_kg: received {moving_mass_kg}; allowed are finite values above 0")
    if elements < 1:
        raise ValueError(f"elements: received {elements}; allowed are whole numbers from 1")
    speed = 2.0 * pi * resonance.frequency_hz
    share = moving_mass_kg / elements
    return Support(share * speed**2, 2.0 * resonance.damping_ratio * share * speed)


def series_inertia(first_kg_m2: float, second_kg_m2: float) -> float:
    """Return the inertia J_a J_b/(J_a + J_b) that swings on a coupling between two free rotors [kg m²]."""
    return first_kg_m2 * second_kg_m2 / (first_kg_m2 + second_kg_m2)


def resonance_from_decay(time_s: ArrayLike, signal: ArrayLike) -> Resonance:
    """Return the resonance of a free decay about zero, by the logarithmic decrement over all its maxima.

    Parameters
    ----------
    time_s, signal : (k,)
        Evenly sampled; displacement, velocity or acceleration decay alike. At least some 10 samples per period.

    Raises
    ------
    ValueError
        If there are fewer than 3 positive maxima, or they do not decay.
    """
    time, values = np.asarray(time_s, dtype=np.float64), np.asarray(signal, dtype=np.float64)
    when, height = _maxima(time, values)
    if when.size < FEWEST_PEAKS:
        raise ValueError(f"free decay: received {when.size} positive maxima; allowed are at least {FEWEST_PEAKS}")
    count = np.arange(when.size)
    period = float(np.polyfit(count, when, 1)[0])
    decrement = -float(np.polyfit(count, np.log(height), 1)[0])
    if decrement < 0.0:
        raise ValueError(f"free decay: received maxima that grow by exp({-decrement:.3g}) each; allowed are decays")
    ratio = decrement / sqrt(4.0 * pi**2 + decrement**2)
    return Resonance(1.0 / (period * sqrt(1.0 - ratio**2)), ratio)


def resonance_from_half_power(frequency_hz: ArrayLike, amplitude: ArrayLike, quantity: str) -> Resonance:
    """Return the resonance of the highest peak of a frequency response to a force.

    Parameters
    ----------
    frequency_hz : (k,)
        Ascending, positive.
    amplitude : (k,)
        Magnitude of response over force; some 10 points within the peak's half-power bandwidth.
    quantity : str
        What was measured: 'displacement', 'velocity' or 'acceleration'.

    Raises
    ------
    ValueError
        If the quantity is unknown, or the curve does not fall to 1/√2 of its peak on both sides.
    """
    if quantity not in QUANTITIES:
        raise ValueError(f"quantity: received {quantity!r}; allowed are {', '.join(QUANTITIES)}")
    frequency, height = np.asarray(frequency_hz, dtype=np.float64), np.asarray(amplitude, dtype=np.float64)
    low, high = _half_power(frequency, height)
    if quantity == "velocity":
        natural = sqrt(low * high)
        return Resonance(natural, (high - low) / (2.0 * natural))
    if quantity == "acceleration":
        low, high = 1.0 / high, 1.0 / low
    ratio = sin(0.5 * atan((high**2 - low**2) / (high**2 + low**2)))
    natural = sqrt(0.5 * (high**2 + low**2) / (1.0 - 2.0 * ratio**2))
    return Resonance(1.0 / natural if quantity == "acceleration" else natural, ratio)


def _maxima(time: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return times and heights of the positive maxima, by the parabola through three samples."""
    inner = np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:]) & (values[1:-1] > 0.0)) + 1
    before, at, after = values[inner - 1], values[inner], values[inner + 1]
    shift = 0.5 * (before - after) / (before - 2.0 * at + after)
    step = (time[-1] - time[0]) / (time.size - 1)
    return time[inner] + shift * step, at - 0.25 * (before - after) * shift


def _half_power(frequency: FloatArray, height: FloatArray) -> tuple[float, float]:
    peak = int(np.argmax(height))
    top = float(height[peak])
    if 0 < peak < height.size - 1:
        before, after = float(height[peak - 1]), float(height[peak + 1])
        top += 0.125 * (before - after) ** 2 / (2.0 * top - before - after)
    level = top / sqrt(2.0)
    below = np.flatnonzero(height[:peak] < level)
    above = np.flatnonzero(height[peak:] < level)
    if not (below.size and above.size):
        raise ValueError("half-power bandwidth: the curve stays above 0.707 of its peak; measure a wider range")
    left, right = int(below[-1]), peak + int(above[0])
    return _crossing(frequency, height, left, level), _crossing(frequency, height, right - 1, level)


def _crossing(frequency: FloatArray, height: FloatArray, cell: int, level: float) -> float:
    share = (level - height[cell]) / (height[cell + 1] - height[cell])
    return float(frequency[cell] + share * (frequency[cell + 1] - frequency[cell]))
