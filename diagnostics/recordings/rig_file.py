"""RigFile: what a user says once of all recordings of a machine, as YAML; one that is not there is written.

teeth: 25,56                 # of pinion and gear, or a configuration: gearbox.yaml
speed: 14,26                 # of the first shaft [Hz], or 1780rpm
channels: {lid: ch1}         # name: column
unit: g
tacho: pulse
tacho_pulses: 1
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import inf
from pathlib import Path
from typing import Any

from diagnostics.recordings.taken import RecordingFacts, Source, channel_columns, take
from siggen.errors import ConfigError, Problem, UsageError
from siggen.file_writing import write_file
from siggen.keys.yaml_source import read_yaml
from siggen.printable import printable

LONGEST_TEXT = 300


@dataclass(frozen=True, slots=True)
class RigFile:
    """What a rig file says.

    Attributes
    ----------
    said : mapping
        Fields of `RecordingFacts` that it names, `columns` among them.
    teeth, speed : str or None
        As the options of these names take them.
    torque_nm : (float, float) or None
        Of the recordings.
    """

    said: Mapping[str, Any] = field(default_factory=dict)
    teeth: str | None = None
    speed: str | None = None
    torque_nm: tuple[float, float] | None = None

    def over(self, facts: RecordingFacts) -> RecordingFacts:
        """Return facts with what the file says in place of theirs; columns of channels that it does not name stay."""
        columns = {**facts.columns, **self.said.get("columns", {})}
        return replace(facts, **{**self.said, "columns": columns})


def _number(value: object) -> float | None:
    plain = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if plain and 0.0 < value < inf else None  # type: ignore[arg-type, operator]


def _level(value: object) -> float | None:
    plain = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if plain and -inf < value < inf else None  # type: ignore[arg-type, operator]


def _count(value: object) -> int | None:
    return value if isinstance(value, int) and not isinstance(value, bool) and value >= 1 else None


def _text(value: object) -> str | None:
    shown = str(value) if isinstance(value, (str, int, float)) and not isinstance(value, bool) else ""
    return shown if 0 < len(shown) <= LONGEST_TEXT else None


def _listed(value: object) -> str | None:
    """Return a text, a number, or two of them in a list, with a comma between."""
    if isinstance(value, list):
        parts = [_text(part) for part in value]
        return ",".join(filter(None, parts)) if len(parts) == 2 and all(parts) else None
    return _text(value)


def _pair(value: object) -> tuple[float, float] | None:
    said = _listed(value) or ""
    try:
        low, high = (float(part) for part in (said if "," in said else f"{said},{said}").split(","))
    except ValueError:
        return None
    return (low, high) if 0.0 <= low <= high < inf else None


def _columns(value: object) -> dict[str, str] | None:
    if not isinstance(value, Mapping):
        return None
    found = {name: _text(column) for name, column in value.items()}
    return {name: column for name, column in found.items() if column} if all(found.values()) else None


@dataclass(frozen=True, slots=True)
class _Key:
    read: Callable[[object], Any]
    allowed: str
    example: str
    comment: str
    of_facts: str = ""


KEYS = {
    "teeth": _Key(_listed, "two whole numbers, or a configuration", "25,56", "of pinion and gear, or gearbox.yaml"),
    "fs_hz": _Key(_number, "a rate [Hz]", "25600", "where the file does not state it", "fs_hz"),
    "speed": _Key(
        _listed, "a range or a speed", "14,26", "of the first shaft [Hz], or 1780rpm; beside tacho a control"
    ),
    "channels": _Key(_columns, "columns by names of channels", "{lid: ch1}", "name: column, or its place", "columns"),
    "unit": _Key(_text, "a unit", "g", "m/s2, g, mg, mV, V or another, where no column states it", "unit"),
    "sensitivity_mv_per_g": _Key(_number, "a number", "100", "for mV and V", "sensitivity_mv_per_g"),
    "full_scale": _Key(_number, "a number", "50", "of an integer WAV file, in the unit", "full_scale"),
    "tacho": _Key(_text, "a column", "pulse", "what tells the angle: tacho, pulse times, angle, counts", "tacho"),
    "tacho_pulses": _Key(_count, "a whole number from 1 on", "1", "of a turn of the first shaft", "tacho_pulses"),
    "tacho_level": _Key(_level, "a number", "2.5", "that its waveform crosses upwards", "tacho_level"),
    "resample_hz": _Key(_number, "a rate [Hz]", "5000", "lays samples at uneven times on even ones", "resample_hz"),
    "torque_nm": _Key(_pair, "two numbers, the lower one first", "15,60", "of the recordings, for calibrate"),
}


def _plain(text: str) -> bool:
    return re.fullmatch(r"[\w.,/-]+", text) is not None


def read_rig_file(file: Path) -> RigFile:
    """Return what a rig file says.

    Raises
    ------
    UsageError, ConfigError
        If it is no YAML, or has keys or values that are not allowed; all of them at once.
    """
    raw = read_yaml(file)
    problems, found = [], {}
    for name, value in raw.items():
        if name not in KEYS:
            problems.append(Problem(name, "an unknown key", f"allowed: {', '.join(KEYS)}"))
        elif (got := KEYS[name].read(value)) is None:
            key = KEYS[name]
            problems.append(
                Problem(name, printable(repr(value)[:60]), f"allowed: {key.allowed}, such as {key.example}")
            )
        else:
            found[name] = got
    if problems:
        raise ConfigError(problems, str(file))
    teeth = found.get("teeth")
    if teeth and teeth.endswith((".yaml", ".yml")):
        teeth = str(file.parent / teeth)
    said = {key.of_facts: found[name] for name, key in KEYS.items() if key.of_facts and name in found}
    return RigFile(said, teeth, found.get("speed"), found.get("torque_nm"))


def write_rig_file(file: Path, source: Source, given: Mapping[str, str] | None = None) -> None:
    """Write a rig file with the channels of a recording and what is given by its keys; all else stands in comments.

    Raises
    ------
    UsageError
        If the recording cannot be read at all, or the file cannot be written.
    """
    path, row = source
    taken = take(path, RecordingFacts(row=row), say=False)
    try:
        columns = channel_columns(taken)
    except UsageError:
        columns = {}
    lines = ["# How recordings of this machine are read. Take the # from what their files do not say themselves."]
    lines += [
        f"# {printable(line)}" for line in (f"{path.name}: {taken.layout_sentence()}", *taken.table().split("\n"))
    ]
    shown = ", ".join(f"{json.dumps(name)}: {json.dumps(column)}" for name, column in columns.items())
    for name, key in KEYS.items():
        if name == "channels":
            lines.append(f"channels: {{{shown}}}    # {key.comment}; take away those that are no vibration")
        elif text := (given or {}).get(name):
            if text.endswith((".yaml", ".yml")):  # a rig file names its neighbours
                text = Path(os.path.relpath(text, file.parent)).as_posix()
            lines.append(f"{name}: {text if _plain(text) else json.dumps(text)}    # {key.comment}")
        else:
            lines.append(f"# {name}: {key.example}    # {key.comment}")
    write_file(file, "\n".join([*lines, ""]).encode())
