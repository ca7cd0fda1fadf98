"""Recorder: a channel that is measured block after block, with what its noise depends on known at the end alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from siggen.arrays import FloatArray
from siggen.sensing.measurement import Measurement, converted, ratio_db
from siggen.sensing.spread import Spread


class Recorder:
    """Takes the acceleration of a channel in order and keeps it behind the gain as float32, 6e-8 of its size."""

    def __init__(self, samples: int, gain: float) -> None:
        self._kept = np.empty(samples, dtype=np.float32)
        self._gain, self._done = gain, 0
        self._spread = Spread()

    def take(self, block_m_s2: FloatArray) -> None:
        """Take the next samples.

        Raises
        ------
        ValueError
            If they are not finite.
        """
        if not np.isfinite(block_m_s2).all():
            raise ValueError("block_m_s2: received values that are not finite; allowed are finite accelerations")
        amplified = self._gain * block_m_s2
        self._kept[self._done : self._done + amplified.size] = amplified
        self._done += amplified.size
        self._spread.take(amplified)

    def measured(
        self,
        *,
        range_m_s2: float,
        bits: int | None,
        rng: np.random.Generator,
        noise_floor_m_s2: float | None,
        snr_db: float | None,
        added: Callable[[int, int], FloatArray | None],
        block: int,
    ) -> Measurement:
        """Return the stored channel, as `measurement.measure` does; `added` gives what comes behind the gain.

        Noise and `added(first, count)` come in blocks of `block` samples. It uses up what was kept.
        """
        rms = self._spread.std
        floor = noise_floor_m_s2 if snr_db is None else rms / 10.0 ** (snr_db / 20.0)
        clipped, step = 0, 0.0
        for first in range(0, self._done, block):
            part = self._kept[first : first + block]
            noisy = part.astype(np.float64)
            if floor is not None:
                noisy += floor * rng.standard_normal(part.size)
            more = added(first, part.size)
            if more is not None:
                noisy += more
            part[:], beyond, step = converted(noisy, range_m_s2, bits)
            clipped += beyond
        self._kept.setflags(write=False)
        return Measurement(self._kept, float(floor or 0.0), ratio_db(rms, floor or 0.0), clipped / self._done, step)
