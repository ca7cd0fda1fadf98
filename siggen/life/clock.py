"""Clock: which damage time an age of a gearbox is, under blocks of load that repeat, and the other way round."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray


class LoadBlock(NamedTuple):
    """So many hours of one load: speed of the pinion, and torque over that of the law."""

    hours: float
    speed_hz: float
    torque_ratio: float


@dataclass(frozen=True)
class Clock:
    """Miner's sum over ages.

    Parameters
    ----------
    blocks : sequence of Block
        They repeat.
    exponent : float
        To which torque counts.
    scale : float
        By which all times of the law are longer.
    """

    blocks: Sequence[LoadBlock]
    exponent: float
    scale: float
    _ages_h: FloatArray = field(init=False, repr=False, compare=False)
    _times: FloatArray = field(init=False, repr=False, compare=False)
    _turns: FloatArray = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Sum up one round of the blocks."""
        hours, speeds_hz, ratios = np.array(self.blocks).T
        turns = 3600.0 * speeds_hz * hours
        passed = turns * ratios**self.exponent / self.scale
        for name, steps in (("_ages_h", hours), ("_times", passed), ("_turns", turns)):
            object.__setattr__(self, name, np.concatenate([[0.0], np.cumsum(steps)]))

    @property
    def round_h(self) -> float:
        """Hours after which the blocks begin again."""
        return float(self._ages_h[-1])

    def time(self, age_h: float) -> float:
        """Return the damage time [turns] at an age [h]."""
        return self._at(age_h, self._times)

    def turns(self, age_h: float) -> float:
        """Return the turns of the pinion at an age [h]."""
        return self._at(age_h, self._turns)

    def age_h(self, time: float) -> float:
        """Return the first age [h] at which a damage time [turns] is reached."""
        rounds, rest = divmod(time, float(self._times[-1]))
        block = int(np.clip(np.searchsorted(self._times, rest, side="left") - 1, 0, len(self._times) - 2))
        share = (rest - self._times[block]) / max(self._times[block + 1] - self._times[block], 1e-300)
        inside = self._ages_h[block] + share * (self._ages_h[block + 1] - self._ages_h[block])
        return float(rounds * self._ages_h[-1] + inside)

    def _at(self, age_h: float, sums: FloatArray) -> float:
        rounds, rest = divmod(age_h, self.round_h)
        return float(rounds * sums[-1] + np.interp(rest, self._ages_h, sums))
