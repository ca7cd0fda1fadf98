"""Excitation: what acts on a structure besides the constant torque, as inputs along constant vectors (derived)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.drive.drive import Rotation, Turning


class Source(Protocol):
    """One cause of inputs."""

    @property
    def vectors(self) -> FloatArray:
        """Generalised forces (m, n) per unit of the source's inputs."""

    def inputs(self, turning: Turning) -> FloatArray:
        """Return the inputs (k, m) at k times."""


@dataclass(frozen=True, slots=True)
class Excitation:
    """Sources that act together; their inputs stand side by side in this order."""

    sources: tuple[Source, ...]

    @property
    def vectors(self) -> FloatArray:
        """Generalised forces (m, n) per unit of the inputs, as motions take them."""
        return np.concatenate([source.vectors for source in self.sources])

    def inputs(self, time_s: FloatArray, drive: Rotation) -> FloatArray:
        """Return the inputs (k, m) at the times (k,) [s]."""
        turning = drive.turning(time_s)
        return np.ascontiguousarray(np.concatenate([source.inputs(turning) for source in self.sources], axis=1))


@dataclass(frozen=True, slots=True)
class SpeedDeviation:
    """Ω/Ω_0 - 1, which pushes nothing, but by which tooth pairs slide faster or slower."""

    coordinates: Sequence[str]
    nominal_rad_s: float

    @property
    def vectors(self) -> FloatArray:
        """Zeros (1, n)."""
        return np.zeros((1, len(self.coordinates)))

    def inputs(self, turning: Turning) -> FloatArray:
        """Return the deviation (k, 1)."""
        return (turning.speed_rad_s / self.nominal_rad_s - 1.0)[:, None]
