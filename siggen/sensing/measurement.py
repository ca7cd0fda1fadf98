"""Measurement: what a data logger stores of a quantity, in its unit, clipped and quantised; `recorder` adds noise.

Model: standard measurement chain (reference: standard literature); the power-of-two step is derived: it makes every
stored value an exact float32.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray


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


# Spread: mean and standard deviation of values that come in parts.


class Spread:
    """Of parts joined: squares about the mean of two parts are those of each and (m_2 - m_1)² n_1 n_2 / n (derived).

    One part gives the last bit that numpy gives.
    """

    def __init__(self) -> None:
        self._count, self._mean, self._squares = 0, 0.0, 0.0

    def take(self, values: FloatArray) -> None:
        """Add values (k,), from 1 on."""
        before, mean = self._count, float(values.mean())
        self._count += values.size
        squares = float(((values - mean) ** 2).sum())
        if before:
            squares += self._squares + (mean - self._mean) ** 2 * before * values.size / self._count
            mean = self._mean + (mean - self._mean) * values.size / self._count
        self._mean, self._squares = mean, squares

    @property
    def std(self) -> float:
        """Standard deviation of all values taken."""
        return math.sqrt(self._squares / self._count)

    @property
    def mean(self) -> float:
        """Mean of all values taken."""
        return self._mean


# Recorder: a channel that is measured block after block, with what its noise depends on known at the end alone.


class Recorder:
    """Takes the quantity of a channel in order and keeps it behind the gain as float32, 6e-8 of its size."""

    def __init__(self, samples: int, gain: float) -> None:
        self._kept = np.empty(samples, dtype=np.float32)
        self._gain, self._done = gain, 0
        self._spread = Spread()

    def take(self, block: FloatArray) -> None:
        """Take the next samples.

        Raises
        ------
        ValueError
            If they are not finite.
        """
        if not np.isfinite(block).all():
            raise ValueError("block: received values that are not finite; allowed are finite values")
        amplified = self._gain * block
        self._kept[self._done : self._done + amplified.size] = amplified
        self._done += amplified.size
        self._spread.take(amplified)

    def begin_conversion(
        self,
        *,
        limit: float,
        bits: int | None,
        rng: np.random.Generator,
        noise_floor: float | None,
    ) -> None:
        """Say how `convert` turns what was taken into what is stored.

        Parameters
        ----------
        limit : float
            Values beyond it are clipped.
        bits : int or None
            Of the converter; None: not quantised.
        rng : Generator
            Of the white noise.
        noise_floor : float or None
            Its standard deviation; None without.
        """
        self._limit, self._bits, self._rng = limit, bits, rng
        self._rms = self._spread.std
        self._floor = noise_floor
        self._clipped, self._step, self._done = 0, 0.0, 0

    def convert(self, count: int, added: FloatArray | None) -> None:
        """Convert the next samples with their white noise and what is added behind the gain (count,)."""
        part = self._kept[self._done : self._done + count]
        noisy = part.astype(np.float64)
        if self._floor is not None:
            noisy += self._floor * self._rng.standard_normal(count)
        if added is not None:
            noisy += added
        part[:], clipped, self._step = converted(noisy, self._limit, self._bits)
        self._clipped += clipped
        self._done += count

    def measurement(self) -> Measurement:
        """Return the stored channel, once all was converted."""
        self._kept.setflags(write=False)
        floor = self._floor or 0.0
        return Measurement(self._kept, float(floor), ratio_db(self._rms, floor), self._clipped / self._done, self._step)
