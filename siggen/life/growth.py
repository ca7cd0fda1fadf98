"""How areas of pits grow: in proportion to themselves, with a rate that scatters from pit to pit and wanders.

    da/dn = C exp(X - s²/2) a (1 - A)(1 + A)

with n the turns of the pit's own gear, X an Ornstein-Uhlenbeck process, A the share of the tooth that is gone. Less and
less land is left to take, and its edges carry more: both factors are assumed to weigh alike. A rate is never negative,
so no area shrinks. The logarithm is integrated on a grid of damage time that all gearboxes share. Without wander, and
while A is small, a step is exact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray, IntArray

WANDER = 5e5
"""Turns within which the wander forgets, at scale 1; assumed."""
STEP = WANDER / 10.0
"""Turns between nodes of the grid, at scale 1."""
KEEPS = float(np.exp(-STEP / WANDER))
"""Share of the wander that a step leaves."""


@dataclass(frozen=True, slots=True)
class Seeds:
    """Pits as they begin, (n,) each; `owner` numbers their teeth, `rate` is per turn of the pinion.

    `wander` has a row of standard normals for each pit, one for every step from the one in which it begins.
    """

    time: FloatArray
    share: FloatArray
    rate: FloatArray
    owner: IntArray
    wander: FloatArray


@dataclass(frozen=True, slots=True)
class Grown:
    """Logarithms of the shares of pits over the nodes of the grid (n, k), from the node numbered `first` on.

    They are -inf before a pit begins. `rates` (n, k - 1) are those of the steps, on land that is whole.
    """

    seeds: Seeds
    first: int
    log_share: FloatArray
    rates: FloatArray

    @property
    def last(self) -> float:
        """The last node [turns]."""
        return float(STEP * (self.first + self.log_share.shape[1] - 1))

    def shares(self, time: float) -> FloatArray:
        """Return the shares of the pits at a damage time up to the last node (n,); linear in ln a between nodes."""
        place = min(time, self.last) / STEP - self.first
        if place < 0.0:
            return np.zeros(len(self.seeds.time))
        node = min(int(place), self.log_share.shape[1] - 2)
        start = STEP * (self.first + node)
        later, before = self.log_share[:, node + 1], self.log_share[:, node]
        young = np.isneginf(before)
        begun, origin = np.where(young, self.seeds.time, start), np.where(young, np.log(self.seeds.share), before)
        past = (time - begun) / np.maximum(start + STEP - begun, 1e-300)
        with np.errstate(invalid="ignore"):
            found = np.exp(origin + np.minimum(past, 1.0) * (later - origin))
        return np.where(self.seeds.time <= time, found, 0.0)

    def wander(self, time: float, wander_sd: float) -> FloatArray:
        """Return the wander X of the pits at a damage time (n,)."""
        step = min(max(int(time / STEP) - self.first, 0), self.rates.shape[1] - 1)
        return np.asarray(np.log(self.rates[:, step] / self.seeds.rate) + 0.5 * wander_sd**2)


def grown(seeds: Seeds, wander_sd: float, steps: int, teeth: int) -> Grown:
    """Return how pits grow over so many steps from the one in which the first begins."""
    first = int(seeds.time.min() // STEP)
    rates = seeds.rate[:, np.newaxis] * _wandering(seeds, wander_sd, first, steps)
    log_share = np.full((len(seeds.time), steps + 1), -np.inf)
    for step in range(steps):
        start = STEP * (first + step)
        alive = seeds.time < start + STEP
        old = np.where(np.isneginf(log_share[:, step]), np.log(seeds.share), log_share[:, step])
        gone = np.bincount(seeds.owner[alive], np.exp(old[alive]), teeth)[seeds.owner]
        lived = start + STEP - np.maximum(seeds.time, start)
        faster = rates[:, step] * np.maximum(1.0 - gone * gone, 0.0)
        log_share[alive, step + 1] = (old + faster * lived)[alive]
    return Grown(seeds, first, log_share, rates)


def _wandering(seeds: Seeds, wander_sd: float, first: int, steps: int) -> FloatArray:
    """Return exp(X - s²/2) of every pit over the steps (n, steps); X is stationary from the start."""
    from scipy.signal import lfilter

    own = np.concatenate([seeds.wander[:, :1], np.sqrt(1.0 - KEEPS**2) * seeds.wander[:, 1:]], axis=1)
    walks = wander_sd * lfilter([1.0], [1.0, -KEEPS], own, axis=1)
    factors = np.exp(walks - 0.5 * wander_sd**2)
    begins = np.maximum((seeds.time // STEP).astype(int) - first, 0)
    number = np.clip(np.arange(steps)[np.newaxis, :] - begins[:, np.newaxis], 0, factors.shape[1] - 1)
    return np.asarray(np.take_along_axis(factors, number, axis=1))
