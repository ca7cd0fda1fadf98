"""Recorder: a channel that is measured block after block, with what its noise depends on known at the end alone."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.sensing.measurement import Measurement, converted, ratio_db
from siggen.sensing.spread import Spread


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
