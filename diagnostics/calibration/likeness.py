"""Likeness: recordings beside healthy gearboxes of a configuration, in spectra, envelopes and level-free features."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import siggen
from diagnostics.audit.reference_comparison import ReferenceComparison, WindowSet, reference_comparison
from diagnostics.calibration.healthy_blocks import HealthyBlock
from diagnostics.calibration.order_record import turns_of
from diagnostics.indicators.background_levels import CYCLIC, SPECTRAL, background_levels
from diagnostics.signal.window_features import RATE_HZ, signal_windows, window_features
from siggen.errors import SolverFailure

LEVELS = tuple(name for name in (*SPECTRAL, *CYCLIC) if name != "strongest_mesh_rms_m_s2")
LOWEST_HZ, BANDS_PER_OCTAVE, HIGHEST_SHARE = 50.0, 12, 0.4
RANGE = (0.05, 0.95)


@dataclass(frozen=True, slots=True)
class Sample:
    """Records of one origin.

    Attributes
    ----------
    bands_db : (records, channels, bands) float64
        Mean density [dB re 1 unit²/Hz] of twelfths of an octave.
    levels : (records, channels, len(LEVELS)) float64
        Lines, floors, modulation and tails.
    windows : WindowSet or None
        Features of windows of one second; None where records are shorter.
    """

    bands_db: np.ndarray
    levels: np.ndarray
    windows: WindowSet | None


@dataclass(frozen=True, slots=True)
class Likeness:
    """Recordings against one configuration.

    Attributes
    ----------
    distance_db : (channels,) float64
        Rms over bands of the difference between medians.
    inside : float
        Share of the recordings' values (bands and levels) within 90 % of the gearboxes'.
    features : ReferenceComparison or None
    sample : Sample
        The gearboxes.
    """

    distance_db: np.ndarray
    inside: float
    features: ReferenceComparison | None
    sample: Sample


def band_edges_hz(fs_hz: float) -> np.ndarray:
    """Return the limits of the bands (bands + 1,)."""
    count = int(BANDS_PER_OCTAVE * np.log2(HIGHEST_SHARE * fs_hz / LOWEST_HZ))
    return np.asarray(LOWEST_HZ * 2.0 ** (np.arange(count + 1) / BANDS_PER_OCTAVE))


def sample_of(blocks: Iterable[HealthyBlock], teeth: tuple[int, int]) -> Sample:
    """Return what records show."""
    bands, levels, values, owners, names = [], [], [], [], []
    for block in blocks:
        bands.append([band_levels_db(signal, block.fs_hz) for signal in block.channels.values()])
        levels.append([_levels(signal, block, teeth) for signal in block.channels.values()])
        for channel, signal in block.channels.items():
            if signal.size * RATE_HZ / block.fs_hz < RATE_HZ or block.fs_hz < 0.75 * RATE_HZ:
                continue
            rows = [window_features(window) for window in signal_windows(signal.astype(np.float64), block.fs_hz)]
            values += rows
            owners += [block.name] * len(rows)
            names += [channel] * len(rows)
    windows = WindowSet(np.stack(values), np.array(owners), np.array(names)) if values else None
    return Sample(np.array(bands), np.array(levels), windows)


def simulated_blocks(
    config: Path | Mapping[str, object], channels: tuple[str, ...], gearboxes: int, advance: Callable[[], None]
) -> list[HealthyBlock]:
    """Return one healthy record of each of some gearboxes; channels take the recordings' names in their order."""
    loaded = siggen.load_config(config, ["states={healthy: {}}", f"specimens={gearboxes}", "repeats=1"])
    found = []
    for number in range(gearboxes):
        with suppress(SolverFailure):
            record = siggen.run(siggen.draw(loaded, number))
            signals = dict(zip(channels, record.channels.values(), strict=True))
            found.append(HealthyBlock(str(number), signals, loaded.fs_hz, record.tacho_s))
        advance()
    return found


def likeness(real: Sample, sample: Sample, seed: int) -> Likeness:
    """Return how recordings lie against gearboxes."""
    difference = np.median(sample.bands_db, axis=0) - np.median(real.bands_db, axis=0)
    inside = [_inside(getattr(real, name), getattr(sample, name)) for name in ("bands_db", "levels")]
    both = real.windows is not None and sample.windows is not None
    features = reference_comparison(real.windows, sample.windows, seed) if both else None  # type: ignore[arg-type]
    distance = np.sqrt(np.square(difference).mean(axis=1))
    return Likeness(distance, float(np.nanmean(np.concatenate(inside))), features, sample)


def band_levels_db(signal: np.ndarray, fs_hz: float) -> np.ndarray:
    """Return mean densities [dB] of the bands of a signal (n,)."""
    hann = np.hanning(signal.size)
    density = np.square(np.abs(np.fft.rfft((signal - signal.mean()) * hann))) * (2.0 / (fs_hz * np.square(hann).sum()))
    edges = np.searchsorted(np.arange(density.size) * fs_hz / signal.size, band_edges_hz(fs_hz))
    means = [density[a : max(b, a + 1)].mean() for a, b in itertools.pairwise(edges.tolist())]
    return np.asarray(10.0 * np.log10(np.maximum(means, 1e-30)))


def _levels(signal: np.ndarray, block: HealthyBlock, teeth: tuple[int, int]) -> list[float]:
    turns = turns_of(signal.astype(np.float64), block.fs_hz, block.pulses_s)
    found = background_levels(turns, block.speed_hz, teeth, block.fs_hz)
    return [found[name] for name in LEVELS]


def _inside(real: np.ndarray, simulated: np.ndarray) -> np.ndarray:
    """Return whether each value of the recordings lies within 90 % of the gearboxes', flat; NaN where undefined."""
    with np.errstate(invalid="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of what no gearbox has a value of
        low, high = np.nanquantile(simulated, RANGE, axis=0)
        found = ((real >= low) & (real <= high)).astype(np.float64)
    found[~np.isfinite(real) | ~np.isfinite(np.broadcast_to(low, real.shape))] = np.nan
    return np.asarray(found.ravel())
