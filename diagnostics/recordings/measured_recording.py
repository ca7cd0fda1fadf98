"""A recording with channels under the model's names and in its units, from a file and what the user says about it.

Times of a tacho's pulses from its sampled waveform. Source: standard literature (level crossing with hysteresis).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from diagnostics.recordings.channel_factor import ACCELERATION_UNIT, ASSUMED, channel_factor
from diagnostics.recordings.columns import read_columns, signal_problem
from diagnostics.recordings.recorded_columns import OWN_TACHO, Columns
from diagnostics.recordings.roles import ColumnUse, named_role
from diagnostics.recordings.units import known_unit, unit_of_name
from siggen.errors import UsageError

HYSTERESIS = 0.2
"""Share of the swing that the waveform must fall below the middle before the next rise counts."""

OWN_COLUMN = "accel_{}_m_s2"
"""How siggen calls a channel in files whose columns cannot say what they hold, such as CSV."""
RATES_ALIKE = 1e-5
"""A rate that a time column states is as exact as its digits: 1e-6 s in 0.1 s."""


def pulse_edges(waveform: np.ndarray, fs_hz: float) -> np.ndarray:
    """Return the times of rising edges through the middle of the swing, (k,) [s], interpolated between samples.

    Parameters
    ----------
    waveform : (n,) float
        Voltage or logic level of the tacho.
    fs_hz : float
        Sampling frequency [Hz].
    """
    low, high = np.quantile(waveform, [0.001, 0.999])
    if not high > low:
        return np.empty(0)
    middle, reset = 0.5 * (low + high), 0.5 * (low + high) - HYSTERESIS * (high - low)
    # +1 above the middle, -1 below the reset level, in between the last of both holds
    level = np.where(waveform >= middle, 1, np.where(waveform < reset, -1, 0))
    last = np.maximum.accumulate(np.where(level != 0, np.arange(level.size), 0))
    held = level[last]
    after = np.flatnonzero((held[1:] == 1) & (held[:-1] == -1)) + 1
    step = waveform[after] - waveform[after - 1]
    share = np.where(step > 0, (middle - waveform[after - 1]) / np.where(step > 0, step, 1.0), 1.0)
    return np.asarray((after - 1 + np.clip(share, 0.0, 1.0)) / fs_hz)


@dataclass(frozen=True, slots=True)
class RecordingFacts:
    """What the user says about files that they do not say themselves.

    Attributes
    ----------
    fs_hz : float or None
        Sampling frequency [Hz] of files that do not state it themselves.
    columns : mapping of str to str
        Channel name of the model to column of the file; empty where the file uses the model's names.
    unit : str or None
        Unit of all channels, see `factor_to_m_s2`; None: the file's, and m/s2 where it states none.
    sensitivity_mv_per_g : float or None
        For voltages.
    full_scale : float or None
        What full scale of an integer WAV file means, in the unit.
    tacho : str or None
        Column with the tacho's waveform, or with pulse times [s] where it is called `tacho_s`.
    tacho_pulses : int
        Pulses of the tacho per pinion revolution.
    row : int or None
        Row of a Parquet file with one record per row.
    """

    fs_hz: float | None = None
    columns: Mapping[str, str] = field(default_factory=dict)
    unit: str | None = None
    sensitivity_mv_per_g: float | None = None
    full_scale: float | None = None
    tacho: str | None = None
    tacho_pulses: int = 1
    row: int | None = None


@dataclass(frozen=True, slots=True)
class MeasuredRecording:
    """Channels (n,) by the model's names, rate, and pulse times [s] of the pinion where there is a tacho.

    `simulated`: whether the file says that siggen wrote it. `units`: of channels that are not in m/s^2.
    """

    path: Path
    channels: Mapping[str, np.ndarray]
    fs_hz: float
    tacho_s: np.ndarray | None
    simulated: bool = False
    units: Mapping[str, str] = field(default_factory=dict)

    @property
    def duration_s(self) -> float:
        """Length of the recording."""
        return next(iter(self.channels.values())).size / self.fs_hz

    def shown_unit(self, channel: str) -> str:
        """Return the unit of a channel as pages and pictures show it."""
        unit = self.units.get(channel, ACCELERATION_UNIT)
        return unit.replace("^2", "²").replace("^3", "³").replace("um", "µm")

    @property
    def levels_sentence(self) -> str:
        """What unit the levels of each channel have, for captions."""
        shown = {channel: self.shown_unit(channel) for channel in self.channels}
        if len(set(shown.values())) == 1:
            return f"Levels in {next(iter(shown.values()))}, ratios without unit."
        each = ", ".join(f"of {channel} in {unit}" for channel, unit in shown.items())
        return f"Levels {each}; ratios without unit."


def read_recording(
    path: Path, names: tuple[str, ...], facts: RecordingFacts, units: tuple[str, ...] = ()
) -> MeasuredRecording:
    """Read the named channels of a file.

    Parameters
    ----------
    path : Path
        The file.
    names : tuple of str
        Channels that the model takes.
    facts : RecordingFacts
        Rate, columns, unit, tacho.
    units : tuple of str, optional
        Units that the channels are wanted in; m/s^2 without.

    Raises
    ------
    UsageError
        Naming the file and the way out: unreadable, unknown rate, columns that are not there, signals that are not
        finite, constant, clipped or of another quantity than is wanted.
    """
    found = read_columns(path, facts.row)
    fs_hz = _rate(path, found, facts.fs_hz)
    mapping = _mapping(path, found, names, facts.columns)
    signals = {name: found.values[column] for name, column in mapping.items()}
    problems = {name: signal_problem(signal, mapping[name]) for name, signal in signals.items()}
    if any(problems.values()):
        listed = "\n".join(f"  channel {name}: {text}" for name, text in problems.items() if text)
        raise UsageError(f"{path}: cannot be used\n{listed}")
    if len({signal.size for signal in signals.values()}) > 1:
        listed = ", ".join(f"{name} {signal.size}" for name, signal in signals.items())
        raise UsageError(f"{path}: channels differ in their number of samples ({listed}); record them together")
    scale = _full_scale(path, found, facts)
    wanted = dict(zip(names, units or (ACCELERATION_UNIT,) * len(names), strict=True))
    factors = {name: scale * _factor(path, found, column, facts, wanted[name]) for name, column in mapping.items()}
    channels = {name: factors[name] * signal for name, signal in signals.items()}
    others = {name: unit for name, unit in wanted.items() if unit != ACCELERATION_UNIT}
    return MeasuredRecording(path, channels, fs_hz, _tacho(path, found, fs_hz, facts), found.simulated, others)


def _rate(path: Path, found: Columns, said: float | None) -> float:
    if found.fs_hz and said and abs(said / found.fs_hz - 1.0) > RATES_ALIKE:
        raise UsageError(
            f"{path}: states {found.fs_hz:g} Hz, received --fs {said:g}; leave --fs out or correct the file"
        )
    rate = said or found.fs_hz
    if rate is None or not (np.isfinite(rate) and rate > 0.0):
        rates = ", ".join(f"{name} {rate:g} Hz" for name, rate in found.clocks.items() if rate is not None)
        against = f" (columns that rise evenly state {rates})" if rates else ""
        raise UsageError(f"{path}: sampling rate: received {rate}{against}; give the true one in Hz, e.g. --fs 51200")
    return float(rate)


def _mapping(path: Path, found: Columns, names: tuple[str, ...], said: Mapping[str, str]) -> dict[str, str]:
    """Return column by channel: as said, else the channel's own name, else the name this package gives its columns."""
    unknown = sorted(set(said) - set(names))
    if unknown:
        raise UsageError(f"{path}: no channel {', '.join(unknown)} is wanted; wanted are {', '.join(names)}")
    signals = [column for column in found.values if column not in found.clocks]
    # a recorder of one channel gives it no name; a column that has one may be another than the user means
    alone = signals[0] if len(names) == len(signals) == 1 and signals[0].isdigit() else None
    chosen = {name: _column(found, name, said.get(name)) or alone for name in names}
    missing = [said.get(name, name) for name, column in chosen.items() if not column]
    if missing:
        example = " ".join(f"--channel {name}=COLUMN" for name in names)
        raise UsageError(
            f"{path}: no column {', '.join(missing)}; wanted are the channels {', '.join(names)}, the file holds "
            f"{', '.join(list(found.values)[:20])}. Say which is which: {example}. They have to be the same sensors in "
            "the same directions."
        )
    if timed := [name for name, column in chosen.items() if column in found.clocks]:
        raise UsageError(
            f"{path}: column {chosen[timed[0]]} rises by equal steps: it is a time, not channel {timed[0]}"
        )
    if len(set(chosen.values())) < len(chosen):
        raise UsageError(f"{path}: one column was named for several channels ({chosen}); each needs its own sensor")
    return {name: column for name, column in chosen.items() if column}


def _column(found: Columns, name: str, said: str | None) -> str | None:
    for wanted in (said,) if said else (found.own.get(name), name, OWN_COLUMN.format(name)):
        if wanted in found.values:
            return str(wanted)
        if said and said.isdigit() and 1 <= int(said) <= len(found.values):
            return list(found.values)[int(said) - 1]
    return None


def _factor(path: Path, found: Columns, column: str, facts: RecordingFacts, wanted: str) -> float:
    """Return the factor, of columns that are vibration by name and unit; a rig's own channels are what they are."""
    by_name = named_role(unit_of_name(column)[0], "").role
    of_rig = wanted != ACCELERATION_UNIT or column in found.own.values()
    if not of_rig and by_name is not ColumnUse.VIBRATION and known_unit(found.units.get(column, "")) is None:
        raise UsageError(
            f"{path}: column {column} is called as a {by_name} is; allowed are columns of vibration. Name another "
            "(--channel NAME=COLUMN), or call it as what it is, with its unit: a [g]"
        )
    return channel_factor(path, column, found.units.get(column), facts.unit, facts.sensitivity_mv_per_g, wanted)


def _full_scale(path: Path, found: Columns, facts: RecordingFacts) -> float:
    if not found.full_scale:
        return 1.0
    if facts.full_scale is None or not facts.full_scale > 0.0:
        raise UsageError(
            f"{path}: holds shares of full scale; received full scale {facts.full_scale}. Say what it means in "
            f"{facts.unit or ASSUMED}, e.g. --full-scale 50"
        )
    return facts.full_scale


def _tacho(path: Path, found: Columns, fs_hz: float, facts: RecordingFacts) -> np.ndarray | None:
    if facts.tacho is None:
        return None
    column = _column(found, facts.tacho, facts.tacho)
    if column is None:
        raise UsageError(f"{path}: no column {facts.tacho} for --tacho; the file holds {', '.join(found.values)}")
    values = found.values[column]
    times_s = values if column == OWN_TACHO else pulse_edges(values, fs_hz)
    if times_s.size < 2 or not np.isfinite(times_s).all() or not (np.diff(times_s) > 0).all():
        raise UsageError(
            f"{path}: {times_s.size} pulses in column {column}, or not increasing; an angle needs two or more. Leave "
            "--tacho out and give --speed-range."
        )
    return np.asarray(times_s[:: facts.tacho_pulses])
