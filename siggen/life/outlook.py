"""Outlook: when a gearbox fails if chance goes on from its true state many times over.

Pits go on with their own rates from their present wander; others begin by the Poisson process of the whole gearbox, and
grow with rates of their own. A pit counts as through the face by itself: where it would join others to leave no land,
the end comes earlier than here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.life.growth import KEEPS, STEP
from siggen.life.outline import PitShape, area_m2

MOST_STEPS = 10_000


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
    hazard : (teeth,)
        Mean number of pits of a tooth at damage time 1.
    turns : (teeth,)
        Of the tooth's gear per turn of the pinion.
    first_share : (teeth,)
        Median share with which a pit of the tooth begins.
    any_through : (teeth, k)
        Shares at which pits leave no land, of which each new one of the tooth has one.
    """

    time: float
    share: FloatArray
    rate: FloatArray
    wander: FloatArray
    owner: IntArray
    through: FloatArray
    hazard: FloatArray
    turns: FloatArray
    first_share: FloatArray
    any_through: FloatArray


@dataclass(frozen=True, slots=True)
class Chances:
    """How pits come and grow: slope, scatter of the logarithms of first share and rate, mean rate, wander, and ends."""

    slope: float
    first_sd: float
    rate: float
    rate_sd: float
    wander_sd: float
    functional_share: float


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
    from siggen.life import continuation

    return continuation.failing_times(
        runs,
        rng,
        now.time,
        (np.log(now.share), now.rate, now.wander, np.log(now.through)),
        now.owner,
        (np.cumsum(now.hazard), now.turns, np.log(now.first_share), np.log(now.any_through)),
        (
            chances.slope, chances.first_sd, chances.rate_sd, chances.wander_sd, float(np.log(chances.rate)),
            float(np.log(chances.functional_share)),
        ),
        (STEP, KEEPS, MOST_STEPS),
    )  # fmt: skip
