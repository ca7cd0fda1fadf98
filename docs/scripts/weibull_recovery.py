"""Weibull slope and scale of first pits, refitted from what a fleet publishes: docs/understand/run_to_failure.md.

`python docs/scripts/weibull_recovery.py [FLEETS]`; 200 by default. Each fleet has 200 gearboxes with the defaults of
`life.damage`, those beyond the 60 % quantile suspended there. They are fitted twice: by the time of the first pit, and
by what inspections every 6 h see of it. The fits are written here from the likelihood of censored Weibull times alone;
intervals are those of the normal law of the logarithms. `life/units` of some gearboxes is held against the times.
"""

from __future__ import annotations

import sys
from math import exp, log

import numpy as np
from scipy.optimize import brentq, minimize

import siggen
from siggen.life.initiation import begun
from siggen.life.pitting import Pitting
from siggen.planning.gearbox import gearbox_life
from siggen.record.life_rows import life_rows
from siggen.seeding import Stage, named_generator

UNITS, OBSERVED, PUBLISHED, EVERY_H, SEED = 200, 0.6, 10, 6.0, 1
STEP = 1e-3
"""Of the logarithms, by which the information is differentiated."""


def fitted(times: np.ndarray, failed: np.ndarray) -> tuple[float, float, float, float]:
    """Return slope and scale by maximum likelihood, and the deviations of their logarithms."""
    logs, r = np.log(times), int(failed.sum())

    def score(slope: float) -> float:
        weights = np.exp(slope * (logs - logs.max()))
        return float(1.0 / slope + logs[failed].mean() - (weights * logs).sum() / weights.sum())

    slope = float(brentq(score, 0.1, 50.0))
    scale = float((np.sum(times**slope) / r) ** (1.0 / slope))
    z = slope * (logs - log(scale))
    # information in (log scale, 1/slope), as for the smallest-extreme-value law of the logarithms
    w = np.exp(z)
    information = np.array([[w.sum(), (w * z).sum()], [(w * z).sum(), r + (w * z * z).sum()]]) * slope**2
    covariance = np.linalg.inv(information)
    return slope, scale, float(np.sqrt(covariance[1, 1])) * slope, float(np.sqrt(covariance[0, 0]))


def fitted_by_inspections(times: np.ndarray, failed: np.ndarray, every: float) -> tuple[float, float, float, float]:
    """Return the same where a first pit is known to lie between two inspections only."""
    before = np.floor(times[failed] / every) * every
    edges, counts = np.unique(before, return_counts=True)
    survivors, end = int((~failed).sum()), float(times[~failed][0])

    def loss(logs: np.ndarray) -> float:
        def survival(time: np.ndarray) -> np.ndarray:
            return np.exp(-((time / scale) ** slope))

        slope, scale = exp(logs[0]), exp(logs[1])
        inside = np.maximum(survival(edges) - survival(np.minimum(edges + every, end)), 1e-300)
        return float(-(counts * np.log(inside)).sum() + survivors * (end / scale) ** slope)

    best = minimize(loss, np.log([2.0, end]), method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 1e-10}).x
    information = np.empty((2, 2))
    for i, one in enumerate(STEP * np.eye(2)):
        for j, two in enumerate(STEP * np.eye(2)):
            corners = loss(best + one + two) - loss(best + one - two) - loss(best - one + two) + loss(best - one - two)
            information[i, j] = corners / (4.0 * STEP**2)
    slope_sd, scale_sd = np.sqrt(np.diag(np.linalg.inv(information)))
    return exp(best[0]), exp(best[1]), float(slope_sd), float(scale_sd)


def said(name: str, found: list[tuple[float, float, float, float]], law: Pitting) -> None:
    """Print in how many fleets the 95 % intervals of slope and scale hold the truth."""
    slope, scale, slope_sd, scale_sd = np.array(found).T
    for what, ratio, sd in (("slope", slope / law.slope, slope_sd), ("scale", scale / law.unit_rev, scale_sd)):
        held = np.abs(np.log(ratio)) < 1.96 * sd
        print(f"{name}, {what}: interval holds truth in {held.mean():.1%} of {held.size} fleets; sd {ratio.std():.1%}")


def main(fleets: int) -> None:
    """Fit the fleets and print what the intervals hold."""
    law, config = Pitting(), siggen.load_config("fleet", overrides=[f"seed={SEED}", f"specimens={PUBLISHED}"])
    life = gearbox_life(config, 0)
    flanks = life.course.wearing.flanks

    def first_pit(key: int) -> float:
        def named(name: str) -> np.random.Generator:
            return named_generator(SEED, Stage.LIFE, key, name=name)

        return begun(flanks, flanks, law.unit_rev, law.slope, named)[0].time

    published = [life_rows(config, key)["units"][0] for key in range(PUBLISHED)]
    told = np.array([[row["first_pit_rev"], row["scale"]] for row in published], dtype=float)
    off = np.abs(told[:, 0] / told[:, 1] / [first_pit(key) for key in range(PUBLISHED)] - 1.0)
    print(f"life/units tells these times within {off.max():.1g}")
    end = law.unit_rev * (-log(1.0 - OBSERVED)) ** (1.0 / law.slope)
    every = life.clock.time(EVERY_H)
    exact, seen = [], []
    for fleet in range(fleets):
        first = np.array([first_pit(fleet * UNITS + unit) for unit in range(UNITS)])
        times, failed = np.minimum(first, end), first <= end
        exact.append(fitted(times, failed))
        seen.append(fitted_by_inspections(times, failed, every))
    said("first pit", exact, law)
    said(f"seen every {EVERY_H:g} h", seen, law)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
