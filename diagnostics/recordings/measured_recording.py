"""A recording with channels under the model's names and in its units, from a file and what the user says about it.

Times of a tacho's pulses from its sampled waveform. Source: standard literature (level crossing with hysteresis).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from diagnostics.recordings.channel_factor import ACCELERATION_UNIT, UNKNOWN_UNIT, channel_factor
from diagnostics.recordings.columns import signal_problem
from diagnostics.recordings.in_rig import in_rig
from diagnostics.recordings.recorded_columns import OWN_TACHO, Columns
from diagnostics.recordings.roles import ColumnUse
from diagnostics.recordings.taken import RecordingFacts, TakenRecording, channel_names, column_called, take
from diagnostics.recordings.units import known_unit
from siggen.errors import UsageError

HYSTERESIS = 0.2
"""Share of the swing that the waveform must fall below the middle before the next rise counts."""

FEWEST_PULSES = 2
TACHOS_ALIKE = 1e-3
"""Relative difference of mean speeds by which two tachos may differ: their first and last turns are not the same."""

SPEED_MARGIN = 0.01
"""Beyond what a column of speed shows: instruments are off by some permille, and lag behind."""


def pulse_edges(waveform: np.ndarray, fs_hz: float, level: float | None = None) -> np.ndarray:
    """Return the times of rising edges, (k,) [s], interpolated between samples.

    Parameters
    ----------
    waveform : (n,) float
        Voltage or logic level of the tacho.
    fs_hz : float
        Sampling frequency [Hz].
    level : float, optional
        What the waveform crosses, in its unit; the middle of its swing without.
    """
    low, high = np.quantile(waveform, [0.001, 0.999])
    if not high > low:
        return np.empty(0)
    middle = 0.5 * (low + high) if level is None else level
    reset = middle - HYSTERESIS * min(high - low, 2.0 * (middle - low)) if middle > low else middle
    # +1 above the middle, -1 below the reset level, in between the last of both holds
    side = np.where(waveform >= middle, 1, np.where(waveform < reset, -1, 0))
    last = np.maximum.accumulate(np.where(side != 0, np.arange(side.size), 0))
    held = side[last]
    after = np.flatnonzero((held[1:] == 1) & (held[:-1] == -1)) + 1
    step = waveform[after] - waveform[after - 1]
    share = np.where(step > 0, (middle - waveform[after - 1]) / np.where(step > 0, step, 1.0), 1.0)
    return np.asarray((after - 1 + np.clip(share, 0.0, 1.0)) / fs_hz)


@dataclass(frozen=True, slots=True)
class MeasuredRecording:
    """Channels (n,) by the model's names, rate, and pulse times [s] of the pinion where there is a tacho.

    `simulated`: whether the file says that siggen wrote it. `units`: of channels that are not in m/s^2, `unknown` where
    nobody names it. `speed_span_hz`: least and largest speed of the first shaft, where a column of speed tells them.
    """

    path: Path
    channels: Mapping[str, np.ndarray]
    fs_hz: float
    tacho_s: np.ndarray | None
    simulated: bool = False
    units: Mapping[str, str] = field(default_factory=dict)
    speed_span_hz: tuple[float, float] | None = None

    @property
    def duration_s(self) -> float:
        """Length of the recording."""
        return next(iter(self.channels.values())).size / self.fs_hz

    @property
    def tacho_hz(self) -> float | None:
        """Mean rate of the tacho's turns; None without two of them."""
        times_s = self.tacho_s
        if times_s is None or times_s.size < 2:
            return None
        return float((times_s.size - 1) / (times_s[-1] - times_s[0]))

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
    path: Path, names: tuple[str, ...] | None, facts: RecordingFacts, units: tuple[str, ...] = ()
) -> MeasuredRecording:
    """Read the named channels of a file.

    Parameters
    ----------
    path : Path
        The file.
    names : tuple of str, optional
        Channels that the model takes; None: those that the user names, else all vibration of the file.
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
    taken = take(path, facts)
    found = taken.found
    names = names or tuple(facts.columns) or channel_names(taken)
    mapping = _mapping(path, taken, names, facts.columns)
    wanted = dict(zip(names, units or (ACCELERATION_UNIT,) * len(names), strict=True))
    _refuse_other_roles(taken, mapping, wanted)
    signals = {name: found.values[column] for name, column in mapping.items()}
    problems = {name: signal_problem(signal, mapping[name]) for name, signal in signals.items()}
    if any(problems.values()):
        listed = "\n".join(f"  channel {name}: {text}" for name, text in problems.items() if text)
        raise UsageError(f"{path}: cannot be used\n{listed}")
    if len({signal.size for signal in signals.values()}) > 1:
        listed = ", ".join(f"{name} {signal.size}" for name, signal in signals.items())
        raise UsageError(
            f"{path}: channels differ in their number of samples ({listed}); record them together, or name those of "
            f"one length: {in_rig('channels: {NAME: COLUMN}')}"
        )
    fs_hz, factors = _rate_and_factors(taken, mapping, wanted, facts)
    channels = {name: factors[name] * signal for name, signal in signals.items()}
    others = {name: unit for name, unit in wanted.items() if unit != ACCELERATION_UNIT}
    if facts.unit == UNKNOWN_UNIT:
        others |= dict.fromkeys(names, UNKNOWN_UNIT)
    tacho = _tacho(taken, fs_hz, facts)
    span = _speed_span_hz(taken) if tacho is None else None
    return MeasuredRecording(path, channels, fs_hz, tacho, found.simulated, others, span)


def _rate_and_factors(
    taken: TakenRecording, mapping: Mapping[str, str], wanted: Mapping[str, str], facts: RecordingFacts
) -> tuple[float, dict[str, float]]:
    """Return the rate and the factor of each channel; what is missing of both is asked for at once."""
    try:
        scale = _full_scale(taken.path, taken.found, facts)
        factors = {name: scale * _factor(taken, column, facts, wanted[name]) for name, column in mapping.items()}
    except UsageError as error:
        if taken.fs_hz is None:
            try:
                _rate(taken)
            except UsageError as other:
                raise UsageError(f"{other}. {str(error).removeprefix(f'{taken.path}: ')}") from error
        raise
    return _rate(taken), factors


def _rate(taken: TakenRecording) -> float:
    if taken.fs_hz is not None:
        return float(taken.fs_hz)
    hint = taken.found.hint_hz
    said = f"; words above the samples say {hint:g}: --fs {hint:g}" if hint else ", e.g. --fs 51200"
    raise UsageError(f"{taken.path}: sampling rate: received None; give the true one in Hz{said}")


def _refuse_other_roles(taken: TakenRecording, mapping: Mapping[str, str], wanted: Mapping[str, str]) -> None:
    """Refuse columns that are no vibration by unit, name or values as channels of acceleration."""
    for name, column in mapping.items():
        one = taken.column(column)
        if one.role is ColumnUse.VIBRATION or wanted[name] != ACCELERATION_UNIT:
            continue
        raise UsageError(
            f"{taken.path}: column {column} is a {one.role} ({one.why}), not channel {name}; allowed are columns of "
            f"vibration. Name another, {in_rig(f'channels: {{{name}: COLUMN}}')}, or write its unit behind its name "
            f"in the file: a [g]"
        )


def _mapping(path: Path, taken: TakenRecording, names: tuple[str, ...], said: Mapping[str, str]) -> dict[str, str]:
    """Return column by channel: as said, else the channel's own name, else the name this package gives its columns."""
    unknown = sorted(set(said) - set(names))
    if unknown:
        raise UsageError(f"{path}: no channel {', '.join(unknown)} is wanted; wanted are {', '.join(names)}")
    found = taken.found
    signals = [column.name for column in taken.of_role(ColumnUse.VIBRATION)]
    # a recorder of one channel gives it no name; a column that has one may be another than the user means
    alone = signals[0] if len(names) == len(signals) == 1 and signals[0].isdigit() else None
    chosen = {name: column_called(found, name, said.get(name)) or alone for name in names}
    missing = [said.get(name, name) for name, column in chosen.items() if not column]
    if missing:
        example = "channels: {" + ", ".join(f"{name}: COLUMN" for name in names) + "}"
        raise UsageError(
            f"{path}: no column {', '.join(missing)}; wanted are the channels {', '.join(names)}, the file holds "
            f"{', '.join(list(found.values)[:20])}. Say which is which: {in_rig(example)}. They have to be the same "
            f"sensors in "
            "the same directions."
        )
    if len(set(chosen.values())) < len(chosen):
        raise UsageError(f"{path}: one column was named for several channels ({chosen}); each needs its own sensor")
    return {name: column for name, column in chosen.items() if column}


def _factor(taken: TakenRecording, column: str, facts: RecordingFacts, wanted: str) -> float:
    one = taken.column(column)
    by_user = one.unit == UNKNOWN_UNIT or one.why.endswith("the rig file")
    stated = None if by_user else one.unit or None
    return channel_factor(taken.path, column, stated, facts.unit, facts.sensitivity_mv_per_g, wanted)


def _full_scale(path: Path, found: Columns, facts: RecordingFacts) -> float:
    if not found.full_scale:
        return 1.0
    if facts.full_scale is None or not facts.full_scale > 0.0:
        raise UsageError(
            f"{path}: holds shares of full scale; received full scale {facts.full_scale}. Say what it means in "
            f"{facts.unit or 'its unit'}, such as {in_rig('full_scale: 50')}"
        )
    return facts.full_scale


def _tacho(taken: TakenRecording, fs_hz: float, facts: RecordingFacts) -> np.ndarray | None:
    """Return the times of whole turns (k,) [s], from the column that tells the angle."""
    columns = _tacho_columns(taken, facts)
    turns = {column: _turns(taken, column, fs_hz, facts) for column in columns}
    speeds = {name: (times.size - 1) / float(times[-1] - times[0]) for name, times in turns.items() if times.size > 1}
    spans = {name: (hz, hz) for name, hz in speeds.items()}
    if speeds and facts.tacho is None and (span := _speed_span_hz(taken)):
        spans["speed"] = span
    if spans and max(low for low, _ in spans.values()) > (1.0 + TACHOS_ALIKE) * min(high for _, high in spans.values()):
        seen = ", ".join(f"{name} {0.5 * (low + high):.4g} Hz" for name, (low, high) in spans.items())
        raise UsageError(
            f"{taken.path}: columns that tell the speed of the first shaft disagree ({seen}). Say which is on it, and "
            f"its pulses per turn: {in_rig(f'tacho: {columns[0]}, tacho_pulses: 1')}; or leave them out: --speed"
        )
    return turns[columns[0]] if columns else None


def _turns(taken: TakenRecording, column: str, fs_hz: float, facts: RecordingFacts) -> np.ndarray:
    """Return the times of whole turns (k,) [s] that a column tells."""
    path, found = taken.path, taken.found
    values, one = found.values[column], taken.column(column)
    unit = known_unit(one.unit)
    if one.role is ColumnUse.ANGLE and unit is not None and unit.quantity == "angle":
        return _whole_turns(path, column, _unwrapped(values * unit.factor, 1.0), fs_hz)
    pulses = facts.tacho_pulses or (1 if column == OWN_TACHO else None)
    if pulses is None:
        what = "a turn of the encoder counts to" if one.role is ColumnUse.COUNTER else "pulses per turn it gives"
        raise UsageError(
            f"{path}: column {column} is a {one.role}; say how many {what}: {in_rig('tacho_pulses: 1')}. Without it: "
            f"--speed"
        )
    if one.role is ColumnUse.ANGLE:
        raise UsageError(
            f"{path}: column {column} is an angle without a unit; write it behind its name: {column} [deg]"
        )
    if one.role is ColumnUse.COUNTER:
        return _whole_turns(path, column, _unwrapped(values, _wraps_at(values)) / pulses, fs_hz)
    is_times = column == OWN_TACHO or values.size < taken.rows
    times_s = values if is_times else pulse_edges(values, fs_hz, facts.tacho_level)
    if times_s.size < FEWEST_PULSES or not np.isfinite(times_s).all() or not (np.diff(times_s) > 0).all():
        raise UsageError(
            f"{path}: {times_s.size} pulses in column {column}, or not increasing; an angle needs two or more. Name "
            f"the level they cross, {in_rig('tacho_level: 2.5')}, or leave `tacho` out and give --speed."
        )
    return np.asarray(times_s[::pulses])


def _tacho_columns(taken: TakenRecording, facts: RecordingFacts) -> list[str]:
    """Return the column that the user names, else all that tell the angle by name and unit."""
    found = taken.found
    if facts.tacho is not None:
        column = column_called(found, facts.tacho, facts.tacho)
        if column is None:
            raise UsageError(
                f"{taken.path}: no column {facts.tacho}, which `tacho` of the rig file names; the file holds "
                f"{', '.join(found.values)}"
            )
        return [column]
    if not facts.tacho_by_name:
        return []
    named = [one.name for one in taken.of_role(ColumnUse.TACHO)]
    angles = [one.name for one in taken.of_role(ColumnUse.ANGLE) if known_unit(one.unit) is not None]
    return [*named, *angles]


def _unwrapped(values: np.ndarray, period: float) -> np.ndarray:
    """Return what begins anew every period (0: never) as what goes on rising, by the nearest way."""
    steps = np.diff(values)
    if period > 0.0:
        steps = steps - period * np.rint(steps / period)
    whole = np.concatenate([values[:1], values[0] + np.cumsum(steps)])
    return whole if whole[-1] >= whole[0] else -whole


def _wraps_at(counts: np.ndarray) -> float:
    """Return the period of a counter that begins anew: the next power of two over its reach; 0 where it never does."""
    steps = np.diff(counts)
    reach = float(np.ptp(counts)) + 1.0
    if not (np.abs(steps) > 0.5 * reach).any():
        return 0.0
    power = float(2.0 ** np.ceil(np.log2(reach)))
    return power if reach > 0.95 * power else reach


def _whole_turns(path: Path, column: str, turns: np.ndarray, fs_hz: float) -> np.ndarray:
    """Return when an angle in turns (n,) passes whole ones, (k,) [s].

    Raises
    ------
    UsageError
        If it does not rise, or by less than two turns.
    """
    rising = np.maximum.accumulate(turns)
    if not np.isfinite(turns).all() or (rising - turns).max() > 0.5 or rising[-1] - rising[0] < FEWEST_PULSES:
        raise UsageError(
            f"{path}: column {column} turns by {np.ptp(turns):.3g}, or back; allowed: an angle that rises by two turns "
            "or more. Is `tacho_pulses` of the rig file right? Else leave `tacho` out and give --speed"
        )
    marks = np.arange(np.ceil(rising[0]), np.floor(rising[-1]) + 1.0)
    after = np.clip(np.searchsorted(rising, marks), 1, rising.size - 1)
    before = rising[after - 1]
    # of a counter the sample that reaches a mark is the first one at or over it; an angle is straight between samples
    share = np.clip((marks - before) / np.maximum(rising[after] - before, 1e-300), 0.0, 1.0)
    return np.asarray((after - 1 + share) / fs_hz)


def _speed_span_hz(taken: TakenRecording) -> tuple[float, float] | None:
    """Return the span of a column of speed, if there is one with a unit that turns."""
    for one in taken.of_role(ColumnUse.SPEED):
        unit, values = known_unit(one.unit), np.abs(taken.found.values[one.name])
        if unit is not None and unit.quantity == "speed" and np.isfinite(values).all() and values.min() > 0.0:
            low, high = (unit.factor * float(value) for value in np.quantile(values, [0.001, 0.999]))
            return low * (1.0 - SPEED_MARGIN), high * (1.0 + SPEED_MARGIN)
    return None
