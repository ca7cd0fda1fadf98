"""Measurement: what a data logger stores of a quantity, in its unit, clipped and quantised; `recorder` adds noise.

Model: standard measurement chain (reference: standard literature); the power-of-two step is derived: it makes every
stored value an exact float32.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Measurement:
    """A stored channel with the labels of its chain.

    Attributes
    ----------
    values : (n,) float32, read-only; exactly on the grid of `step` if quantised
    noise_floor : standard deviation of the added noise
    snr_db : rms of the amplified signal about its mean over the noise floor; inf without noise, -inf without signal
    clipped_share : share of samples that were beyond the range
    step : quantisation step, 0 without quantisation
    """

    values: NDArray[np.float32]
    noise_floor: float
    snr_db: float
    clipped_share: float
    step: float


def converted(analogue: NDArray[np.float64], limit: float, bits: int | None) -> tuple[NDArray[np.float32], int, float]:
    """Return what a converter stores (n,), how many values were clipped, and its step, 0 without quantisation."""
    step = converter_step(limit, bits)
    on_grid = math.floor(limit / step) * step if step else limit
    clipped = int((np.abs(analogue) > on_grid).sum())
    kept = np.clip(analogue, -on_grid, on_grid)
    return (np.round(kept / step) * step if step else kept).astype(np.float32), clipped, step


def converter_step(limit: float, bits: int | None) -> float:
    """Return the step of a converter of so many bits over plus and minus a limit, 0 without quantisation."""
    return 0.0 if bits is None else power_of_two_from(2.0 * limit / 2.0**bits)


def power_of_two_from(value: float) -> float:
    """Return the smallest power of two that is at least `value` > 0."""
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent - 1 if mantissa == 0.5 else exponent)


def ratio_db(rms: float, floor: float) -> float:
    """Return the level of a signal over a noise floor [dB]."""
    if floor == 0.0:
        return math.inf
    return 20.0 * math.log10(rms / floor) if rms > 0.0 else -math.inf
