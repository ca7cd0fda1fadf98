"""What the rest of siggen asks a source: the common part of all sections of noise and lines that channels get.

A source is one module here: its section with the answers below. Its physics stands in `sensing`, which knows no
configuration. `kinds.py` names the source; nothing else knows sources. White noise is no source:
`Recorder.convert` adds it.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.keys.section import Section
from siggen.sensing.measurement import Spread


@dataclass(frozen=True, slots=True)
class Draws:
    """Where the numbers of a channel come from.

    Attributes
    ----------
    specimen, shared : name -> uniform of the gearbox, or of the record
    record : name -> generator of this channel and record
    levels : name -> uniform of a level that belongs to the gearbox; None: levels are the record's
    """

    specimen: Callable[[str], float]
    shared: Callable[[str], float]
    record: Callable[[str], np.random.Generator]
    levels: Callable[[str], float] | None = None

    def level(self, name: str, rng: np.random.Generator) -> float:
        """Return the uniform of a level; the generator advances by one either way, so that its noise stays."""
        own = float(rng.random())
        return own if self.levels is None else self.levels(name)


@dataclass(frozen=True, slots=True)
class NoisyChannel:
    """What a source knows of its channel.

    Attributes
    ----------
    gain : of the amplifier
    response : (k,) of mounting, sensor and coupling at frequencies up to half the rate; None without
    coupling_hz : corner of the coupling, None without
    fs_hz, length : of the record; samples that the response stands for
    gear_order : turns of the gear per turn of the pinion
    largest_step_rad : how far the pinion turns in a sample of the record at most; 0 unless a source asks
    """

    gain: float
    response: ComplexArray | None
    coupling_hz: float | None
    fs_hz: float
    length: int
    gear_order: float
    largest_step_rad: float


class NoisePart(Protocol):
    """What a source adds to one channel of one record, block after block."""

    def take(self, first: int, angle_rad: FloatArray) -> FloatArray:
        """Return what is added (k,) from sample `first` on, at angles of the pinion (k,); blocks come in order."""

    @property
    def label(self) -> float:
        """The value of its column, known at the latest when all was taken."""


class MeasuredPart:
    """A part whose label is the standard deviation of all that it added."""

    def __init__(self, added: Callable[[int, FloatArray], FloatArray]) -> None:
        self._added, self._spread = added, Spread()

    def take(self, first: int, angle_rad: FloatArray) -> FloatArray:
        """Return what is added (k,), as of `Part`."""
        added = self._added(first, angle_rad)
        self._spread.take(added)
        return added

    @property
    def label(self) -> float:
        """RMS about the mean."""
        return self._spread.std


class Source(Section):
    """Base of the sections of what channels get beside white noise.

    Frequencies belong to the gearbox and are the same for all its sensors; levels and phases belong to the record.
    Nothing is drawn from the state. Keys that are a size of the signal end with its unit.
    """

    key: ClassVar[str]
    """Its key in the section of a sensor; its column begins with it."""

    about: ClassVar[str]
    """What the page of keys says of it."""

    meaning: ClassVar[str] = "RMS"
    """What its column holds, up to the name of the channel."""

    per: ClassVar[tuple[str, str]] = ("", "")
    """What its column has behind the unit of the channel: as an ending of names, and as a unit."""

    fitted: ClassVar[bool] = False
    """Whether its numbers are as a rule those of recordings."""

    broad: ClassVar[bool] = False
    """Whether it is noise in which small damage can hide."""

    file_columns: ClassVar[tuple[str, ...]] = ()
    """Columns of the CSV file that may stand for its lists (`file: NAME.csv`)."""

    asks_largest_step: ClassVar[bool] = False
    """Whether it must know how far the pinion turns in a sample at most."""

    @abstractmethod
    def part(self, channel: NoisyChannel, draws: Draws) -> NoisePart:
        """Return what it adds to a channel of one record."""

    @property
    def follows_angle(self) -> bool:
        """Whether angles count; else only their number does."""
        return False

    def column(self, channel: str, suffix: str) -> str:
        """Return the name of its column for a channel whose names end with the unit `suffix`."""
        return f"{self.key}_{channel}_{suffix}{self.per[0]}"
