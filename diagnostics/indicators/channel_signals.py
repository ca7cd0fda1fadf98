"""What the indicators of one channel are made of, each signal made once, when a formula first asks for it.

Names that a formula may take: of the record `signal`, `spectral_kurtosis`; of a shaft `average`, `regular`, `residual`,
`difference`, `lines`, `sideband_lines`, `revolutions`, `modulation`, `residual_band`, `teeth`, `log_spectrum`,
`period_steps`, `shaft_lines`; of the record over angle `angle_signal`, `ripple_bins`; and the fields of its columns
(`harmonic`, `sideband` ...). A column that belongs to no shaft is the record's or the
first shaft's.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any

import numpy as np

from diagnostics.indicators.cepstrum import BAND_SHARE, shaft_log_spectrum
from diagnostics.indicators.history import central_moments, dominant_harmonic
from diagnostics.indicators.indicator import Indicator
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.signal.member_average import Carrier, member_signals, passing_lines
from diagnostics.signal.mesh_band import Modulation, demodulated, mesh_baseband
from diagnostics.signal.order_bands import ORDER_BANDS, band_name, band_signal
from diagnostics.signal.order_domain import AngleGrid, resample_to_angle
from diagnostics.signal.shaft_lines import ripple_bins, shaft_lines
from diagnostics.signal.shaft_signals import Shaft, ShaftSignals, shaft_signals, without_mesh_lines
from diagnostics.signal.spectral_kurtosis import FEWEST_FRAMES, spectral_kurtosis

SHAFT_SIGNALS = ("average", "lines", "sideband_lines", "sideband_average")
PARTS = ("regular", "residual", "difference")
_BANDS = {band_name(*band): band for band in ORDER_BANDS}


class UndefinedSignalError(Exception):
    """The record does not hold what a formula asks for; the indicator is then undefined."""


class ChannelSignals:
    """One channel of a record and what is made of it.

    Parameters
    ----------
    signal : (n,) float64
        Record in the unit of the channel, finite.
    fs_hz : float
        Sampling frequency [Hz].
    grid : AngleGrid, optional
        Steps of pinion angle; without them everything over angle is undefined.
    shafts : tuple of Shaft
        Pinion and gear, or the members of a planetary set.
    settings : IndicatorSettings
        Harmonics, sidebands, frames.
    carrier : Carrier, optional
        Of a planetary set.
    """

    def __init__(
        self,
        signal: np.ndarray,
        fs_hz: float,
        grid: AngleGrid | None,
        shafts: tuple[Shaft, ...],
        settings: IndicatorSettings,
        carrier: Carrier | None = None,
    ) -> None:
        self.signal, self.fs_hz, self.grid, self.shafts, self.settings = signal, fs_hz, grid, shafts, settings
        self._carrier = carrier
        self._of_shaft: dict[str, ShaftSignals] = {}
        self._without_front = np.empty(0)
        self._modulations: dict[tuple[str, int], Modulation] = {}
        self._bands: dict[tuple[str, str], np.ndarray] = {}

    @cached_property
    def steps(self) -> np.ndarray:
        """(steps,) float64: the record over pinion angle."""
        return np.empty(0) if self.grid is None else resample_to_angle(self.signal, self.fs_hz, self.grid)

    @cached_property
    def spectral_kurtosis(self) -> np.ndarray:
        """Spectral kurtosis over frequency."""
        frame = self.settings.frame_samples
        if self.signal.size < (FEWEST_FRAMES + 1) * (frame // 2):
            raise UndefinedSignalError
        return spectral_kurtosis(self.signal, frame)

    @cached_property
    def log_spectrum(self) -> np.ndarray:
        """Log spectrum over pinion orders without mesh lines, as of `shaft_log_spectrum`."""
        if self.grid is None:
            raise UndefinedSignalError
        return shaft_log_spectrum(self.steps, self.grid.revolutions, self.shafts[0].teeth, self._highest_order)

    @property
    def _highest_order(self) -> int:
        assert self.grid is not None
        return int(BAND_SHARE * 0.5 * min(self.fs_hz / self.grid.slowest_hz, float(self.grid.samples_per_revolution)))

    def shaft(self, name: str) -> ShaftSignals:
        """Return the average of a shaft and its parts."""
        if name not in self._of_shaft:
            shaft = self._shaft(name)
            if shaft.revolutions < 1:
                raise UndefinedSignalError
            own = self.settings
            if self._carrier is not None:
                self._of_shaft[name] = member_signals(
                    self.steps, shaft, self._carrier, self._passing_lines, own.shaft_orders, own.difference_sidebands
                )
            else:
                self._of_shaft[name] = shaft_signals(
                    self._steps_of(shaft), shaft, own.samples_per_tooth, own.shaft_orders, own.difference_sidebands
                )
        return self._of_shaft[name]

    @cached_property
    def _passing_lines(self) -> np.ndarray:
        assert self._carrier is not None
        return passing_lines(self.steps, self._carrier)

    def _steps_of(self, shaft: Shaft) -> np.ndarray:
        """Return what a shaft's average is taken of: the record, for a gear without the lines of meshes in front.

        The lines of a mesh in front are often ten times as strong, and a slow gear turns too seldom to average them
        away. They are locked to the pinion's shaft, whose average holds them; lines of the own mesh stay.
        """
        pinion = self.shafts[0]
        if shaft is pinion or not pinion.beside or pinion.revolutions < 1:
            return self.steps
        if not self._without_front.size:
            locked = without_mesh_lines(self.shaft(pinion.name).average, pinion.teeth)
            self._without_front = (self.steps.reshape(-1, locked.size) - locked).ravel()
        return self._without_front

    def _shaft(self, name: str) -> Shaft:
        return next(shaft for shaft in self.shafts if shaft.name == name)

    def values(self, indicators: tuple[Indicator, ...]) -> dict[str, float]:
        """Return the columns of all indicators that need this record alone, NaN where undefined."""
        found, names = {}, tuple(shaft.name for shaft in self.shafts)
        for entry in indicators:
            if not entry.history:
                for column, field in entry.columns(self.settings, names):
                    found[column] = self._value(entry, field)
        return found

    def _value(self, entry: Indicator, field: dict[str, Any]) -> float:
        shaft = str(field.get("shaft", self.shafts[0].name))
        try:
            taken = {
                name: field[name] if name in field else self._named(name, shaft, field) for name in entry.parameters
            }
        except UndefinedSignalError:
            return math.nan
        return entry.function(**taken)

    def _named(self, name: str, shaft: str, field: dict[str, Any]) -> Any:
        """Return what a formula takes by this name."""
        if name in ("signal", "spectral_kurtosis"):
            return getattr(self, name)
        if name == "angle_signal":
            return self._angle_signal
        if name in SHAFT_SIGNALS:
            return getattr(self.shaft(shaft), name)
        if name in PARTS:
            return getattr(self.shaft(shaft).parts, name)
        if name == "teeth":
            return self._shaft(shaft).teeth
        return {
            "revolutions": self._revolutions,
            "modulation": self._modulation,
            "residual_band": self._residual_band,
            "log_spectrum": self._shaft_log_spectrum,
            "period_steps": self._period_steps,
            "shaft_lines": self._shaft_lines,
            "ripple_bins": self._ripple_bins,
        }[name](shaft, field)

    def _revolutions(self, shaft: str, field: dict[str, Any]) -> np.ndarray:  # noqa: ARG002 - one signature for all
        size, steps = self.shaft(shaft).average.size, self._steps_of(self._shaft(shaft))
        return steps[: steps.size // size * size].reshape(-1, size)

    def _modulation(self, shaft: str, field: dict[str, Any]) -> Modulation:
        """Return amplitude and phase of a mesh harmonic; undefined where the first sideband is not resolved."""
        signals, harmonic = self.shaft(shaft), int(field["demodulated_harmonic"])
        if not signals.shaft.resolved[0]:
            raise UndefinedSignalError
        if (shaft, harmonic) not in self._modulations:
            teeth, around = signals.shaft.teeth, signals.sideband_average
            self._modulations[shaft, harmonic] = demodulated(around, teeth, harmonic, self._half_width(teeth))
        return self._modulations[shaft, harmonic]

    def _residual_band(self, shaft: str, field: dict[str, Any]) -> np.ndarray:
        """Return a band of the residual, up to half the sampling rate where the record turns slowest."""
        name = str(field["band"])
        if (shaft, name) not in self._bands:
            residual = self.shaft(shaft).parts.residual
            self._bands[shaft, name] = band_signal(residual, *_BANDS[name], self._carried_order(shaft))
        return self._bands[shaft, name]

    def _carried_order(self, shaft: str) -> float:
        if self.grid is None:
            return math.inf
        return 0.5 * self.fs_hz / self.grid.slowest_hz * self._shaft(shaft).teeth / self.shafts[0].teeth

    def _shaft_log_spectrum(self, shaft: str, field: dict[str, Any]) -> np.ndarray:  # noqa: ARG002
        if self._shaft(shaft).revolutions < 2:
            raise UndefinedSignalError
        return self.log_spectrum

    def _period_steps(self, shaft: str, field: dict[str, Any]) -> float:  # noqa: ARG002
        """Return one revolution of a shaft in steps of the cepstrum: the gear takes z2/z1 pinion revolutions."""
        own = self._shaft(shaft)
        return 2.0 * self._highest_order * (own.period or own.teeth) / self.shafts[0].teeth

    @property
    def _angle_signal(self) -> np.ndarray:
        if not self.steps.size:
            raise UndefinedSignalError
        return self.steps

    def _shaft_lines(self, shaft: str, field: dict[str, Any]) -> np.ndarray:  # noqa: ARG002
        mine, other = self._shaft(shaft), next(found for found in self.shafts if found.name != shaft)
        if mine.revolutions < 1:
            raise UndefinedSignalError
        return shaft_lines(self.steps, mine.teeth, other.teeth, self.settings.samples_per_tooth)

    def _ripple_bins(self, shaft: str, field: dict[str, Any]) -> tuple[int, int]:  # noqa: ARG002
        teeth = (self.shafts[0].teeth, self.shafts[-1].teeth)
        return ripple_bins(self.steps.size / (teeth[0] * self.settings.samples_per_tooth), teeth)

    def _half_width(self, teeth: int) -> int:
        """Return the sidebands on each side that a band round a mesh harmonic holds: as set, or as many as fit."""
        return min(self.settings.sidebands, (teeth - 1) // 2)

    def moments(self) -> dict[str, float]:
        """Return what indicators with a history need: moments of the residual and of the envelope of every harmonic."""
        found: dict[str, float] = {}
        for shaft in self.shafts:
            if shaft.revolutions < 1:
                continue
            signals, name, teeth = self.shaft(shaft.name), shaft.name, shaft.teeth
            found[f"residual_fourth_{name}"], found[f"residual_second_{name}"] = central_moments(signals.parts.residual)
            found[f"dominant_{name}"] = float(dominant_harmonic(signals.lines, teeth, self.settings.mesh_harmonics))
            for h in range(1, self.settings.mesh_harmonics + 1):
                lines_of = signals.average if self._carrier is None else signals.sideband_average
                envelope = np.abs(mesh_baseband(lines_of, teeth, h, self._half_width(teeth)))
                found[f"envelope_fourth_{name}_h{h}"], found[f"envelope_second_{name}_h{h}"] = central_moments(envelope)
        return found
