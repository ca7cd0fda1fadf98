"""The noise of a channel, and of its recorder.

The noise of a channel: density of its floor, its level between recordings, and how shafts and chance modulate it.

What a channel's samples say about its recorder: the smallest step, and the largest value.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnostics.calibration.healthy_blocks import FEWEST_RECORDINGS, HealthyBlock, jackknife
from diagnostics.calibration.order_record import OrderRecord, turns_of
from diagnostics.signal.synchronous_average import asynchronous_part, band_signal
from diagnostics.statistics.evaluation import Interval

LARGEST_BITS = 24
HEADROOM = 32.0
"""Range over the largest value of healthy recordings, which show no range: bits follow, so that the step stays. A spall
across the whole face raises the largest value of a record 5 times, and paths of gearboxes differ (derived)."""
SEEN = 20_000

KNOTS_PER_OCTAVE, LOWEST_HZ = 96, 5.0
MODULATION_BAND = (0.08, 0.4)
"""Of the sampling rate: 2 to 10 kHz at 25.6 kHz."""
SHAFT_LINES_POWER = 0.5 * (1.0 + 1.0 / 2.0 + 1.0 / 3.0)
"""Of lines of depths d, d/√2, d/√3: kurtosis 3 (1 + d² times this) (derived)."""
NEIGHBOURS = (0.31, 0.37, 0.43, 1.29, 1.37, 1.43, 1.71)
"""Orders beside those of shafts: what they show is the error of the estimate."""
OVER_FLOOR, REACH = 10.0, 4
LEAST_SPREAD_DB = 1.0
UNKNOWN_SPREAD_DB = 3.0
"""Where too few recordings tell the spread: half to twice the power."""


@dataclass(frozen=True, slots=True)
class SensorFit:
    """Smallest step [m/s²], 0 where values lie on no grid; range [m/s²] and bits that give it, None without one."""

    step_m_s2: float
    range_m_s2: float
    bits: int | None


def sensor_fit(blocks: Sequence[HealthyBlock], channel: str) -> SensorFit:
    """Return the resolution of a channel; its range is not seen, only that it is larger than all values."""
    peak = max(float(np.abs(block.channels[channel]).max()) for block in blocks)
    step = smallest_step(np.concatenate([block.channels[channel][:SEEN] for block in blocks]))
    if not step:
        return SensorFit(0.0, HEADROOM * peak, None)
    # the simulated step is the smallest power of two above 2 range / 2^bits
    power = 2.0 ** math.floor(math.log2(step) + 1e-9)
    bits = min(max(math.ceil(math.log2(2.0 * HEADROOM * peak / power)), 4), LARGEST_BITS)
    return SensorFit(step, power * 2.0 ** (bits - 1), bits)


def smallest_step(values: np.ndarray) -> float:
    """Return the step of the grid on which values (n,) lie, 0 if on none."""
    levels = np.unique(values)
    gaps = np.diff(levels)
    if gaps.size < 2:
        return 0.0
    step = float(gaps.min())
    # values that were scaled carry rounding errors: gaps that are no multiple of the smallest one mean no grid
    steps = gaps / step
    on_grid = float(np.abs(steps - np.round(steps)).max()) < 0.05 and step > 1e-9 * float(np.abs(levels).max())
    return float(np.median(gaps / np.round(steps))) if on_grid and levels.size < 0.98 * values.size else 0.0


@dataclass(frozen=True, slots=True)
class NoiseFit:
    """Noise of one channel.

    Attributes
    ----------
    frequency_hz, density : (knots,) float64
        One-sided density of the floor [unit/√Hz], mean in dB over recordings.
    level_db : Interval
        Level of all noise [dB re 1 unit²].
    spread_db : float
        Half the range in which a record's level is drawn: at least LEAST_SPREAD_DB, and UNKNOWN_SPREAD_DB from fewer
        than three recordings.
    driver_depth, driven_depth, level_std : Interval
        As keys of `noise_spectrum.modulation`.
    """

    frequency_hz: np.ndarray
    density: np.ndarray
    level_db: Interval
    spread_db: float
    driver_depth: Interval
    driven_depth: Interval
    level_std: Interval

    @property
    def depths(self) -> tuple[Interval, Interval]:
        """How deep the first and the second shaft modulate it."""
        return self.driver_depth, self.driven_depth


def noise_fit(
    records: Sequence[OrderRecord], blocks: Sequence[HealthyBlock], channel: str, teeth: tuple[int, int]
) -> NoiseFit:
    """Return the noise of a channel from its spectra and recordings, one of each per block."""
    fs_hz = blocks[0].fs_hz
    knots = np.geomspace(LOWEST_HZ, 0.5 * fs_hz, int(KNOTS_PER_OCTAVE * math.log2(0.5 * fs_hz / LOWEST_HZ)))
    densities = np.array([_at_knots(record, knots) for record in records])
    levels = np.array([10.0 * math.log10(float(record.floor.sum())) for record in records])
    pairs = zip(blocks, records, strict=True)
    cyclic = np.array([_modulation(block, record, channel, teeth) for block, record in pairs])
    spread = 1.65 * float(levels.std(ddof=1)) * math.sqrt(1.0 + 1.0 / levels.size) if levels.size > 1 else 0.0
    least = LEAST_SPREAD_DB if levels.size >= FEWEST_RECORDINGS else UNKNOWN_SPREAD_DB
    return NoiseFit(
        knots,
        np.exp(np.log(densities).mean(axis=0)),
        jackknife(levels),
        max(spread, least),
        *(jackknife(column) for column in cyclic.T),
    )


def _at_knots(record: OrderRecord, knots: np.ndarray) -> np.ndarray:
    hz = np.arange(1, record.floor.size) * record.bin_hz
    return np.asarray(np.exp(np.interp(np.log(knots), np.log(hz), np.log(record.density[1:]))))


def _modulation(
    block: HealthyBlock, record: OrderRecord, channel: str, teeth: tuple[int, int]
) -> tuple[float, float, float]:
    """Return depth of pinion and gear, and s of the random level, of what averages and lines leave.

    Lines a shaft order apart beat, which would pass for modulated noise.
    """
    from scipy import fft

    turns = turns_of(block.channels[channel], block.fs_hz, block.pulses_s)
    rest = asynchronous_part(turns - turns.mean(), teeth)
    bin_hz = block.speed_hz / turns.shape[0]
    low, high = (int(share * block.fs_hz / bin_hz) for share in MODULATION_BAND)
    spectrum = fft.rfft(rest)[: record.power.size]
    spectrum[_near_lines(record)[: spectrum.size]] = 0.0
    power = np.square(np.abs(band_signal(spectrum, low, high)))
    if not power.any():
        return 0.0, 0.0, 0.0
    error = np.median([_depth(power, turns.shape[0] * order) for order in NEIGHBOURS])
    pinion, gear = (
        math.sqrt(max(_depth(power, turns.shape[0] * order) ** 2 - error**2, 0.0))
        for order in (1.0, teeth[0] / teeth[1])
    )
    kurtosis = 1.5 * float(np.square(power).mean() / power.mean() ** 2)
    of_shafts = 3.0 * (1.0 + SHAFT_LINES_POWER * (pinion**2 + gear**2))
    return pinion, gear, math.sqrt(max(math.log(kurtosis / of_shafts), 0.0))


def _near_lines(record: OrderRecord) -> np.ndarray:
    """Return which bins (bins,) lie within REACH of one that stands out of the floor."""
    from scipy.ndimage import binary_dilation

    out = record.power > OVER_FLOOR * record.floor
    return np.asarray(binary_dilation(out, iterations=REACH))


def _depth(power: np.ndarray, cycles: float) -> float:
    turned = np.exp(-2j * np.pi * cycles * np.arange(power.size) / power.size)
    return float(2.0 * abs((power * turned).mean()) / power.mean())
