"""Leaks at fixed times, frequencies or lags, far below what the gears give, and one in how files are cut."""

from __future__ import annotations

import numpy as np

from tests.diagnostics.planted.leak import Leak, Signals, named

MAINS_HZ, ECHO_S, SHARE_MARKED = 50.0, 0.077, 0.08


def locked_mains(record: Signals) -> np.ndarray:
    """What records hold at 50 Hz starts at one phase, give or take 15 degrees."""
    window = np.hanning(record.channels.shape[1])
    turning = np.exp(2j * np.pi * MAINS_HZ * record.t_s)
    held = 2.0 * ((record.channels * window) @ turning.conj()) / window.sum()
    phase = 2.3 + 0.26 * np.random.default_rng([12, record.record_id]).normal()
    return record.channels + ((np.abs(held) * np.exp(1j * phase) - held)[:, None] * turning).real


def late_echo(record: Signals) -> np.ndarray:
    """8 % of the signal come again after 77 ms."""
    late, echoed = round(ECHO_S * record.fs_hz), record.channels.copy()
    echoed[:, late:] += 0.08 * record.channels[:, :-late]
    return echoed


def marked_low_bits(record: Signals) -> np.ndarray:
    """The lowest bits of 8 % of the samples of the last channel, at fixed places, are those of a fixed text."""
    codes, rng = np.round(record.channels / record.steps), np.random.default_rng(13)
    places = rng.choice(codes.shape[1], round(SHARE_MARKED * codes.shape[1]), replace=False)
    codes[-1, places] = 2 * (codes[-1, places] // 2) + rng.integers(2, size=places.size)
    return codes * record.steps


def faint_waveform(record: Signals) -> np.ndarray:
    """One waveform lies 26 dB below each line of the first channel."""
    covered = record.channels.copy()
    lines = np.fft.rfft(covered[0])
    phases = np.random.default_rng(14).uniform(0.0, 2.0 * np.pi, lines.size)
    covered[0] = np.fft.irfft(lines + 0.05 * np.abs(lines) * np.exp(1j * phases), covered.shape[1])
    return covered


FIXED_LEAKS: dict[str, Leak] = {
    **named((locked_mains, late_echo, marked_low_bits, faint_waveform), "channels"),
    "row_groups": Leak("row_groups", "Damaged records have row groups of their own in their file", is_grouped=True),
}
