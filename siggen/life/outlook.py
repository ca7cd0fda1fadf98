"""Outlook: when a gearbox fails if chance goes on from its true state many times over.

Pits go on with their own rates from their present wander; others begin by the Poisson process of the whole gearbox, and
grow with rates of their own. A pit counts as through the face by itself: where it would join others to leave no land,
the end comes earlier than here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.life.growth import STEP, WANDER
from siggen.life.outline import PitShape, area_m2

NEW_PITS = 24
"""That a gearbox may still get; most fail with fewer."""
COARSE = 2.0 * STEP
"""Step of the continuation [turns]."""
MOST_STEPS = 5_000


@dataclass(frozen=True, slots=True)
class Now:
    """The pits of a gearbox at a damage time, (n,) each, and what may come.

    Attributes
    ----------
    time : float
        [turns]
    share, rate, wander : (n,)
        Shares of their teeth, mean rates per turn of the pinion, present wander.
    owner : (n,)
        Numbers of their teeth among those of both gears.
    through : (n,)
        Shares at which they leave no land across the face.
    teeth : int
        Of both gears.
    hazard : (teeth,)
        Mean number of pits of a tooth at damage time 1.
    turns : (teeth,)
        Of the tooth's gear per turn of the pinion.
    """

    time: float
    share: FloatArray
    rate: FloatArray
    wander: FloatArray
    owner: IntArray
    through: FloatArray
    teeth: int
    hazard: FloatArray
    turns: FloatArray


@dataclass(frozen=True, slots=True)
class Chances:
    """How pits come and grow: slope, logarithm's means and deviations of first share and rate, wander, and ends.

    `through` (k,) are shares at which pits leave no land, of which each new one has one.
    """

    slope: float
    first_share: float
    first_sd: float
    rate: float
    rate_sd: float
    wander_sd: float
    functional_share: float
    through: FloatArray


def through_share(shape: PitShape, flank_m2: float) -> float:
    """Return the share of a flank at which a pit by itself reaches both ends of the face."""
    from scipy.optimize import brentq

    width = float(shape.stations_m[-1])
    wanted = 2.0 * max(shape.middle_m, width - shape.middle_m)
    if shape.lengths_m(shape.largest_m)[1] < wanted:
        return 1.0
    size = float(brentq(lambda one: shape.lengths_m(one)[1] - wanted, 1e-6, shape.largest_m))
    return area_m2(shape.edges(size)) / flank_m2


def failing_times(now: Now, chances: Chances, runs: int, rng: np.random.Generator) -> FloatArray:
    """Return when a gearbox fails in so many continuations (runs,) [turns]."""
    begun, logs, rates, owners, through = _with_new(now, chances, runs, rng)
    count = now.share.size
    walks = np.concatenate(
        [np.tile(now.wander, (runs, 1)), chances.wander_sd * rng.standard_normal((runs, NEW_PITS))], axis=1
    )
    keeps = float(np.exp(-COARSE / WANDER))
    places = owners + now.teeth * np.arange(runs)[:, np.newaxis]
    ends = np.full(runs, np.inf)
    time = now.time if count else float(begun.min())
    lost = _lost(logs, begun, through, places, time, now.teeth, chances.functional_share)
    for _ in range(MOST_STEPS):
        if np.isfinite(ends).all():
            break
        gone = _of_teeth(logs, begun <= time + COARSE, places, now.teeth)
        lived = np.clip(time + COARSE - begun, 0.0, COARSE)
        land = np.maximum(1.0 - np.take(gone, places) ** 2, 0.0)
        logs = logs + rates * np.exp(walks - 0.5 * chances.wander_sd**2) * land * lived
        after = _lost(logs, begun, through, places, time + COARSE, now.teeth, chances.functional_share)
        share = np.clip((0.0 - lost) / np.maximum(after - lost, 1e-300), 0.0, 1.0)
        ends = np.where(np.isinf(ends) & (after >= 0.0), time + share * COARSE, ends)
        walks = keeps * walks + np.sqrt(1.0 - keeps**2) * chances.wander_sd * rng.standard_normal(walks.shape)
        time, lost = time + COARSE, after
    return ends


def _with_new(
    now: Now, chances: Chances, runs: int, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray, FloatArray, IntArray, FloatArray]:
    """Return begins, logarithms of shares, rates, teeth and shares of no land of old and new pits (runs, n + new)."""
    arrived = np.cumsum(rng.standard_exponential((runs, NEW_PITS)), axis=1) / now.hazard.sum()
    times = (now.time**chances.slope + arrived) ** (1.0 / chances.slope)
    owners = rng.choice(now.teeth, (runs, NEW_PITS), p=now.hazard / now.hazard.sum())
    logs = np.log(chances.first_share) + chances.first_sd * rng.standard_normal((runs, NEW_PITS))
    rates = chances.rate * np.exp(chances.rate_sd * rng.standard_normal((runs, NEW_PITS))) * now.turns[owners]
    through = rng.choice(chances.through, (runs, NEW_PITS))

    def both(old: FloatArray, new: FloatArray) -> FloatArray:
        return np.concatenate([np.tile(old, (runs, 1)), new], axis=1)

    begun = both(np.full(now.share.size, -np.inf), times)
    held = np.concatenate([np.tile(now.owner, (runs, 1)), owners], axis=1)
    return begun, both(np.log(now.share), logs), both(now.rate, rates), held, both(now.through, through)


def _of_teeth(logs: FloatArray, alive: np.ndarray, places: IntArray, teeth: int) -> FloatArray:
    """Return the share of every tooth of every run that is gone (runs * teeth,)."""
    shares = np.where(alive, np.exp(logs), 0.0)
    return np.bincount(places.ravel(), shares.ravel(), teeth * len(logs)).astype(np.float64)


def _lost(
    logs: FloatArray, begun: FloatArray, through: FloatArray, places: IntArray, time: float, teeth: int, limit: float
) -> FloatArray:
    """Return by how much the logarithm of the worst share is beyond that of an end (runs,); below 0 before it."""
    gone = _of_teeth(logs, begun <= time, places, teeth).reshape(len(logs), teeth).max(axis=1)
    alone = np.where(begun <= time, logs - np.log(through), -np.inf).max(axis=1)
    return np.asarray(np.maximum(np.log(np.maximum(gone, 1e-12) / limit), alone))
