"""Clock: which damage time an age of a gearbox is, under blocks of load that repeat, and the other way round."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from siggen.arrays import FloatArray


@dataclass(frozen=True)
class Clock:
    """Miner's sum over ages.

    Parameters
    ----------
    speed_hz : float
        Of the pinion.
    torque_ratio : float
        Torque over that of the law.
    exponent : float
        To which it counts.
    scale : float
        By which all times of the law are longer.
    history : sequence of (hours, torque)
        Blocks that repeat, with their torque over that of `torque_ratio`; none: 1 all the time.
    """

    speed_hz: float
    torque_ratio: float
    exponent: float
    scale: float
    history: Sequence[tuple[float, float]] = ()
    _ages_h: FloatArray = field(init=False, repr=False, compare=False)
    _times: FloatArray = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Sum up one round of the history."""
        blocks = np.array(self.history or ((1.0, 1.0),))
        turns = 3600.0 * self.speed_hz * blocks[:, 0]
        passed = turns * (self.torque_ratio * blocks[:, 1]) ** self.exponent / self.scale
        object.__setattr__(self, "_ages_h", np.concatenate([[0.0], np.cumsum(blocks[:, 0])]))
        object.__setattr__(self, "_times", np.concatenate([[0.0], np.cumsum(passed)]))

    def time(self, age_h: float) -> float:
        """Return the damage time [turns] at an age [h]."""
        rounds, rest = divmod(age_h, float(self._ages_h[-1]))
        return float(rounds * self._times[-1] + np.interp(rest, self._ages_h, self._times))

    def age_h(self, time: float) -> float:
        """Return the first age [h] at which a damage time [turns] is reached."""
        rounds, rest = divmod(time, float(self._times[-1]))
        block = int(np.clip(np.searchsorted(self._times, rest, side="left") - 1, 0, len(self._times) - 2))
        share = (rest - self._times[block]) / max(self._times[block + 1] - self._times[block], 1e-300)
        inside = self._ages_h[block] + share * (self._ages_h[block + 1] - self._ages_h[block])
        return float(rounds * self._ages_h[-1] + inside)

    def turns(self, age_h: float) -> float:
        """Return the turns of the pinion at an age [h]."""
        return 3600.0 * self.speed_hz * age_h
