"""Excitation: what acts on a structure besides the constant torque, as inputs along constant vectors (derived)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.drive.drive import Rotation, Turning


class InputSource(Protocol):
    """One cause of inputs; to be derived from."""

    @property
    def vectors(self) -> FloatArray:
        """Generalised forces (m, n) per unit of the source's inputs."""

    def inputs(self, turning: Turning) -> FloatArray:
        """Return the inputs (k, m) at k times."""

    @property
    def sharp_turn_rad(self) -> float:
        """Turn of the pinion over which inputs show all that they change within few steps of integration; 0: nothing.

        No coarser grid can stand for such inputs.
        """
        return 0.0

    @property
    def seat_forces(self) -> Mapping[str, FloatArray]:
        """Place/axis -> force (m,) on a seat per unit of the inputs, beside what its spring and damper bear."""
        return {}


@dataclass(frozen=True, slots=True)
class Excitation:
    """Sources that act together; their inputs stand side by side in this order."""

    sources: tuple[InputSource, ...]

    @property
    def sharp_turn_rad(self) -> float:
        """The largest of all sources."""
        return max(source.sharp_turn_rad for source in self.sources)

    @property
    def vectors(self) -> FloatArray:
        """Generalised forces (m, n) per unit of the inputs, as motions take them."""
        return np.concatenate([source.vectors for source in self.sources])

    def inputs(self, time_s: FloatArray, drive: Rotation) -> FloatArray:
        """Return the inputs (k, m) at the times (k,) [s]."""
        turning = drive.turning(time_s)
        return np.ascontiguousarray(np.concatenate([source.inputs(turning) for source in self.sources], axis=1))

    def seat_force_rows(self, places: Sequence[str]) -> FloatArray:
        """Return the forces (places, m) on seats per unit of the inputs, beside what springs and dampers bear."""
        parts = [_rows(source, places) for source in self.sources]
        return np.concatenate(parts, axis=1)


@dataclass(frozen=True, slots=True)
class SpeedDeviation(InputSource):
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


def _rows(source: InputSource, places: Sequence[str]) -> FloatArray:
    none, found = np.zeros(source.vectors.shape[0]), source.seat_forces
    return np.array([found.get(place, none) for place in places]).reshape(len(places), none.size)
