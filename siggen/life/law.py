"""What the rest of siggen asks a law of life: how damage begins and grows on one gearbox, and when that ends it.

A law is one module. It counts in *damage time*: turns of the pinion at the reference torque (Miner's
sum), divided by the scale of the rig. Which age that is follows from the history of load, and is no business of a law.
So truth at an age depends on configuration, gearbox and age alone, never on a schedule. A law of cracks may stand
beside the one of pits.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.fault import Fault
from siggen.life.flank import Flank
from siggen.names import Side

Named = Callable[[str], np.random.Generator]
"""Name of what is drawn -> its generator; other names never shift its stream."""


@dataclass(frozen=True, slots=True)
class Wearing:
    """One gearbox as a law sees it: flanks of pinion and gear, those of the set's nominal pair, and its generators."""

    flanks: tuple[Flank, Flank]
    nominal: tuple[Flank, Flank]
    named: Named


@dataclass(frozen=True, slots=True)
class ToothTruth:
    """One damaged tooth at an instant; `begun` is the damage time of its first damage [turns], `area_m2` a union."""

    gear: Side
    tooth: int
    begun: float
    count: int
    area_m2: float
    share: float


@dataclass(frozen=True, slots=True)
class PartTruth:
    """One pit over its whole life: where and when it began [turns], with which share, and its mean rate [1/turn]."""

    gear: Side
    tooth: int
    number: int
    begun: float
    first_share: float
    rate: float
    face_m: float
    arc_m: float


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture of one flank, as PNG."""

    gear: Side
    tooth: int
    png: bytes


@dataclass(frozen=True, slots=True)
class Ends:
    """Damage times of the three ends [turns], and the tooth that fails."""

    first_pit: float
    rated: float
    functional: float
    gear: Side
    tooth: int


class LifeCourse(Protocol):
    """Damage of one gearbox over its life."""

    @property
    def ends(self) -> Ends: ...  # noqa: D102 - see the class

    @property
    def parts(self) -> Sequence[PartTruth]: ...  # noqa: D102

    def teeth(self, time: float) -> Sequence[ToothTruth]:
        """Return the damaged teeth at a damage time [turns]."""

    def outlook(self, time: float, runs: int) -> FloatArray:
        """Return when it would fail if chance went on from its true state so many times (runs,) [turns]."""

    def removed_m3(self, time: float) -> float:
        """Return the metal that has left all flanks at a damage time [m³]."""

    def pictures(self, time: float) -> Sequence[Picture]:
        """Return pictures of the damaged flanks at a damage time, or of one whole flank of each gear without any."""

    def damage(self, time: float) -> Fault | None:
        """Return the section of damage of a state at a damage time [turns]; None before the first."""
