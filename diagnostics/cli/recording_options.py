"""Options that several commands share: how a recorded file is read."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.recordings.rig_file import RigFile
    from diagnostics.recordings.taken import RecordingFacts, Source
    from siggen.columns.drivetrain import GearTrain

ROWS = re.compile(r"\d+(,\d+)*")
RPM = ("rpm", "1/min", "min-1", "u/min")
SPEED = re.compile(r"(\d+(?:\.\d*)?|\.\d+) *(hz|rpm|1/min|min-1|u/min)?", re.IGNORECASE)
KNOWN_WITHIN = 0.03
"""Relative: slip of a loaded motor, or a nameplate's rounding."""

Rig = Annotated[
    Path | None,
    typer.Option(
        "--rig",
        metavar="YAML",
        help="How recordings are read: channels, unit, tacho, teeth and all else that files do not say. A "
        "file that is not there is written, with the columns of the first recording.",
        show_default=False,
    ),
]


@dataclass(frozen=True, slots=True)
class RecordingOptions:
    """How recordings are read."""

    rig: Rig = None
    fs: Annotated[
        float | None, typer.Option("--fs", help="Sampling rate [Hz]. Not needed where the file states it.")
    ] = None
    speed: Annotated[
        str | None,
        typer.Option(
            "--speed",
            metavar="LOW,HIGH | SPEED",
            help="Without a tacho: range of the first shaft's speed [Hz]; or its speed, known to 3 %, also as "
            "1780rpm. Its angle is searched in the mesh lines.",
        ),
    ] = None

    def read(self, first: Source, teeth: str | None = None) -> SaidReading:
        """Return how recordings are read, by these options and the rig file, whose words options replace.

        `teeth` were given by an option: a rig file that is written holds them.

        Raises
        ------
        UsageError
            If there was no such rig file; it is written then, with the columns of the first recording.
        """
        fs = None if self.fs is None else f"{self.fs:g}"
        given = {"teeth": teeth, "fs_hz": fs, "speed": self.speed}
        return SaidReading(said_by(self.rig, first, given), self.fs, self.speed)


@dataclass(frozen=True, slots=True)
class SaidReading:
    """How recordings are read: a rig file, and the options beside it."""

    file: RigFile
    fs_hz: float | None
    speed: str | None

    def facts(self, columns: dict[str, str] | None = None) -> RecordingFacts:
        """Return how the files are read, with other columns than those that were named where such are given."""
        from diagnostics.recordings.taken import RecordingFacts

        facts = self.file.over(RecordingFacts(tacho_by_name=not (self.speed or self.file.speed)))
        fs_hz = facts.fs_hz if self.fs_hz is None else self.fs_hz
        return replace(facts, fs_hz=fs_hz, columns=facts.columns if columns is None else columns)

    def speed_range_hz(self) -> tuple[float, float] | None:
        """Return where the speed of the first shaft is searched.

        Raises
        ------
        UsageError
            If it is no range, or no speed.
        """
        said = self.speed or self.file.speed
        if not said:
            return None
        if "," not in said:
            return known_speed_range_hz(said)
        low, high = two_numbers(said, "--speed", "two numbers with a comma: 14,26")
        if not 0.0 < low < high < inf:
            raise UsageError(f"--speed: received {low:g} to {high:g} Hz; allowed is 0 < low < high")
        return low, high


@dataclass(frozen=True, slots=True)
class GearOptions:
    """Which gears a machine has."""

    teeth: Annotated[
        str | None,
        typer.Option(
            "--teeth",
            metavar="Z1,Z2 | YAML",
            help="Teeth of pinion and gear, or a configuration with all gears.",
        ),
    ] = None

    def said(self, read: SaidReading) -> str | None:
        """Return the teeth as they were said, by the option or the rig file."""
        return self.teeth or read.file.teeth

    def train(self, read: SaidReading, where: str) -> GearTrain:
        """Return the drivetrain of the machine.

        Raises
        ------
        UsageError
            If no gears were given; `where` begins the message.
        """
        from diagnostics.recordings.configured_train import configured_train
        from diagnostics.records.gear_train import pair_train

        said = self.said(read)
        if said is None:
            raise UsageError(
                f"{where}: received nothing; give the teeth of pinion and gear, such as --teeth 25,56, or the "
                "configuration with those of all meshes, --teeth gearbox.yaml"
            )
        if said.endswith((".yaml", ".yml")):
            return configured_train(Path(said))
        return pair_train(two_gears(said))


def said_by(rig: Path | None, first: Source, given: Mapping[str, str | None] | None = None) -> RigFile:
    """Return what a rig file says; nothing without one. `given`: what a file that is written holds, by its keys.

    Raises
    ------
    UsageError
        If it is not there; it is written then, with the columns of the first recording.
    """
    from diagnostics.recordings.rig_file import RigFile, read_rig_file, write_rig_file

    if rig is None:
        return RigFile()
    if rig.exists():
        return read_rig_file(rig)
    write_rig_file(rig, first, {name: text for name, text in (given or {}).items() if text})
    raise UsageError(f"--rig {rig}: was not there; written with the columns of {first[0]}. Fill it in, and run again")


def known_speed_range_hz(said: str) -> tuple[float, float]:
    """Return the range of a known speed: 3 % about it, as nameplates and slip leave it.

    Raises
    ------
    UsageError
        If it is no positive number, of Hz or with `rpm` behind.
    """
    match = SPEED.fullmatch(said.strip())
    hz = float(match[1]) / (60.0 if (match[2] or "").lower() in RPM else 1.0) if match else 0.0
    if not 0.0 < hz < inf:
        raise UsageError(f"--speed: received {said!r}; allowed is a speed in Hz or rpm, such as 29.7 or 1780rpm")
    return (1.0 - KNOWN_WITHIN) * hz, (1.0 + KNOWN_WITHIN) * hz


def recordings_of(said: Sequence[str]) -> list[Source]:
    """Return file and row of every recording that is named.

    Raises
    ------
    UsageError
        If none of them is a file: what is missing else, such as teeth, is asked for in vain then.
    """
    sources = [source for name in said for source in file_rows(name)]
    if not any(path.is_file() for path, _ in sources):
        first = sources[0][0]
        raise UsageError(
            f"{first}: {'is a folder; give the file of one recording' if first.is_dir() else 'no such file'}"
        )
    return sources


def is_recording(said: str) -> bool:
    """Return whether a target is a recording, and no folder of a set.

    Raises
    ------
    UsageError
        If it is nothing that is there.
    """
    path = file_rows(said)[0][0]
    if not path.exists() and "://" not in said:
        raise UsageError(f"{path}: no such file or folder; allowed: recordings, or the folder of a finished set")
    return path.is_file()


def file_rows(said: str) -> list[Source]:
    """Return file and row of every recording that FILE or FILE:ROW,ROW names; a file of that very name goes first."""
    file, colon, rows = said.rpartition(":")
    if not colon or Path(said).exists() or not ROWS.fullmatch(rows):
        return [(Path(said), None)]
    return [(Path(file), int(row)) for row in rows.split(",")]


def two_numbers(said: str, option: str, allowed: str) -> tuple[float, float]:
    """Return two numbers with a comma between.

    Raises
    ------
    UsageError
        If they are not; names the option and what is allowed.
    """
    try:
        first, second = (float(part) for part in said.split(","))
    except ValueError as error:
        raise UsageError(f"{option}: received {said!r}; allowed are {allowed}") from error
    return first, second


def two_gears(said: str) -> tuple[int, int]:
    """Return teeth of pinion and gear.

    Raises
    ------
    UsageError
        If they are not two whole numbers from 3 on.
    """
    allowed = "two whole numbers from 3 on, such as 18,47, or the YAML file of a configuration"
    first, second = two_numbers(",".join(re.split("[,/]", said)), "--teeth", allowed)
    if min(first, second) < 3 or first % 1 or second % 1:
        raise UsageError(f"--teeth: received {said}; allowed are {allowed}")
    return int(first), int(second)
