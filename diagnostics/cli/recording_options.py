"""Options that several commands share: how a recorded file is read."""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.recordings.taken import RecordingFacts
    from siggen.columns.drivetrain import GearTrain

ROWS = re.compile(r"\d+(,\d+)*")
RPM = ("rpm", "1/min", "min-1", "u/min")
SPEED = re.compile(r"(\d+(?:\.\d*)?|\.\d+) *(hz|rpm|1/min|min-1|u/min)?", re.IGNORECASE)
KNOWN_WITHIN = 0.03
"""Relative: slip of a loaded motor, or a nameplate's rounding."""

Rate = Annotated[float | None, typer.Option("--fs", help="Sampling rate [Hz]. Not needed where the file states it.")]
ChannelColumns = Annotated[
    list[str] | None,
    typer.Option(
        "--channel",
        metavar="NAME=COLUMN",
        help="A channel and its column of the file. May be given several times. Default: columns by their names.",
    ),
]
Teeth = Annotated[str | None, typer.Option("--teeth", metavar="Z1,Z2", help="Teeth of pinion and gear.")]


@dataclass(frozen=True, slots=True)
class GearOptions:
    """Which gears a machine has."""

    teeth: Annotated[
        str | None,
        typer.Option(
            "--teeth",
            metavar="Z1,Z2 | YAML",
            help="Teeth of pinion and gear, or the configuration with all gears: a `machine` or a planetary set too.",
        ),
    ] = None

    @property
    def given(self) -> bool:
        """Whether the user named gears at all."""
        return self.teeth is not None

    def train(self, where: str) -> GearTrain:
        """Return the drivetrain of the machine.

        Raises
        ------
        UsageError
            If no gears were given; `where` begins the message.
        """
        from diagnostics.recordings.configured_train import configured_train
        from diagnostics.records.gear_train import pair_train

        if self.teeth is None:
            raise UsageError(
                f"{where}: received nothing; give the teeth of pinion and gear, such as --teeth 25,56, or the "
                "configuration with those of all meshes, --teeth gearbox.yaml"
            )
        if self.teeth.endswith((".yaml", ".yml")):
            return configured_train(Path(self.teeth))
        return pair_train(two_gears(self.teeth))


@dataclass(frozen=True, slots=True)
class RecordingOptions:
    """How recordings are read."""

    fs: Rate = None
    speed: Annotated[
        str | None,
        typer.Option(
            "--speed",
            metavar="LOW,HIGH | SPEED",
            help="Without a tacho: range of the first shaft's speed [Hz], or its speed where it is known to 3 %, in Hz "
            "or as 1780rpm. Its angle is searched in the mesh lines.",
        ),
    ] = None
    channel: ChannelColumns = None
    unit: Annotated[
        str | None,
        typer.Option(
            "--unit",
            help="Unit of channels of which the file states none, such as m/s2, g, mg, mV or V. `baseline` and `check` "
            "need none: levels are then relative.",
        ),
    ] = None
    sensitivity: Annotated[
        float | None,
        typer.Option("--sensitivity", help="Sensitivity of the accelerometer in mV/g. Needed for mV and V."),
    ] = None
    full_scale: Annotated[
        float | None, typer.Option("--full-scale", help="Full scale of an integer WAV file, in its unit.")
    ] = None
    tacho: Annotated[
        str | None,
        typer.Option(
            "--tacho",
            metavar="COLUMN",
            help="Column that tells the angle: waveform or pulse times of a tacho, an angle, counts of an encoder. "
            "Default: without --speed the one that is called so.",
        ),
    ] = None
    tacho_pulses: Annotated[
        int | None, typer.Option("--tacho-pulses", min=1, help="Pulses or counts of it per turn of the first shaft.")
    ] = None
    tacho_level: Annotated[
        float | None,
        typer.Option("--tacho-level", help="Level that the tacho's waveform crosses upwards. Default: its middle."),
    ] = None
    resample: Annotated[
        float | None,
        typer.Option(
            "--resample", metavar="RATE", help="Lay samples at uneven times on this rate [Hz]; 0.4 of it is used."
        ),
    ] = None

    def columns(self) -> dict[str, str]:
        """Return the column of every channel that was named."""
        return dict(named_column(said) for said in self.channel or ())

    def facts(self, columns: dict[str, str] | None = None) -> RecordingFacts:
        """Return how the files are read, with other columns than those that were named where such are given."""
        from diagnostics.recordings.taken import RecordingFacts

        voltage = self.unit, self.sensitivity, self.full_scale
        named = self.columns() if columns is None else columns
        return RecordingFacts(
            self.fs,
            named,
            *voltage,
            self.tacho,
            self.tacho_pulses,
            tacho_level=self.tacho_level,
            resample_hz=self.resample,
            tacho_by_name=not self.speed,
        )

    def speed_range_hz(self) -> tuple[float, float] | None:
        """Return where the speed of the first shaft is searched.

        Raises
        ------
        UsageError
            If it is no range, or no speed.
        """
        if not self.speed:
            return None
        if "," not in self.speed:
            return known_speed_range_hz(self.speed)
        low, high = two_numbers(self.speed, "--speed", "14,26")
        if not 0.0 < low < high < inf:
            raise UsageError(f"--speed: received {low:g} to {high:g} Hz; allowed is 0 < low < high")
        return low, high


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


def file_rows(said: str) -> list[tuple[Path, int | None]]:
    """Return file and row of every recording that FILE or FILE:ROW,ROW names; a file of that very name goes first."""
    file, colon, rows = said.rpartition(":")
    if not colon or Path(said).exists() or not ROWS.fullmatch(rows):
        return [(Path(said), None)]
    return [(Path(file), int(row)) for row in rows.split(",")]


def two_numbers(said: str, option: str, example: str) -> tuple[float, float]:
    """Return two numbers with a comma between.

    Raises
    ------
    UsageError
        If they are not; names the option and an example.
    """
    try:
        first, second = (float(part) for part in said.split(","))
    except ValueError as error:
        raise UsageError(f"{option}: received {said!r}; allowed are two numbers with a comma: {example}") from error
    return first, second


def two_gears(said: str) -> tuple[int, int]:
    """Return teeth of pinion and gear.

    Raises
    ------
    UsageError
        If they are not two whole numbers from 3 on.
    """
    first, second = two_numbers(said, "--teeth", "18,47")
    if min(first, second) < 3 or first % 1 or second % 1:
        raise UsageError(f"--teeth: received {said}; allowed are two whole numbers from 3 on")
    return int(first), int(second)


def named_column(said: str) -> tuple[str, str]:
    """Return channel and column of NAME=COLUMN.

    Raises
    ------
    UsageError
        If it has another form.
    """
    name, equals, column = said.partition("=")
    if not equals or not name or not column:
        raise UsageError(f"--channel: received {said!r}; allowed is NAME=COLUMN, e.g. bearing_vertical=ch1")
    return name, column
