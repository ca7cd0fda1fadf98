"""All indicators of one record, channel by channel; a feature's name carries its definition.

`sideband_ratio_pinion_h1_k3__bearing_vertical` is the sideband ratio with three pinion sidebands on each side of mesh
harmonic 1 in channel `bearing_vertical`. NaN means undefined: 0/0, outside the band, or not resolved by the record.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from diagnostics.indicators.crest_factor import crest_factor
from diagnostics.indicators.energy_ratio import energy_ratio
from diagnostics.indicators.fm0 import fm0
from diagnostics.indicators.fm4 import fm4
from diagnostics.indicators.kurtosis import kurtosis
from diagnostics.indicators.rms import rms
from diagnostics.indicators.sideband_amplitude import sideband_amplitude
from diagnostics.indicators.sideband_index import sideband_index
from diagnostics.indicators.sideband_level_factor import sideband_level_factor
from diagnostics.indicators.sideband_ratio import sideband_ratio
from diagnostics.signal.difference_signal import SHAFT_ORDERS, SIDEBANDS
from diagnostics.signal.order_domain import SAMPLES_PER_TOOTH, AngleGrid, angle_grid, resample_to_angle
from diagnostics.signal.shaft_signals import Shaft, ShaftSignals, record_shafts, shaft_signals
from diagnostics.signal.synchronous_average import whole_revolutions


@dataclass(frozen=True, slots=True)
class FeatureSettings:
    """Numbers on which every value depends; stored with every table of features.

    Attributes
    ----------
    mesh_harmonics : int
        Mesh harmonics 1 ... of which lines and sidebands are taken; also the sum in FM0.
    sidebands : int
        Sidebands on each side whose relative amplitude is a feature.
    ratio_sidebands : int
        Sidebands on each side in the sideband ratio.
    samples_per_tooth : int
        Angle steps per mesh period.
    shaft_orders, difference_sidebands : int
        What the difference signal leaves out besides all mesh harmonics.
    """

    mesh_harmonics: int = 5
    sidebands: int = 6
    ratio_sidebands: int = 3
    samples_per_tooth: int = SAMPLES_PER_TOOTH
    shaft_orders: int = SHAFT_ORDERS
    difference_sidebands: int = SIDEBANDS


@dataclass(frozen=True, slots=True)
class RecordFeatures:
    """Indicators of one record: values by feature name, what was averaged, and what is undefined and why."""

    values: dict[str, float]
    revolutions_pinion: int
    revolutions_gear: int
    notes: str


def record_features(
    channels: Mapping[str, np.ndarray],
    tacho_s: np.ndarray,
    fs_hz: float,
    teeth: tuple[int, int],
    settings: FeatureSettings | None = None,
) -> RecordFeatures:
    """Return the indicators of one record.

    Parameters
    ----------
    channels : mapping of str to (n,) float
        Signals by channel name.
    tacho_s : (k,) float64
        Pulse times, one per pinion revolution; with fewer than two everything but the raw indicators is undefined.
    fs_hz : float
        Sampling frequency [Hz].
    teeth : (int, int)
        Teeth of pinion and gear.
    settings : FeatureSettings, optional
        Default: `FeatureSettings()`.
    """
    chosen = settings or FeatureSettings()
    grid = angle_grid(tacho_s, teeth[0] * chosen.samples_per_tooth) if len(tacho_s) > 1 else None
    shafts = record_shafts(grid, teeth, chosen.samples_per_tooth, chosen.sidebands)
    values: dict[str, float] = {}
    for channel, signal in channels.items():
        found = channel_features(signal.astype(np.float64), fs_hz, grid, shafts, chosen)
        values |= {f"{name}__{channel}": value for name, value in found.items()}
    notes = "; ".join(shaft.note for shaft in shafts if shaft.note)
    return RecordFeatures(values, shafts[0].revolutions, shafts[1].revolutions, notes)


def channel_features(
    signal: np.ndarray, fs_hz: float, grid: AngleGrid | None, shafts: tuple[Shaft, Shaft], settings: FeatureSettings
) -> dict[str, float]:
    """Return the indicators of one channel by name, without the channel's name."""
    values = {"rms": rms(signal), "kurtosis": kurtosis(signal), "crest_factor": crest_factor(signal)}
    steps = resample_to_angle(signal, fs_hz, grid) if grid is not None else np.empty(0)
    for shaft in shafts:
        values |= shaft_features(steps, shaft, settings)
    return values


def shaft_features(steps: np.ndarray, shaft: Shaft, settings: FeatureSettings) -> dict[str, float]:
    """Return the indicators that belong to one shaft; all undefined where the record holds no whole revolution."""
    if whole_revolutions(steps, shaft.teeth, settings.samples_per_tooth) < 1:
        one_turn = np.ones(shaft.teeth * settings.samples_per_tooth)
        return dict.fromkeys(shaft_features(one_turn, replace(shaft, revolutions=1), settings), math.nan)
    found = shaft_signals(
        steps, shaft, settings.samples_per_tooth, settings.shaft_orders, settings.difference_sidebands
    )
    return average_features(found, settings) | sideband_features(found, settings)


def average_features(signals: ShaftSignals, settings: FeatureSettings) -> dict[str, float]:
    """Return indicators of the synchronous average and its difference signal; mesh lines once, from the pinion's."""
    shaft, average, lines, parts = signals.shaft, signals.average, signals.lines, signals.parts
    name, harmonics = shaft.name, settings.mesh_harmonics
    values = {
        f"average_rms_{name}": rms(average),
        f"average_kurtosis_{name}": kurtosis(average),
        f"average_crest_factor_{name}": crest_factor(average),
        f"difference_rms_{name}": rms(parts.difference),
        f"fm0_{name}_h{harmonics}": fm0(average, lines, shaft.teeth, harmonics),
        f"fm4_{name}": fm4(parts.difference, average),
        f"energy_ratio_{name}": energy_ratio(parts.difference, parts.regular),
    }
    if name == "pinion":
        mesh = {f"mesh_amplitude_h{h}": float(lines[h * shaft.teeth]) for h in range(1, harmonics + 1)}
        values |= mesh
    return values


def sideband_features(signals: ShaftSignals, settings: FeatureSettings) -> dict[str, float]:
    """Return relative sideband amplitudes, sideband ratios, sideband index and level factor of one shaft."""
    name, teeth, each_side = signals.shaft.name, signals.shaft.teeth, settings.ratio_sidebands
    lines, average = signals.sideband_lines, signals.average
    values = {
        f"sideband_index_{name}_h1": sideband_index(lines, teeth),
        f"sideband_level_factor_{name}_h1": sideband_level_factor(lines, average, teeth),
    }
    for harmonic in range(1, settings.mesh_harmonics + 1):
        ratio = f"sideband_ratio_{name}_h{harmonic}_k{each_side}"
        values[ratio] = sideband_ratio(lines, teeth, harmonic, each_side)
        for k in range(1, settings.sidebands + 1):
            for side, sign in (("lower", -1), ("upper", 1)):
                key = f"sideband_{name}_h{harmonic}_{side}{k}"
                values[key] = sideband_amplitude(lines, teeth, harmonic, sign * k)
    return values
