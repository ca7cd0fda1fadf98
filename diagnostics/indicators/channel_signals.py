"""What the indicators of one channel are made of, each signal made once, when a formula first asks for it.

Names that a formula may take: of the record `signal`, `spectral_kurtosis`; of a shaft `average`, `regular`, `residual`,
`difference`, `lines`, `sideband_lines`, `revolutions`, `modulation`, `residual_band`, `teeth`, `log_spectrum`,
`period_steps`, `shaft_lines`; of the record over angle `angle_signal`, `ripple_bins`; and the fields of its columns
(`harmonic`, `sideband` ...). A column that belongs to no shaft is the record's or the first shaft's.
"""

from __future__ import annotations

import math
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from diagnostics.indicators.cepstrum import BAND_SHARE, shaft_log_spectrum
from diagnostics.indicators.history import central_moments, dominant_harmonic
from diagnostics.indicators.indicator import Formula, Indicator
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.gear_train import PAIR, MeshNames
from diagnostics.signal.member_average import Carrier, member_signals, passing_lines
from diagnostics.signal.mesh_band import Modulation, demodulated, mesh_basebands
from diagnostics.signal.order_bands import ORDER_BANDS, band_name, band_signals
from diagnostics.signal.order_domain import AngleGrid, resample_to_angle
from diagnostics.signal.shaft_lines import ripple_bins, shaft_lines
from diagnostics.signal.shaft_signals import ShaftSignals, SignalShaft, shaft_signals, without_mesh_lines
from diagnostics.signal.spectral_kurtosis import FEWEST_FRAMES, spectral_kurtosis
from diagnostics.signal.spectrum import hann_amplitude, power

SHAFT_SIGNALS = frozenset({"average", "lines", "sideband_lines", "sideband_average"})
PARTS = frozenset({"regular", "residual", "difference"})
_BANDS = {band_name(*band): place for place, band in enumerate(ORDER_BANDS)}


class UndefinedSignalError(Exception):
    """The record does not hold what a formula asks for; the indicator is then undefined."""


class _Column(NamedTuple):
    """One column of a channel: its name, its formula, what that takes, its shaft, and the fields it differs by."""

    name: str
    formula: Formula
    parameters: tuple[str, ...]
    shaft: str
    fields: dict[str, Any]


@lru_cache(maxsize=16)
def _columns(indicators: tuple[Indicator, ...], settings: IndicatorSettings, mesh: MeshNames) -> tuple[_Column, ...]:
    """Return the columns of all indicators that need one record alone; the same for every record of a set."""
    return tuple(
        _Column(column, entry.function, entry.parameters, str(fields.get("shaft", mesh.gears[0])), fields)
        for entry in indicators
        if not entry.history
        for column, fields in entry.columns(settings, mesh)
    )


class ChannelSignals:
    """One channel of a record and what is made of it.

    Parameters
    ----------
    signal : (n,) float64
        Record in the unit of the channel, finite.
    fs_hz : float
        Sampling frequency [Hz].
    grid : AngleGrid, optional
        Steps of the driver's angle; without them everything over angle is undefined.
    shafts : tuple of Shaft
        Those of the gears of the mesh.
    settings : IndicatorSettings
        Harmonics, sidebands, frames.
    mesh : MeshNames
        What columns are called after.
    carrier : Carrier, optional
        Of a planetary set.
    """

    def __init__(
        self,
        signal: np.ndarray,
        fs_hz: float,
        grid: AngleGrid | None,
        shafts: tuple[SignalShaft, ...],
        settings: IndicatorSettings,
        mesh: MeshNames = PAIR[0],
        carrier: Carrier | None = None,
    ) -> None:
        self.signal, self.fs_hz, self.grid, self.shafts, self.settings = signal, fs_hz, grid, shafts, settings
        self._mesh = mesh
        self._carrier, self._named_shafts = carrier, {shaft.name: shaft for shaft in shafts}
        self._of_shaft: dict[str, ShaftSignals] = {}
        self._without_front = np.empty(0)
        self._known: dict[tuple[str, str], Any] = {}
        self._modulations: dict[str, tuple[Modulation, ...]] = {}
        self._bands: dict[str, np.ndarray] = {}

    @cached_property
    def steps(self) -> np.ndarray:
        """(steps,) float64: the record over pinion angle."""
        return np.empty(0) if self.grid is None else resample_to_angle(self.signal, self.fs_hz, self.grid)

    @cached_property
    def amplitude(self) -> np.ndarray:
        """(steps // 2 + 1,) float64: Hann amplitudes over whole pinion revolutions."""
        turns = 1 if self.grid is None else self.grid.revolutions
        return hann_amplitude(self.steps.reshape(turns, -1))

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
        return shaft_log_spectrum(self.amplitude, self.grid.revolutions, self.shafts[0].teeth, self._highest_order)

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

    def _steps_of(self, shaft: SignalShaft) -> np.ndarray:
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

    def _shaft(self, name: str) -> SignalShaft:
        return self._named_shafts[name]

    def values(self, indicators: tuple[Indicator, ...]) -> dict[str, float]:
        """Return the columns of all indicators that need this record alone, NaN where undefined."""
        return {column.name: self._value(column) for column in _columns(indicators, self.settings, self._mesh)}

    def _value(self, column: _Column) -> float:
        fields, shaft = column.fields, column.shaft
        try:
            taken = {
                name: fields[name] if name in fields else self._taken(name, shaft, fields) for name in column.parameters
            }
        except UndefinedSignalError:
            return math.nan
        return column.formula(**taken)

    def _taken(self, name: str, shaft: str, fields: dict[str, Any]) -> Any:
        """Return what a formula takes by this name, which may differ by the fields of its column."""
        if name == "modulation":
            return self._modulation(shaft, int(fields["demodulated_harmonic"]))
        if name == "residual_band":
            return self._residual_band(shaft, str(fields["band"]))
        if (shaft, name) not in self._known:
            self._known[shaft, name] = self._named(name, shaft)
        return self._known[shaft, name]

    def _named(self, name: str, shaft: str) -> Any:
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
            "log_spectrum": self._shaft_log_spectrum,
            "period_steps": self._period_steps,
            "shaft_lines": self._shaft_lines,
            "ripple_bins": self._ripple_bins,
        }[name](shaft)

    def _revolutions(self, shaft: str) -> np.ndarray:
        size, steps = self.shaft(shaft).average.size, self._steps_of(self._shaft(shaft))
        return steps[: steps.size // size * size].reshape(-1, size)

    def _modulation(self, shaft: str, harmonic: int) -> Modulation:
        """Return amplitude and phase of a mesh harmonic; undefined where the first sideband is not resolved."""
        signals, harmonics = self.shaft(shaft), self.settings.modulation_harmonics
        if not signals.shaft.resolved[0]:
            raise UndefinedSignalError
        if shaft not in self._modulations:
            teeth, around = signals.shaft.teeth, signals.sideband_average
            self._modulations[shaft] = demodulated(around, teeth, harmonics, self._half_width(teeth))
        return self._modulations[shaft][harmonic - 1]

    def _residual_band(self, shaft: str, name: str) -> np.ndarray:
        """Return a band of the residual, up to half the sampling rate where the record turns slowest."""
        if shaft not in self._bands:
            self._bands[shaft] = band_signals(self.shaft(shaft).parts.residual, self._carried_order(shaft))
        return np.asarray(self._bands[shaft][_BANDS[name]])

    def _carried_order(self, shaft: str) -> float:
        if self.grid is None:
            return math.inf
        return 0.5 * self.fs_hz / self.grid.slowest_hz * self._shaft(shaft).teeth / self.shafts[0].teeth

    def _shaft_log_spectrum(self, shaft: str) -> np.ndarray:
        if self._shaft(shaft).revolutions < 2:
            raise UndefinedSignalError
        return self.log_spectrum

    def _period_steps(self, shaft: str) -> float:
        """Return one revolution of a shaft in steps of the cepstrum: the gear takes z2/z1 pinion revolutions."""
        own = self._shaft(shaft)
        return 2.0 * self._highest_order * (own.period or own.teeth) / self.shafts[0].teeth

    @property
    def _angle_signal(self) -> np.ndarray:
        if not self.steps.size:
            raise UndefinedSignalError
        return self.steps

    def _shaft_lines(self, shaft: str) -> np.ndarray:
        mine, other = self._shaft(shaft), next(found for found in self.shafts if found.name != shaft)
        if mine.revolutions < 1:
            raise UndefinedSignalError
        return shaft_lines(self.steps, mine.teeth, other.teeth, self.settings.samples_per_tooth)

    def _ripple_bins(self, shaft: str) -> tuple[int, int]:  # noqa: ARG002 - one signature for all
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
            lines_of = signals.average if self._carrier is None else signals.sideband_average
            bands = mesh_basebands(lines_of, teeth, self.settings.mesh_harmonics, self._half_width(teeth))
            for h, envelope in enumerate(np.sqrt(power(bands)), start=1):
                found[f"envelope_fourth_{name}_h{h}"], found[f"envelope_second_{name}_h{h}"] = central_moments(envelope)
        return found
