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


def measure(
    signal_m_s2: NDArray[np.float64],
    *,
    gain: float,
    range_m_s2: float,
    bits: int | None,
    rng: np.random.Generator,
    noise_floor_m_s2: float | None = None,
    snr_db: float | None = None,
    disturbance_m_s2: NDArray[np.float64] | None = None,
) -> Measurement:
    """Return the channel stored for an acceleration (n,).

    Parameters
    ----------
    gain : factor on the signal, before the noise
    range_m_s2 : values beyond ± this are clipped
    bits : of the converter, 2 to 24, or None for no quantisation
    noise_floor_m_s2, snr_db : standard deviation of white noise, or its level below the signal; neither: no noise
    disturbance_m_s2 : (n,) what the surroundings and the electronics add besides, behind the gain; None: nothing

    Raises
    ------
    ValueError
        If an argument is outside its allowed range or the signal is not finite.
    """
    _check(signal_m_s2, gain=gain, range_m_s2=range_m_s2, bits=bits, noise_floor_m_s2=noise_floor_m_s2, snr_db=snr_db)
    amplified = gain * signal_m_s2
    rms = float(np.std(amplified))
    floor = noise_floor_m_s2 if snr_db is None else rms / 10.0 ** (snr_db / 20.0)
    noisy = amplified if floor is None else amplified + floor * rng.standard_normal(amplified.size)
    noisy = noisy if disturbance_m_s2 is None else noisy + disturbance_m_s2
    stored, clipped, step = converted(noisy, range_m_s2, bits)
    stored.setflags(write=False)
    return Measurement(
        accel_m_s2=stored,
        noise_floor_m_s2=float(floor or 0.0),
        snr_db=ratio_db(rms, floor or 0.0),
        clipped_share=clipped / stored.size,
        step_m_s2=step,
    )


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


def _check(
    signal_m_s2: NDArray[np.float64],
    *,
    gain: float,
    range_m_s2: float,
    bits: int | None,
    noise_floor_m_s2: float | None,
    snr_db: float | None,
) -> None:
    if signal_m_s2.ndim != 1 or signal_m_s2.size == 0 or not np.isfinite(signal_m_s2).all():
        raise ValueError(f"signal_m_s2: received shape {signal_m_s2.shape}; allowed are finite one-dimensional signals")
    if not math.isfinite(gain):
        raise ValueError(f"gain: received {gain}; allowed are finite factors")
    if not range_m_s2 > 0.0 or (bits is not None and math.isinf(range_m_s2)):
        raise ValueError(f"range_m_s2: received {range_m_s2}; allowed are values above 0, finite ones if quantised")
    if bits is not None and not 2 <= bits <= MAX_BITS:
        raise ValueError(f"bits: received {bits}; allowed are 2 to {MAX_BITS}, or None")
    if noise_floor_m_s2 is not None and snr_db is not None:
        raise ValueError(f"noise: received floor {noise_floor_m_s2} and {snr_db} dB; allowed is one of them")
    if noise_floor_m_s2 is not None and not (math.isfinite(noise_floor_m_s2) and noise_floor_m_s2 >= 0.0):
        raise ValueError(f"noise_floor_m_s2: received {noise_floor_m_s2}; allowed are finite values from 0")
    if snr_db is not None and not math.isfinite(snr_db):
        raise ValueError(f"snr_db: received {snr_db}; allowed are finite ratios")
