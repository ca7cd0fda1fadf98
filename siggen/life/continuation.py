"""Continuation: the loop in which the pits of a gearbox come and grow until it fails, compiled.

Steps are those of `siggen.life.growth`: the nodes of its grid, and first what is left to the next one.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import entry, njit

MOST_PITS = 256
"""That a gearbox may get until it fails; those after them are left out."""


@entry(cache=True, error_model="numpy")
def failing_times(
    runs: int,
    rng: np.random.Generator,
    time: float,
    pits: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
    owners: IntArray,
    teeth: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
    law: tuple[float, float, float, float, float, float],
    grid: tuple[float, float, int],
) -> FloatArray:
    """Return when a gearbox fails in so many continuations (runs,) [turns]; inf without an end within the grid.

    Parameters
    ----------
    runs, rng, time
        How many, what chance draws from, and the damage time from which they go on [turns].
    pits : four (n,)
        Logarithms of shares, mean rates [1/turn], wander, logarithms of the shares at which they leave no land.
    owners : (n,)
        Their teeth.
    teeth : (teeth,) three times, then (teeth, k)
        Mean numbers of pits at damage time 1, summed up over the teeth; turns of the gear per turn of the pinion;
        logarithms of the median first share; logarithms of shares at which pits leave no land, each as likely.
    law : six numbers
        Slope, deviations of the logarithms of first share, rate and wander, logarithms of the median rate [1/turn] and
        of the share of a tooth at which it ends.
    grid : three numbers
        Step [turns], share of the wander that it leaves, most steps.
    """
    ends = np.full(runs, np.inf)
    slope, first_sd, rate_sd, wander_sd, log_rate, log_limit = law
    hazards, turns, log_first, log_lands = teeth
    step, keeps, most = grid
    fresh, total, known = wander_sd * np.sqrt(1.0 - keeps**2), hazards[-1], owners.size
    begun, log_share, rate = np.empty(MOST_PITS), np.empty(MOST_PITS), np.empty(MOST_PITS)
    wander, log_land, owner = np.empty(MOST_PITS), np.empty(MOST_PITS), np.empty(MOST_PITS, np.int64)
    gone = np.empty(MOST_PITS)
    for run in range(runs):
        for i in range(known):
            begun[i], owner[i] = -np.inf, owners[i]
            log_share[i], rate[i], wander[i], log_land[i] = pits[0][i], pits[1][i], pits[2][i], pits[3][i]
        count = known
        mean = time**slope + rng.standard_exponential() / total
        now = time if known else mean ** (1.0 / slope)
        for _ in range(most):
            later = step * (np.floor(now / step) + 1.0)
            while mean <= later**slope and count < MOST_PITS:
                tooth = np.searchsorted(hazards, rng.random() * total, side="right")
                begun[count], owner[count] = mean ** (1.0 / slope), tooth
                log_share[count] = log_first[tooth] + first_sd * rng.standard_normal()
                rate[count] = turns[tooth] * np.exp(log_rate + rate_sd * rng.standard_normal())
                wander[count] = wander_sd * rng.standard_normal()
                log_land[count] = log_lands[tooth, rng.integers(0, log_lands.shape[1])]
                mean += rng.standard_exponential() / total
                count += 1
            before = _beyond(count, log_share, owner, log_land, log_limit, gone)
            for i in range(count):
                lived = min(later - begun[i], later - now)
                growth = rate[i] * np.exp(wander[i] - 0.5 * wander_sd**2) * max(1.0 - gone[i] ** 2, 0.0)
                log_share[i] += growth * lived
                wander[i] = keeps * wander[i] + fresh * rng.standard_normal()
            after = _beyond(count, log_share, owner, log_land, log_limit, gone)
            if after >= 0.0:
                part = 0.0 if before >= 0.0 else -before / (after - before)
                ends[run] = now + part * (later - now)
                break
            now = later
    return ends


@njit(cache=True, error_model="numpy")
def _beyond(
    count: int, log_share: FloatArray, owner: IntArray, log_land: FloatArray, log_limit: float, gone: FloatArray
) -> float:
    """Return by how much the logarithm of the worst share is beyond that of an end; fill in what is gone of teeth."""
    worst = -np.inf
    for i in range(count):
        gone[i] = 0.0
        for j in range(count):
            if owner[j] == owner[i]:
                gone[i] += np.exp(log_share[j])
        worst = max(worst, np.log(gone[i]) - log_limit, log_share[i] - log_land[i])
    return worst
