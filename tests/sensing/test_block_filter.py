"""Filters of limited length: blocks join without a seam, and what the limit leaves out is small and known."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.sensing.filters import AHEAD, BlockGrid, block_grid, frequencies, limited
from tests.sensing.resonances import accelerance

FS = 25600.0


def path(frequency_hz: np.ndarray) -> np.ndarray:
    """Two modes and a delay of 1.3 samples: what a sensor on a housing sees, and what rings before time 0."""
    found = accelerance(frequency_hz, (320.0, 2000.0), (0.05, 0.00128))
    return found * np.exp(-2j * np.pi * frequency_hz * 1.3 / FS)


def filtered(force: np.ndarray, grid: BlockGrid) -> np.ndarray:
    """Return the force behind its first `back` and before its last AHEAD values as its blocks see it."""
    response = limited(path(frequencies(grid.memory, FS)), grid)
    parts = []
    for first in range(0, force.size - grid.back - AHEAD, grid.block):
        values = np.zeros(grid.length)
        seen = force[first : first + grid.back + grid.block + AHEAD]
        values[: seen.size] = seen
        parts.append(np.fft.irfft(np.fft.rfft(values) * response, grid.length)[grid.back : grid.back + grid.block])
    return np.concatenate(parts)[: force.size - grid.back - AHEAD]


@pytest.fixture(scope="module")
def force() -> np.ndarray:
    """Up to 0.45 of the sampling rate, as motions and forces are: a delay breaks off at half of it."""
    spectrum = np.fft.rfft(np.random.default_rng(4).standard_normal(40_000))
    spectrum[18_000:] = 0.0
    return np.fft.irfft(spectrum)


def test_blocks_of_any_length_give_one_convolution(force: np.ndarray) -> None:
    whole = block_grid(6000, 30_000)
    once = filtered(force, whole)
    for block in (700, 4096, 10_007):
        parts = filtered(force, block_grid(6000, block))
        # filters are kept in single precision: 6e-8 of a value, with a random sign
        assert np.abs(parts - once).max() < 1e-6 * once.std()


def test_a_limited_memory_costs_what_rings_longer(force: np.ndarray) -> None:
    """Against a filter over the whole record: e^(-ζωT) of the slowest mode, 320 Hz at 2 %, is left after T."""
    longest = filtered(force, block_grid(25_000, 10_000))
    count = longest.size
    for history, left in ((2560, np.exp(-0.02 * 2.0 * np.pi * 320.0 * 0.09)), (6000, 1e-4)):
        short = filtered(force, block_grid(history, 10_000))[-count:]
        assert np.sqrt(np.mean((short - longest) ** 2)) < 1.5 * left * longest.std()
