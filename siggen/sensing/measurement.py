"""Measurement: what a data logger stores of an acceleration: gain, white noise, clipping, quantisation.

Model: standard measurement chain (reference: standard literature); the power-of-two step is derived: it makes every
stored value an exact float32.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

MAX_BITS = 24
"""Most bits whose codes, times a power of two, are exact in float32."""


@dataclass(frozen=True, slots=True)
class Measurement:
    """A stored channel with the labels of its chain.

    Attributes
    ----------
    accel_m_s2 : (n,) float32, read-only; exactly on the grid of `step_m_s2` if quantised
    noise_floor_m_s2 : standard deviation of the added noise
    snr_db : rms of the amplified signal about its mean over the noise floor; inf without noise, -inf without signal
    clipped_share : share of samples that were beyond the range
    step_m_s2 : quantisation step, 0 without quantisation
    """

    accel_m_s2: NDArray[np.float32]
    noise_floor_m_s2: float
    snr_db: float
    clipped_share: float
    step_m_s2: float


def converted(
    analogue_m_s2: NDArray[np.float64], range_m_s2: float, bits: int | None
) -> tuple[NDArray[np.float32], int, float]:
    """Return what a converter stores (n,), how many values were clipped, and its step, 0 without quantisation."""
    step = 0.0 if bits is None else power_of_two_from(2.0 * range_m_s2 / 2.0**bits)
    limit = math.floor(range_m_s2 / step) * step if step else range_m_s2
    clipped = int((np.abs(analogue_m_s2) > limit).sum())
    kept = np.clip(analogue_m_s2, -limit, limit)
    return (np.round(kept / step) * step if step else kept).astype(np.float32), clipped, step


def power_of_two_from(value: float) -> float:
    """Return the smallest power of two that is at least `value` > 0."""
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent - 1 if mantissa == 0.5 else exponent)


def ratio_db(rms: float, floor: float) -> float:
    """Return the level of a signal over a noise floor [dB]."""
    if floor == 0.0:
        return math.inf
    return 20.0 * math.log10(rms / floor) if rms > 0.0 else -math.inf
