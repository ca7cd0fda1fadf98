"""All indicators of one channel of a record in one pass: resampled once, averaged once per shaft.

Columns: `<name>[_pinion|_gear][_h<mesh harmonics>][_k<sidebands>]`, where h5 in a sum means harmonics 1 to 5. What NA4
and its kin need of a record is returned beside the values, since their history is another record's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from diagnostics.indicators.amplitude_modulation import amplitude_modulation
from diagnostics.indicators.cepstral_peak import cepstral_peak, shaft_log_spectrum
from diagnostics.indicators.crest_factor import crest_factor
from diagnostics.indicators.energy_operator_lebold import energy_operator_lebold
from diagnostics.indicators.energy_operator_teager import energy_operator_teager
from diagnostics.indicators.energy_ratio import energy_ratio
from diagnostics.indicators.features import FeatureSettings
from diagnostics.indicators.fm0 import fm0
from diagnostics.indicators.fm4 import fm4
from diagnostics.indicators.kurtosis import kurtosis
from diagnostics.indicators.m6a import m6a
from diagnostics.indicators.m8a import m8a
from diagnostics.indicators.na4 import central_moments
from diagnostics.indicators.nb4 import dominant_harmonic
from diagnostics.indicators.phase_modulation import phase_modulation_rad
from diagnostics.indicators.rms import rms
from diagnostics.indicators.sideband_asymmetry import sideband_asymmetry_db
from diagnostics.indicators.sideband_index import sideband_index
from diagnostics.indicators.sideband_level_factor import sideband_level_factor
from diagnostics.indicators.sideband_power import sideband_power
from diagnostics.indicators.sideband_ratio import sideband_ratio
from diagnostics.indicators.spectral_kurtosis_maximum import spectral_kurtosis_maximum
from diagnostics.signal.averaging_bias import noise_share
from diagnostics.signal.demodulation import demodulated
from diagnostics.signal.mesh_band import mesh_baseband
from diagnostics.signal.order_domain import AngleGrid, resample_to_angle
from diagnostics.signal.shaft_signals import Shaft, ShaftSignals, shaft_signals
from diagnostics.signal.spectral_kurtosis import FRAME_SAMPLES, spectral_kurtosis

CEPSTRUM_BAND = 0.8
"""Share of the band whose spectrum counts in the cepstrum; above, the anti-alias filter shapes it."""


@dataclass(frozen=True, slots=True)
class IndicatorSettings:
    """Numbers on which every value depends; stored with every table of indicators.

    Attributes
    ----------
    order_domain : FeatureSettings
        Harmonics, sidebands, angle steps and what the difference signal leaves out, as for the table of features.
    modulation_harmonics : int
        Mesh harmonics 1 ... that are demodulated.
    frame_samples : int
        Frame of the spectral kurtosis.
    speed_range_hz : (float, float), optional
        Where given, angles come from the mesh lines within this range of pinion speed, not from the pulses.
    """

    order_domain: FeatureSettings = field(default_factory=FeatureSettings)
    modulation_harmonics: int = 3
    frame_samples: int = FRAME_SAMPLES
    speed_range_hz: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class ChannelIndicators:
    """Indicators of one channel by column, and the moments that indicators with a history are made of."""

    values: dict[str, float]
    moments: dict[str, float]


def channel_indicators(
    signal: np.ndarray,
    fs_hz: float,
    grid: AngleGrid | None,
    shafts: tuple[Shaft, Shaft],
    settings: IndicatorSettings,
) -> ChannelIndicators:
    """Return every indicator of one channel.

    Parameters
    ----------
    signal : (n,) float64
        Record [m/s²], finite.
    fs_hz : float
        Sampling frequency [Hz].
    grid : AngleGrid, optional
        Steps of pinion angle; without them everything over angle is undefined.
    shafts : (Shaft, Shaft)
        Pinion and gear.
    settings : IndicatorSettings
        Harmonics, sidebands, frames.
    """
    values = {
        "rms": rms(signal),
        "kurtosis": kurtosis(signal),
        "crest_factor": crest_factor(signal),
        "spectral_kurtosis_maximum": spectral_kurtosis_maximum(spectral_kurtosis(signal, settings.frame_samples)),
    }
    moments: dict[str, float] = {}
    steps = resample_to_angle(signal, fs_hz, grid) if grid is not None else np.empty(0)
    for shaft in shafts:
        if shaft.revolutions < 1:
            continue
        found = shaft_indicators(steps, shaft, settings)
        values |= found.values
        moments |= found.moments
    if grid is not None:
        values |= _cepstral_peaks(steps, fs_hz, grid, shafts)
    return ChannelIndicators(values, moments)


def _cepstral_peaks(steps: np.ndarray, fs_hz: float, grid: AngleGrid, shafts: tuple[Shaft, Shaft]) -> dict[str, float]:
    """Return the first rahmonics of both shafts, at one and at z2/z1 pinion revolutions."""
    pinion, gear = shafts
    band = 0.5 * min(fs_hz / grid.slowest_hz, float(grid.samples_per_revolution))
    highest = int(CEPSTRUM_BAND * band)
    spectrum = shaft_log_spectrum(steps, grid.revolutions, pinion.teeth, highest)
    periods = {"pinion": 2.0 * highest, "gear": 2.0 * highest * gear.teeth / pinion.teeth}
    return {
        f"cepstral_peak_{shaft.name}": cepstral_peak(spectrum, periods[shaft.name])
        if shaft.revolutions >= 2
        else math.nan
        for shaft in shafts
    }


def shaft_indicators(steps: np.ndarray, shaft: Shaft, settings: IndicatorSettings) -> ChannelIndicators:
    """Return every indicator of one shaft.

    Parameters
    ----------
    steps : (n,) float64
        Angle signal, at least one revolution of the shaft; one revolution may be a given average.
    shaft : Shaft
        Whose revolutions are averaged.
    settings : IndicatorSettings
        Harmonics, sidebands, angle steps.
    """
    order = settings.order_domain
    signals = shaft_signals(steps, shaft, order.samples_per_tooth, order.shaft_orders, order.difference_sidebands)
    values = _average_indicators(signals, order.mesh_harmonics)
    values[f"noise_share_{shaft.name}"] = noise_share(steps, shaft.teeth * order.samples_per_tooth)
    values |= _sideband_indicators(signals, order) | _modulation_indicators(signals, settings)
    return ChannelIndicators(values, _moments(signals, order))


def _average_indicators(signals: ShaftSignals, harmonics: int) -> dict[str, float]:
    name, average, parts, teeth = signals.shaft.name, signals.average, signals.parts, signals.shaft.teeth
    values = {
        f"average_rms_{name}": rms(average),
        f"average_kurtosis_{name}": kurtosis(average),
        f"average_crest_factor_{name}": crest_factor(average),
        f"residual_rms_{name}": rms(parts.residual),
        f"difference_rms_{name}": rms(parts.difference),
        f"fm0_{name}_h{harmonics}": fm0(average, signals.lines, teeth, harmonics),
        f"fm4_{name}": fm4(parts.difference, average),
        f"m6a_{name}": m6a(parts.difference, average),
        f"m8a_{name}": m8a(parts.difference, average),
        f"energy_ratio_{name}": energy_ratio(parts.difference, parts.regular),
        f"energy_operator_teager_{name}": energy_operator_teager(parts.residual),
        f"energy_operator_lebold_{name}": energy_operator_lebold(parts.residual),
    }
    if name == "pinion":
        values |= {f"mesh_amplitude_h{h}": float(signals.lines[h * teeth]) for h in range(1, harmonics + 1)}
    return values


def _sideband_indicators(signals: ShaftSignals, order: FeatureSettings) -> dict[str, float]:
    name, teeth, lines = signals.shaft.name, signals.shaft.teeth, signals.sideband_lines
    each_side, last = order.ratio_sidebands, order.mesh_harmonics
    values = {
        f"sideband_index_{name}_h1": sideband_index(lines, teeth),
        f"sideband_level_factor_{name}_h1": sideband_level_factor(lines, signals.average, teeth),
    }
    for harmonic in range(1, last + 1):
        values[f"sideband_ratio_{name}_h{harmonic}_k{each_side}"] = sideband_ratio(lines, teeth, harmonic, each_side)
        values[f"sideband_asymmetry_{name}_h{harmonic}"] = sideband_asymmetry_db(lines, teeth, harmonic)
    for k in range(1, order.sidebands + 1):
        values[f"sideband_power_{name}_h{last}_k{k}"] = sideband_power(lines, teeth, k, last)
    return values


def _modulation_indicators(signals: ShaftSignals, settings: IndicatorSettings) -> dict[str, float]:
    name, teeth = signals.shaft.name, signals.shaft.teeth
    width = half_width(teeth, settings.order_domain.sidebands)
    values = {}
    for harmonic in range(1, settings.modulation_harmonics + 1):
        depth = (math.nan, math.nan)
        if signals.shaft.resolved[0]:
            modulation = demodulated(signals.sideband_average, teeth, harmonic, width)
            depth = (amplitude_modulation(modulation), phase_modulation_rad(modulation))
        values[f"amplitude_modulation_{name}_h{harmonic}"] = depth[0]
        values[f"phase_modulation_{name}_h{harmonic}"] = depth[1]
    return values


def half_width(teeth: int, sidebands: int) -> int:
    """Return the sidebands on each side that a band round a mesh harmonic holds: as set, or as many as fit."""
    return min(sidebands, (teeth - 1) // 2)


def _moments(signals: ShaftSignals, order: FeatureSettings) -> dict[str, float]:
    """Return fourth and second moments of the residual and of the envelope round every mesh harmonic."""
    name, teeth = signals.shaft.name, signals.shaft.teeth
    fourth, second = central_moments(signals.parts.residual)
    found = {
        f"residual_fourth_{name}": fourth,
        f"residual_second_{name}": second,
        f"dominant_{name}": float(dominant_harmonic(signals.lines, teeth, order.mesh_harmonics)),
    }
    width = half_width(teeth, order.sidebands)
    for harmonic in range(1, order.mesh_harmonics + 1):
        moments = central_moments(np.abs(mesh_baseband(signals.average, teeth, harmonic, width)))
        found[f"envelope_fourth_{name}_h{harmonic}"], found[f"envelope_second_{name}_h{harmonic}"] = moments
    return found
