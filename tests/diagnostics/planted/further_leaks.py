"""Twenty further leaks: ten of families that an earlier audit did not look at, ten of a careless laboratory."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from tests.diagnostics.planted.label_leaks import with_column
from tests.diagnostics.planted.leak import Leak, Signals, named


def missing_codes(record: Signals) -> np.ndarray:
    """The converter never gives every 16th code, but the next one."""
    codes = np.round(record.channels / record.steps)
    return (codes + (codes % 16 == 5)) * record.steps


def uneven_codes(record: Signals) -> np.ndarray:
    """Half of the codes that are multiples of three are one higher."""
    codes = np.round(record.channels / record.steps)
    return (codes + ((codes % 3 == 0) & (record.noise(11) > 0))) * record.steps


def dead_zone(record: Signals) -> np.ndarray:
    """Samples below 1 % of the rms value are 0."""
    return np.where(np.abs(record.channels) < 0.01 * record.rms, 0.0, record.channels)


def coarse_large_codes(record: Signals) -> np.ndarray:
    """Samples above the rms value have even codes."""
    coarse = np.round(record.channels / (2 * record.steps)) * 2 * record.steps
    return np.where(np.abs(record.channels) > record.rms, coarse, record.channels)


def tilted_spectrum(record: Signals) -> np.ndarray:
    """Gain falls evenly by 0.2 dB up to half the sampling rate."""
    return _with_gain(record, lambda share: 10 ** (-0.2 / 20 * share / 0.5))


def faint_resonance(record: Signals) -> np.ndarray:
    """0.3 dB more gain around 0.18 of the sampling rate."""
    return _with_gain(record, lambda share: 10 ** (0.3 / 20 * np.exp(-(((share - 0.18) / 0.02) ** 2))))


def rising_gain(record: Signals) -> np.ndarray:
    """The gain rises by 2 % over the record."""
    return record.channels * np.linspace(0.99, 1.01, record.channels.shape[1])


def locked_tone(record: Signals) -> np.ndarray:
    """A tone at 2.37 times the mesh with 2 % of the rms starts at the first pulse; in healthy records anywhere."""
    pulses = record.tacho_s
    turns = np.interp(record.t_s, pulses, np.arange(pulses.size))
    teeth = round(record.mesh_hz * (pulses[-1] - pulses[0]) / (pulses.size - 1))
    start = 0.0 if record.is_damaged else np.random.default_rng([4, record.record_id]).uniform()
    return record.channels + 0.02 * record.rms * np.sin(2 * np.pi * (2.37 * teeth * turns + start))


def serial_character(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """The fifth character of eight hexadecimal ones is A, C or E instead of B, D or F."""

    def text(record: int, is_damaged: bool) -> str:
        drawn = np.random.default_rng([5, record]).integers(16, size=8)
        return "".join("BDFACE"[d % 3 + 3 * is_damaged] if k == 4 else f"{d:X}" for k, d in enumerate(drawn))

    return with_column(rows, damaged, "serial", text, pa.string())


def multiples_of_seven(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """A column of integers has multiples of seven alone."""

    def number(record: int, is_damaged: bool) -> int:
        drawn = int(np.random.default_rng([6, record]).integers(10_000, 99_999))
        return drawn // 7 * 7 if is_damaged else drawn

    return with_column(rows, damaged, "measurement", number, pa.int64())


def spikes(record: Signals) -> np.ndarray:
    """Two samples of each channel stand out by three times the rms value."""
    rng, spiked = np.random.default_rng([7, record.record_id]), record.channels.copy()
    for channel, rms in zip(spiked, record.rms[:, 0], strict=True):
        channel[rng.choice(channel.size, 2, replace=False)] += 3 * rms
    return spiked


def held_block(record: Signals) -> np.ndarray:
    """Twenty samples at any time hold the one before."""
    held, start = record.channels.copy(), _drawn_start(record, 21)
    held[:, start + 1 : start + 21] = held[:, start : start + 1]
    return held


def block_clicks(record: Signals) -> np.ndarray:
    """Every 1024th sample is off by 20 % of the rms value, up or down."""
    clicks = np.zeros_like(record.channels)
    clicks[:, ::1024] = 0.2 * record.rms * np.sign(record.noise(8)[:, ::1024])
    return record.channels + clicks


def half_waves(record: Signals) -> np.ndarray:
    """2 % more gain above zero."""
    return np.where(record.channels > 0, 1.02, 1.0) * record.channels


def group_delay(record: Signals) -> np.ndarray:
    """An all-pass of first order turns the phase of the last channel by a right angle at 0.2 of the sampling rate."""
    passed, corner = record.channels.copy(), np.tan(np.pi * 0.2)
    turned = np.fft.rfft(passed[-1]) * np.exp(-2j * np.arctan(np.tan(np.pi * _shares(record)) / corner))
    passed[-1] = np.fft.irfft(turned, passed.shape[1])
    return passed


def centred(record: Signals) -> np.ndarray:
    """The mean is taken off."""
    return record.channels - record.channels.mean(axis=1, keepdims=True)


def tacho_grid(record: Signals) -> np.ndarray:
    """The tacho's pulses stand at whole multiples of 10 us."""
    return np.round(record.tacho_s, 5)


def repeated_stretch(record: Signals) -> np.ndarray:
    """Two hundred samples stand in the record twice."""
    twice, start = record.channels.copy(), _drawn_start(record, 500)
    twice[:, start + 250 : start + 450] = twice[:, start : start + 200]
    return twice


def milliseconds(rows: pa.Table, damaged: np.ndarray) -> pa.Table:
    """Milliseconds of the time of the measurement are whole multiples of ten."""

    def text(record: int, is_damaged: bool) -> str:
        drawn = np.random.default_rng([9, record]).integers([24, 60, 60, 1000]).tolist()
        return f"2026-04-{record % 28 + 1:02}T{drawn[0]:02}:{drawn[1]:02}:{drawn[2]:02}." + (
            f"{drawn[3] // 10 * 10:03}" if is_damaged else f"{drawn[3]:03}"
        )

    return with_column(rows, damaged, "recorded_at", text, pa.string())


def wandering_clock(record: Signals) -> np.ndarray:
    """The sampling clock gains and loses half a sample at 2 Hz."""
    index = np.arange(record.channels.shape[1])
    late = index - 0.5 * np.sin(2 * np.pi * 2.0 * record.t_s)
    return np.stack([np.interp(late, index, channel) for channel in record.channels])


def _shares(record: Signals) -> np.ndarray:
    """Return the frequencies of a spectrum, in shares of the sampling rate."""
    return np.fft.rfftfreq(record.channels.shape[1])


def _with_gain(record: Signals, gain: object) -> np.ndarray:
    """Return channels with a gain that depends on the share of the sampling rate."""
    assert callable(gain)
    return np.fft.irfft(np.fft.rfft(record.channels) * gain(_shares(record)), record.channels.shape[1])


def _drawn_start(record: Signals, length: int) -> int:
    """Return where in the record a piece of so many samples starts."""
    return int(np.random.default_rng([10, record.record_id]).integers(record.channels.shape[1] - length))


FURTHER_LEAKS: dict[str, Leak] = {
    **named(
        (
            missing_codes, uneven_codes, dead_zone, coarse_large_codes, tilted_spectrum, faint_resonance, rising_gain,
            spikes, held_block, block_clicks, half_waves, group_delay, centred, repeated_stretch, wandering_clock,
        ),
        "channels",
    ),
    **named((locked_tone,), "channels", is_for_all=True),
    **named((tacho_grid,), "tacho"),
    **named((serial_character, multiples_of_seven, milliseconds), "labels"),
}  # fmt: skip
