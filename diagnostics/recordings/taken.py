"""Taken: what is taken of a file before anything is computed of it: its rate, and role, unit and factor of each column.

A role follows from what the user said, then from the unit, the name and the values of a column. What nothing tells is
asked for by the option that answers; nothing is guessed in silence.
"""

from __future__ import annotations

import logging
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from diagnostics.recordings.channel_factor import UNKNOWN_UNIT
from diagnostics.recordings.columns import read_columns
from diagnostics.recordings.in_rig import in_rig
from diagnostics.recordings.recorded_columns import OWN_TACHO, Columns
from diagnostics.recordings.roles import ColumnUse, named_role
from diagnostics.recordings.sample_times import (
    USED_BAND,
    SampleTimes,
    counts_samples,
    looks_like_time,
    resampled,
    sample_times,
)
from diagnostics.recordings.units import ACCELERATION, known_unit, unit_of_name
from siggen.errors import UsageError, counted
from siggen.printable import printable

MOST_CHANNELS = 32
SHOWN_COLUMNS = 40
LEAST_RATE_HZ = 10.0
CUT_SHARE = 1e-3
"""Lengths that differ by less are those of one recording, stopped channel by channel."""
STATED_ALIKE, TIMES_ALIKE = 1e-5, 1e-3
"""Rates that are the same: of a header, and of times that are rounded."""
Source = tuple[Path, int | None]
"""File of a recording, and its row in a Parquet file with one record per row."""
OWN_COLUMN = "accel_{}_m_s2"
"""How siggen calls a channel in files whose columns cannot say what they hold, such as CSV."""
_IS_OWN = re.compile(OWN_COLUMN.format("(.+)"))  # accel_m_s2 names no channel


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
        Unit of channels of which the file states none; `unknown`: none is stated, and levels are relative.
    sensitivity_mv_per_g : float or None
        For voltages.
    full_scale : float or None
        What full scale of an integer WAV file means, in the unit.
    tacho : str or None
        Column that tells the angle: a tacho's waveform, pulse times [s], an angle, or an encoder's counts.
    tacho_pulses : int or None
        Pulses or counts of it per revolution of the pinion.
    row : int or None
        Row of a Parquet file with one record per row.
    tacho_level : float or None
        Level that a tacho's waveform crosses upwards, in its unit; None: the middle of its swing.
    resample_hz : float or None
        Rate that samples at uneven times are laid on.
    tacho_by_name : bool
        Whether a column that is a tacho or an angle by its name is taken without being named.
    """

    fs_hz: float | None = None
    columns: Mapping[str, str] = field(default_factory=dict)
    unit: str | None = None
    sensitivity_mv_per_g: float | None = None
    full_scale: float | None = None
    tacho: str | None = None
    tacho_pulses: int | None = None
    row: int | None = None
    tacho_level: float | None = None
    resample_hz: float | None = None
    tacho_by_name: bool = False


@dataclass(frozen=True, slots=True)
class TakenColumn:
    """A column: role, unit as stated or `unknown`, factor to m/s2 where that is known, and what says so."""

    name: str
    role: ColumnUse
    unit: str
    factor: float | None
    why: str


@dataclass(frozen=True, slots=True)
class TakenRecording:
    """What is taken of a file.

    Attributes
    ----------
    path : Path
    found : Columns
        Values as read, cut where lengths differ by little; laid on even times where the user says so.
    columns : tuple of TakenColumn
    fs_hz : float or None
        Rate that the file states or the user says; None if neither does.
    rate_why : str
    notes : tuple of str
        What was left out, cut, shifted or resampled.
    """

    path: Path
    found: Columns
    columns: tuple[TakenColumn, ...]
    fs_hz: float | None
    rate_why: str
    notes: tuple[str, ...]

    def of_role(self, role: ColumnUse) -> tuple[TakenColumn, ...]:
        """Return the columns of a role."""
        return tuple(column for column in self.columns if column.role is role)

    def column(self, name: str) -> TakenColumn:
        """Return a column by its name."""
        return next(column for column in self.columns if column.name == name)

    @property
    def rows(self) -> int:
        """Number of samples."""
        return max((values.size for values in self.found.values.values()), default=0)

    def layout_sentence(self) -> str:
        """Return format, rows and rate in a line."""
        layout = ", ".join(
            f"{what} {value}" if what in ("separator", "decimal mark") else value
            for what, value in self.found.layout.items()
        )
        rate = f"{self.fs_hz:.10g} Hz ({self.rate_why})" if self.fs_hz else "no rate"
        return f"{layout or 'arrays'}; {self.rows} rows; {rate}"

    def table(self) -> str:
        """Return the columns as a table of plain text."""
        rows = [("column", "role", "unit", "factor", "from")]
        for one in self.columns[:SHOWN_COLUMNS]:
            factor = "" if one.factor is None else f"{one.factor:.6g}"
            rows.append((one.name[:SHOWN_COLUMNS], str(one.role), one.unit, factor, one.why))
        widths = [max(len(row[k]) for row in rows) for k in range(4)]
        lines = ["  " + "  ".join([*(row[k].ljust(widths[k]) for k in range(4)), row[4]]).rstrip() for row in rows]
        if more := len(self.columns) - SHOWN_COLUMNS:
            lines += [f"  and {counted(more, 'more column')}"] if more > 0 else []
        return "\n".join([*lines, *(f"  note: {note}" for note in self.notes)])


_said: dict[str, str] = {}
"""Table that was printed -> file of which."""


def say_taken(taken: TakenRecording) -> None:
    """Print what was taken of a file; of files alike the table of the first one."""
    key = f"{taken.found.layout}{taken.fs_hz}{taken.table()}"
    mine = f"{key}{taken.path}{taken.rows}"
    if mine in _said:
        return
    first = _said.setdefault(key, taken.path.name)
    text = f"{taken.layout_sentence()}\n{taken.table()}" if first == taken.path.name else f"as of {first}"
    if first != taken.path.name:
        text += f"; {taken.rows} rows"
    _said[mine] = taken.path.name
    logging.getLogger(__name__).warning("%s", printable(f"what I took of {taken.path.name}: {text}", lines=True))


def take(path: Path, facts: RecordingFacts, *, say: bool = True) -> TakenRecording:
    """Read a file and return what is taken of it, which is printed unless `say` is false.

    Raises
    ------
    UsageError
        If it cannot be read, its times jump or are uneven without `resample_hz`, or two times differ.
    """
    found = read_columns(path, facts.row)
    units = _units(path, found)
    if facts.tacho is not None:
        facts = replace(facts, tacho=column_called(found, facts.tacho, facts.tacho) or facts.tacho)
    columns = _roles(found, units, facts)
    fs_hz, rate_why, uneven, columns = _rate(path, found, columns, facts)
    found, notes = _cut(found, columns)
    notes = [*found.notes, *notes]
    if uneven is not None:
        found, fs_hz, note = _resampled(path, found, columns, uneven, facts)
        rate_why, notes = "the rig file", [*notes, note]
    taken = TakenRecording(path, found, tuple(columns), fs_hz, rate_why, tuple(notes))
    if say:
        say_taken(taken)
    return taken


def channel_names(taken: TakenRecording) -> tuple[str, ...]:
    """Return the names of the vibration channels of what was taken; see `channel_columns`."""
    return tuple(channel_columns(taken))


def channel_columns(taken: TakenRecording) -> dict[str, str]:
    """Return column by name of the vibration channels of what was taken.

    Raises
    ------
    UsageError
        If there are none, or very many.
    """
    if taken.found.own:
        return dict(taken.found.own)
    names = [column.name for column in taken.of_role(ColumnUse.VIBRATION)]
    own = {found[1]: name for name in names if (found := _IS_OWN.fullmatch(name))}
    if not 1 <= len(own or names) <= MOST_CHANNELS:
        raise UsageError(
            f"{taken.path}: {len(own or names)} columns that could be vibration; allowed: 1 to {MOST_CHANNELS}. Name "
            f"those that you mean: {in_rig('channels: {NAME: COLUMN}')}"
        )
    if own:
        return own
    plain = [unit_of_name(name)[0] for name in names]
    return dict(zip(plain if len(set(plain)) == len(plain) else names, names, strict=True))


def column_called(found: Columns, name: str, said: str | None) -> str | None:
    """Return the column of a channel: as the user says, else as the file says, else by its name; None if there is none.

    A column may be said by its position from 1, or without the unit that stands behind its name.
    """
    for wanted in (said,) if said else (found.own.get(name), name, OWN_COLUMN.format(name)):
        if wanted in found.values:
            return str(wanted)
        if said and said.isdigit() and 1 <= int(said) <= len(found.values):
            return list(found.values)[int(said) - 1]
        if len(plain := [column for column in found.values if unit_of_name(column)[0] == wanted]) == 1:
            return plain[0]
    return None


def unit_or_unknown(taken: TakenRecording, names: Sequence[str], facts: RecordingFacts) -> RecordingFacts:
    """Return what the user says, with the unit `unknown` where neither file nor user names that of the channels."""
    columns = {facts.columns.get(name, name) for name in names}
    units = {one.unit for one in taken.columns if one.role is ColumnUse.VIBRATION and one.name in columns}
    return replace(facts, unit=UNKNOWN_UNIT) if facts.unit is None and units == {UNKNOWN_UNIT} else facts


def _units(path: Path, found: Columns) -> dict[str, tuple[str, str]]:
    """Return the unit of each column and what states it; of the file, else of the name.

    Raises
    ------
    UsageError
        If both do and differ.
    """
    units = {}
    for name in found.values:
        in_name, stated = unit_of_name(name)[1], found.units.get(name, "")
        known, by_name = known_unit(stated), known_unit(in_name)
        if known and by_name and known != by_name and name not in found.own.values():
            raise UsageError(
                f"{path}: column {name}: its name states the unit {in_name}, the file {stated}; correct the file"
            )
        if stated:
            units[name] = (stated, "unit of the file")
        elif by_name is not None or (in_name and name.endswith("]")):
            units[name] = (in_name, "unit in the name")
        else:
            units[name] = ("", "")
    return units


def _roles(found: Columns, units: Mapping[str, tuple[str, str]], facts: RecordingFacts) -> list[TakenColumn]:
    """Return the columns with their roles."""
    samples = max(values.size for values in found.values.values())
    timed = any(named_role(unit_of_name(name)[0], units[name][0]).role is ColumnUse.TIME for name in found.values)
    columns = []
    for name, values in found.values.items():
        unit, why = units[name]
        role, by = named_role(unit_of_name(name)[0], unit)
        stated = known_unit(unit)
        is_acceleration = stated is not None and stated.quantity == ACCELERATION
        if name in found.own.values():
            role, by = ColumnUse.VIBRATION, "the file says so"
        elif name in (OWN_TACHO, facts.tacho):
            role = role if role in (ColumnUse.ANGLE, ColumnUse.COUNTER) else ColumnUse.TACHO
            by = "the rig file" if name == facts.tacho else "name"
        elif role is ColumnUse.VIBRATION and not is_acceleration and values.size == samples:
            role, by = _role_of_values(values, timed=timed) or (role, by)
        factor = None
        if role is ColumnUse.VIBRATION:
            said = "" if unit else facts.unit or ""
            named = known_unit(unit or said)
            factor = named.factor if named is not None and named.quantity == ACCELERATION else None
            unit, why = (
                (unit, why)
                if unit
                else (said or UNKNOWN_UNIT, {"": "", UNKNOWN_UNIT: "levels are relative"}.get(said, "the rig file"))
            )
        reasons = [by if not by.startswith("unit ") else "", why]
        columns.append(TakenColumn(name, role, unit, factor, "; ".join(filter(None, reasons)) or "no other role"))
    return columns


def _role_of_values(values: np.ndarray, *, timed: bool) -> tuple[ColumnUse, str] | None:
    """Return what the values of a column without a telling name show: a counter, or a time."""
    if counts_samples(values):
        return ColumnUse.COUNTER, "counts up by one"
    if not looks_like_time(values):
        return None
    # beside a time, or at a rate that seconds of no recording have, it is something else that rises
    rate_hz = (values.size - 1) / float(values[-1] - values[0])
    return (ColumnUse.COUNTER if timed or rate_hz < LEAST_RATE_HZ else ColumnUse.TIME), "rises by equal steps"


def _rate(
    path: Path, found: Columns, columns: list[TakenColumn], facts: RecordingFacts
) -> tuple[float | None, str, np.ndarray | None, list[TakenColumn]]:
    """Return rate, its source, times that are uneven, and the columns, of which a time that states nothing counts."""
    said, samples = facts.fs_hz, max(values.size for values in found.values.values())
    if said is not None and not (math.isfinite(said) and said > 0.0):
        raise UsageError(f"{path}: sampling rate: received {said}; give the true one in Hz, e.g. --fs 51200")
    stated: dict[str, SampleTimes] = {}
    for column in [one for one in columns if one.role is ColumnUse.TIME]:
        values = found.values[column.name]
        if values.size < samples * (1.0 - CUT_SHARE):
            columns[columns.index(column)] = TakenColumn(
                column.name, ColumnUse.LABEL, column.unit, None, f"{values.size} values, no time of samples"
            )
            continue
        unit = "" if column.unit == UNKNOWN_UNIT else column.unit
        stated[column.name] = sample_times(path, column.name, values, unit, said or found.fs_hz)
    rates = {name: one.fs_hz for name, one in stated.items()}
    if rates and max(rates.values()) > min(rates.values()) * (1.0 + TIMES_ALIKE):
        fits = [name for name, rate in rates.items() if said and abs(rate / said - 1.0) < TIMES_ALIKE]
        if not fits:
            listed = ", ".join(f"{name} {rate:g} Hz" for name, rate in rates.items())
            raise UsageError(
                f"{path}: sampling rate: columns of two times state {listed}; give the true one in Hz, e.g. --fs 51200"
            )
        stated = {name: stated[name] for name in fits}
    times = next(iter(stated.values()), None)
    rate, why = (found.fs_hz, "the file states it") if found.fs_hz else (None, "")
    if times is not None:
        if rate is not None and abs(times.fs_hz / rate - 1.0) > TIMES_ALIKE:
            raise UsageError(f"{path}: states {rate:g} Hz, its times {times.fs_hz:g} Hz; correct the file")
        rate, why = (rate, why) if rate is not None else (times.fs_hz, times.why)
    alike = STATED_ALIKE if found.fs_hz or times is None or "coarse" not in times.why else TIMES_ALIKE
    if rate and said and abs(said / rate - 1.0) > alike:
        raise UsageError(
            f"{path}: states {rate:g} Hz, received {said:g} Hz by --fs or the rig file; leave it out or correct the "
            f"file"
        )
    uneven = times.uneven_s if times is not None else None
    return (said or rate), ("as said" if said else why), uneven, columns


def _cut(found: Columns, columns: list[TakenColumn]) -> tuple[Columns, list[str]]:
    """Return the columns cut to the shortest, where their lengths differ by little."""
    sizes = {column.name: found.values[column.name].size for column in columns if column.role is not ColumnUse.LABEL}
    longest = max(sizes.values(), default=0)
    near = {name: size for name, size in sizes.items() if size > longest * (1.0 - CUT_SHARE)}
    shortest = min(near.values(), default=0)
    if shortest == longest:
        return found, []
    values = {name: column[:shortest] if name in near else column for name, column in found.values.items()}
    cut = ", ".join(f"{name} {size}" for name, size in near.items())
    return replace(found, values=values), [
        f"lengths differ ({cut}): cut to the shortest by {longest - shortest} samples"
    ]


def _resampled(
    path: Path, found: Columns, columns: list[TakenColumn], times_s: np.ndarray, facts: RecordingFacts
) -> tuple[Columns, float, str]:
    """Return the columns at even times."""
    mean_hz = (times_s.size - 1) / float(times_s[-1])
    rate_hz = facts.resample_hz
    if rate_hz is None or not 0.0 < rate_hz <= mean_hz * 1.01:
        name = next(column.name for column in columns if column.role is ColumnUse.TIME)
        steps = np.diff(times_s) * mean_hz
        came = "" if rate_hz is None else f", received `resample_hz: {rate_hz:g}`"
        raise UsageError(
            f"{path}: column {name}: its times are uneven, steps of {steps.min():.3f} to {steps.max():.3f} times the "
            f"mean one{came}; allowed: equal steps. {in_rig(f'resample_hz: {mean_hz:.0f}')} (or less) lays the "
            f"samples on "
            f"even times by a spline; {USED_BAND:g} of that rate is then used"
        )
    size = min(times_s.size, *(v.size for c in columns if (v := found.values[c.name]).size >= times_s.size * 0.999))
    times_s = times_s[:size]
    values = {
        column.name: resampled(times_s, found.values[column.name][:size], rate_hz)
        if found.values[column.name].size >= size
        else found.values[column.name]
        for column in columns
        if column.role is not ColumnUse.TIME
    }
    note = (
        f"uneven times at {mean_hz:.6g} Hz in the mean laid on {rate_hz:g} Hz by a spline, low-passed to "
        f"{USED_BAND * rate_hz:g} Hz"
    )
    return replace(found, values=values), rate_hz, note
