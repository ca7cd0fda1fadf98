"""Weibull slope and scale of first pits, refitted from what a fleet publishes: docs/understand/run_to_failure.md.

`python docs/scripts/weibull_recovery.py [FLEETS]`; 200 by default. Each fleet has 200 gearboxes with the defaults of
`life.damage`, those beyond the 60 % quantile suspended there. The fit is written here from the likelihood of censored
Weibull times alone; intervals are those of the normal law of the logarithms.
"""

from __future__ import annotations

import sys
from math import log

import numpy as np
from scipy.optimize import brentq

from siggen.life.initiation import begun
from siggen.life.pitting import Pitting
from siggen.planning.gearbox import gearbox_life
from siggen.seeding import Stage, named_generator

UNITS, OBSERVED = 200, 0.6


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


def main(fleets: int) -> None:
    """Print in how many fleets the 95 % intervals hold the truth."""
    import siggen

    law, life = Pitting(), gearbox_life(siggen.load_config("fleet"), 0)
    flanks = life.course.wearing.flanks
    end = law.unit_rev * (-log(1.0 - OBSERVED)) ** (1.0 / law.slope)
    found = []
    for fleet in range(fleets):
        first = np.array([
            begun(flanks, flanks, law.unit_rev, law.slope, lambda name, key=fleet * UNITS + unit: named_generator(
                1, Stage.LIFE, key, name=name))[0].time
            for unit in range(UNITS)
        ])  # fmt: skip
        found.append(fitted(np.minimum(first, end), first <= end))
    slope, scale, slope_sd, scale_sd = np.array(found).T
    held = [np.abs(np.log(slope / law.slope)) < 1.96 * slope_sd, np.abs(np.log(scale / law.unit_rev)) < 1.96 * scale_sd]
    for name, inside, values in (("slope", held[0], slope), ("scale", held[1], scale / law.unit_rev)):
        print(f"{name}: interval holds truth in {inside.mean():.1%} of {fleets} fleets; sd {values.std():.3g}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
