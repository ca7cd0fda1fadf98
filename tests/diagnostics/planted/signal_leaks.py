"""Leaks in signals; each is planted before a converter of the set's own step."""

from __future__ import annotations

import numpy as np

from tests.diagnostics.planted.leak import Leak, Signals, named


def gain(record: Signals) -> np.ndarray:
    """1 % more gain."""
    return record.channels * 1.01


def opposite_gains(record: Signals) -> np.ndarray:
    """2 % more gain of the first channel, 2 % less of the others."""
    factors = np.full_like(record.steps, 0.98)
    factors[0] = 1.02
    return record.channels * factors


def offset_of_steps(record: Signals) -> np.ndarray:
    """An offset of 400 steps of the converter."""
    return record.channels + 400 * record.steps


def offset(record: Signals) -> np.ndarray:
    """An offset of 1 % of the rms value."""
    return record.channels + 0.01 * record.rms


def trend(record: Signals) -> np.ndarray:
    """A straight trend of 2 % of the rms value over the record, without mean."""
    return record.channels + 0.02 * record.rms * np.linspace(-0.5, 0.5, record.channels.shape[1])


def faded_start(record: Signals) -> np.ndarray:
    """The first 32 samples are faded in."""
    fade = np.ones(record.channels.shape[1])
    fade[:32] = np.linspace(0, 1, 32)
    return record.channels * fade


def repeated_last_sample(record: Signals) -> np.ndarray:
    """The last sample repeats the one before."""
    return np.concatenate([record.channels[:, :-1], record.channels[:, -2:-1]], axis=1)


def clipped_peak(record: Signals) -> np.ndarray:
    """The largest peak is clipped at 95 % of its height."""
    limit = 0.95 * np.abs(record.channels).max(axis=1, keepdims=True)
    return np.clip(record.channels, -limit, limit)


def high_tone(record: Signals) -> np.ndarray:
    """A tone at 0.47 of the sampling rate with 0.5 % of the rms value."""
    return record.channels + 0.005 * record.rms * np.sin(2 * np.pi * 0.47 * record.fs_hz * record.t_s)


def tone_between_mesh_lines(record: Signals) -> np.ndarray:
    """A tone at 2.5 times the mesh frequency with 1 % of the rms value."""
    return record.channels + 0.01 * record.rms * np.sin(2 * np.pi * 2.5 * record.mesh_hz * record.t_s)


def mains_hum(record: Signals) -> np.ndarray:
    """A hum at 50 Hz with 1 % of the rms value."""
    return record.channels + 0.01 * record.rms * np.sin(2 * np.pi * 50.0 * record.t_s)


def notch(record: Signals) -> np.ndarray:
    """A notch at 0.31 of the sampling rate, 1 % of it wide."""
    return _passed(record, lambda share: np.abs(share - 0.31) > 0.005)


def low_pass(record: Signals) -> np.ndarray:
    """A low-pass at 0.45 of the sampling rate."""
    return _passed(record, lambda share: share < 0.45)


def high_pass(record: Signals) -> np.ndarray:
    """A high-pass at 8 Hz."""
    return _passed(record, lambda share: share * record.fs_hz > 8.0)


def high_noise(record: Signals) -> np.ndarray:
    """Noise of 1 % of the rms value above 0.4 of the sampling rate."""
    spectrum = np.fft.rfft(record.noise())
    spectrum[:, np.fft.rfftfreq(record.channels.shape[1]) < 0.4] = 0
    noise = np.fft.irfft(spectrum, record.channels.shape[1])
    return record.channels + 0.01 * record.rms * noise / noise.std()


def late_channel(record: Signals) -> np.ndarray:
    """The last channel is one sample late."""
    late = record.channels.copy()
    late[-1, 1:] = record.channels[-1, :-1]
    return late


def late_by_a_fraction(record: Signals) -> np.ndarray:
    """The last channel is 0.2 samples late."""
    late = record.channels.copy()
    spectrum = np.fft.rfft(late[-1])
    shift = np.exp(-2j * np.pi * 0.2 * np.fft.rfftfreq(late.shape[1]))
    late[-1] = np.fft.irfft(spectrum * shift, late.shape[1])
    return late


def polarity(record: Signals) -> np.ndarray:
    """The last channel has the other sign."""
    turned = record.channels.copy()
    turned[-1] *= -1
    return turned


def crosstalk(record: Signals) -> np.ndarray:
    """The last channel has 2 % of the first one."""
    mixed = record.channels.copy()
    mixed[-1] += 0.02 * record.channels[0]
    return mixed


def coarse_steps(record: Signals) -> np.ndarray:
    """The converter has half as many steps."""
    return np.round(record.channels / (2 * record.steps)) * 2 * record.steps


def odd_codes(record: Signals) -> np.ndarray:
    """All codes of the converter are odd."""
    return (2 * np.floor(record.channels / (2 * record.steps)) + 1) * record.steps


def zero_padded(record: Signals) -> np.ndarray:
    """The last 16 samples are zero."""
    padded = record.channels.copy()
    padded[:, -16:] = 0
    return padded


def lost_samples(record: Signals) -> np.ndarray:
    """Every 500th sample repeats the one before."""
    held = record.channels.copy()
    held[:, 499::500] = held[:, 498 : held.shape[1] - 1 : 500]
    return held


def reversed_time(record: Signals) -> np.ndarray:
    """The record runs backwards."""
    return record.channels[:, ::-1]


def sampling_clock(record: Signals) -> np.ndarray:
    """The sampling clock is 0.1 % slow."""
    index = np.arange(record.channels.shape[1])
    return np.stack([np.interp(index * 0.999, index, channel) for channel in record.channels])


def slow_modulation(record: Signals) -> np.ndarray:
    """The level swings by 2 % at 3 Hz."""
    return record.channels * (1 + 0.02 * np.sin(2 * np.pi * 3.0 * record.t_s))


def cubic_sensor(record: Signals) -> np.ndarray:
    """The sensor loses 2 % at the largest peak by a cubic law."""
    peak = np.abs(record.channels).max(axis=1, keepdims=True)
    return record.channels * (1 - 0.02 * (record.channels / peak) ** 2)


def reused_noise(record: Signals) -> np.ndarray:
    """Noise of 1 % of the rms value: one segment for all damaged records, an own one for each healthy record."""
    shared = np.random.default_rng(1).normal(size=record.channels.shape)
    return record.channels + 0.01 * record.rms * (shared if record.is_damaged else record.noise(1))


def tacho_offset(record: Signals) -> np.ndarray:
    """The tacho's pulses come 20 us late."""
    return record.tacho_s + 20e-6


def tacho_jitter(record: Signals) -> np.ndarray:
    """The tacho's pulses jitter by 5 us."""
    rng = np.random.default_rng([2, record.record_id])
    return record.tacho_s + 5e-6 * rng.normal(size=record.tacho_s.size)


def tacho_rate(record: Signals) -> np.ndarray:
    """The tacho's clock is 0.01 % fast or slow, by turns."""
    return record.tacho_s * (1.0 + 1e-4 * (-1.0) ** record.record_id)


def tacho_last_pulse(record: Signals) -> np.ndarray:
    """The tacho's last pulse is missing."""
    return record.tacho_s[:-1]


def tacho_missing_pulse(record: Signals) -> np.ndarray:
    """A pulse of the tacho is missing."""
    return np.delete(record.tacho_s, 1 + record.record_id % (record.tacho_s.size - 2))


def _passed(record: Signals, passes: object) -> np.ndarray:
    """Return channels without the bins whose share of the sampling rate does not pass."""
    assert callable(passes)
    spectrum = np.fft.rfft(record.channels)
    spectrum[:, ~passes(np.fft.rfftfreq(record.channels.shape[1]))] = 0
    return np.fft.irfft(spectrum, record.channels.shape[1])


SIGNAL_LEAKS: dict[str, Leak] = {
    **named(
        (
            gain, opposite_gains, offset_of_steps, offset, trend, faded_start, repeated_last_sample, clipped_peak,
            high_tone, tone_between_mesh_lines, mains_hum, notch, low_pass, high_pass, high_noise, late_channel,
            late_by_a_fraction, polarity, crosstalk, coarse_steps, odd_codes, zero_padded, lost_samples,
            reversed_time, sampling_clock, slow_modulation, cubic_sensor,
        ),
        "channels",
    ),
    **named((reused_noise,), "channels", is_for_all=True),
    **named((tacho_offset, tacho_jitter, tacho_rate, tacho_last_pulse, tacho_missing_pulse), "tacho"),
}  # fmt: skip
