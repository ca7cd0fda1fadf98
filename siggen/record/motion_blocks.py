"""MotionBlocks: motions, forces and readings of a response as inputs of filters, in parts of any length."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.time.response_stream import ResponsePieces
from siggen.sensing.inputs import FORCE, MOTION, SHAFT, Input


def delivered(response: ResponsePieces) -> tuple[Input, ...]:
    """Return what a response holds, as inputs."""
    kinds = ((MOTION, response.motions), (FORCE, response.places), (SHAFT, response.readings))
    return tuple(Input(kind, name) for kind, names in kinds for name in names)


class MotionBlocks:
    """Values from sample -`back` on, about the mean of the history; 0 before the history.

    `offsets` are the means that were taken off.
    """

    def __init__(self, response: ResponsePieces, back: int) -> None:
        self.inputs = delivered(response)
        self._pieces = response.pieces()
        self._mean = np.zeros((len(self.inputs), 1))
        history = self._read(np.empty((len(self.inputs), 0)), response.before)
        if response.before:
            self._mean = history[:, : response.before].mean(axis=1, keepdims=True)
        self.offsets = dict(zip(self.inputs, self._mean[:, 0], strict=True))
        self._left = np.concatenate(
            [np.zeros((len(self.inputs), back - response.before)), history - self._mean], axis=1
        )

    def take(self, count: int) -> dict[Input, FloatArray]:
        """Return the next values (count,) of every input; 0 behind the end of the response.

        Raises
        ------
        SolverFailure, ValueError
            As the response, where it is stepped as it is taken.
        """
        rows = self._read(self._left, count)
        self._left = rows[:, count:].copy()
        return dict(zip(self.inputs, rows[:, :count], strict=True))

    def _read(self, left: FloatArray, count: int) -> FloatArray:
        """Return what is left and as many pieces behind it as make at least `count` samples."""
        found, have = [left], left.shape[1]
        while have < count:
            piece = next(self._pieces, None)
            if piece is None:
                rows = np.zeros((len(self.inputs), count - have))
            else:
                rows = np.concatenate([p for p in piece if p.shape[0]]) - self._mean
            found.append(rows)
            have += rows.shape[1]
        return np.concatenate(found, axis=1)
