"""Modes: what carries bearings and sensors as natural modes of modal mass 1, wherever they come from.

    A_oi = Σ_r φ_r(o) φ_r(i) (-ω²)/(ω_r² - ω² + 2 i ζ_r ω_r ω) - ω² R_oi

(reference: standard literature, modal analysis). All information is in the shapes; R stands for the modes above the
last one. Forces and motions share their numbers, so reciprocity is exact.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import Protocol

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.dynamics.housing.modal_sum import modal_sum
from siggen.dynamics.housing.motion import WallMotion
from siggen.dynamics.housing.ordered_sums import squares

ALL = slice(None)
VIBRATING_HZ = 1e6
"""What lies above in a table is a residual vector: it only gives way."""


class NaturalModes(Protocol):
    """Natural modes in ascending order; `frequency_hz` (m,). To be derived from."""

    frequency_hz: FloatArray

    @property
    def vibrating(self) -> int:
        """How many of them may move with the gears."""

    def shapes(self, motions: Sequence[WallMotion]) -> FloatArray:
        """Return the shapes (motions, m) [kg^-1/2] of all modes, as displacements; slopes per metre."""

    def flexibility_beyond(self, modes: int, outputs: Sequence[WallMotion], inputs: Sequence[WallMotion]) -> FloatArray:
        """Return what all modes above the first so many give way, (outputs, inputs) [m/N]."""

    def residual_flexibility(self, outputs: Sequence[WallMotion], inputs: Sequence[WallMotion]) -> FloatArray:
        """Return what all modes above the last one give way, (outputs, inputs) [m/N]."""
        return self.flexibility_beyond(self.frequency_hz.size, outputs, inputs)

    def accelerance(
        self,
        outputs: Sequence[WallMotion],
        inputs: Sequence[WallMotion],
        frequency_hz: FloatArray,
        damping_ratio: FloatArray,
        which: slice = ALL,
    ) -> ComplexArray:
        """Return accelerances (outputs, inputs, k) [m/s² per N] at frequencies (k,) with damping ratios (m,).

        Of all modes, or of some; where these go up to the last one, with what stands for those above.
        """
        at_outputs, at_inputs = self.shapes(outputs)[:, which], self.shapes(inputs)[:, which]
        residues = (at_outputs[:, None, :] * at_inputs[None, :, :]).reshape(
            len(outputs) * len(inputs), -1 if at_outputs.size else 0
        )
        residual = np.zeros(len(residues))
        if which.stop is None:
            residual = self.residual_flexibility(outputs, inputs).reshape(-1)
        total = modal_sum(
            np.ascontiguousarray(residues),
            2.0 * pi * self.frequency_hz[which],
            damping_ratio[which],
            residual,
            2.0 * pi * frequency_hz,
        )
        return np.asarray(total.reshape(len(outputs), len(inputs), frequency_hz.size))


@dataclass(frozen=True, slots=True)
class TableModes(NaturalModes):
    """Modes from a table: the shapes at a place are its motion, all of them in the first half; nothing lies above."""

    frequency_hz: FloatArray

    @property
    def vibrating(self) -> int:
        """How many of them may move with the gears: residual vectors do not."""
        return int((self.frequency_hz < VIBRATING_HZ).sum())

    def shapes(self, motions: Sequence[WallMotion]) -> FloatArray:
        """Return the shapes (motions, m) [kg^-1/2]."""
        return np.array([motion.even for motion in motions]).reshape(len(motions), -1)

    def flexibility_beyond(self, modes: int, outputs: Sequence[WallMotion], inputs: Sequence[WallMotion]) -> FloatArray:
        """Return what the modes above the first so many give way, (outputs, inputs) [m/N]."""
        left, right = (np.ascontiguousarray(self.shapes(side).T[modes:]) for side in (outputs, inputs))
        omega = 2.0 * pi * self.frequency_hz[modes:, None]
        return squares(left / (omega * omega), right)


def table_motion(shape: FloatArray) -> WallMotion:
    """Return the motion of a place by its shapes (m,)."""
    return WallMotion(shape, np.empty(0))
