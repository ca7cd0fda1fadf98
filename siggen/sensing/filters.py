"""Filtering in blocks of fixed length: paths as impulse responses of limited length, joined without a seam.

Overlap-save (reference: standard literature): a block's spectrum reaches as far back as the filter remembers, so that
its product with the filter's is the linear convolution and blocks join exactly. A response is sampled at frequencies
1/memory apart. Its impulse response, from `AHEAD` samples before time 0 (delays that are no whole number of samples) to
the end of the memory, fades out over the last tenth (derived). What is lost is what rings longer than the memory.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import ComplexArray, FloatArray

# Lengths of transforms and their frequencies.


def filter_length(history: int, samples: int) -> int:
    """Return the number of samples over which to transform: at least both, a product of small primes."""
    from scipy.fft import next_fast_len

    return int(next_fast_len(history + samples, real=True))


def frequencies(length: int, fs_hz: float) -> FloatArray:
    """Return the frequencies (length // 2 + 1,) [Hz] of a spectrum."""
    return np.arange(length // 2 + 1, dtype=np.float64) * (fs_hz / length)


BLOCK_SAMPLES = 65_536
"""Samples of a channel that are filtered at once. Part of the definition of a record."""
TOGETHER = 2
"""Transforms that are asked for at once: they cost a third less than one by one, and give the same values."""
AHEAD = 64
"""Samples after a block that its filters see: delays by parts of a sample ring both ways."""
FADED_SHARE = 0.1


@dataclass(frozen=True, slots=True)
class BlockGrid:
    """`memory` samples of an impulse response, `AHEAD` of them before time 0; `block` samples out of `length`."""

    memory: int
    block: int
    length: int

    @property
    def back(self) -> int:
        """Samples before a block that its filters see."""
        return self.memory - AHEAD


def block_grid(history: int, samples: int) -> BlockGrid:
    """Return the grid of a record of so many samples whose filters remember at least `history` samples."""
    # a response that remembers nothing, such as a leak from across an axis, stands at time 0: it must not fade
    memory, block = filter_length(max(history, AHEAD) + AHEAD, 0), min(samples, BLOCK_SAMPLES)
    return BlockGrid(memory, block, filter_length(memory, block))


def limited(responses: ComplexArray, grid: BlockGrid) -> NDArray[np.complex64]:
    """Return the spectra (..., length // 2 + 1) of what responses (..., memory // 2 + 1) are over their memory.

    Single precision halves what a worker holds; 6e-8 of a path is far below what its limited memory leaves out.
    """
    pulses = np.fft.irfft(responses, grid.memory)
    behind = grid.memory - AHEAD
    values = np.zeros((*pulses.shape[:-1], grid.length))
    values[..., :behind] = pulses[..., :behind]
    values[..., -AHEAD:] = pulses[..., behind:] * _rise(AHEAD)
    faded = int(FADED_SHARE * behind)
    values[..., behind - faded : behind] *= _rise(faded)[::-1]
    return np.fft.rfft(values).astype(np.complex64)


def _rise(count: int) -> FloatArray:
    """Return half a cosine from 0 to 1 (count,)."""
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / count))
