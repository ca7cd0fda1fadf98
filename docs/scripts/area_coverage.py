"""How often limits hold the truth: `python docs/scripts/area_coverage.py [TRIALS]`.

First table: lower limit of an AUC below the true one, wanted 0.975. Every gearbox gives a healthy and a damaged record
with normal scores; a part of the noise is shared by both, with the same sign or the opposite one. Second table: both
limits about the share of records that are named right, wanted 0.95. Four records a gearbox; gearboxes are alike, or
their chances differ (beta-binomial, correlation within a gearbox 0.3).
"""

from __future__ import annotations

import sys

import numpy as np
from scipy.stats import norm

from diagnostics.audit.held_out import wins
from diagnostics.statistics.evaluation import Interval, bootstrap_weights, interval
from diagnostics.statistics.scores import area_interval

CASES = ((8, 0.9), (8, 0.99), (24, 0.9), (24, 0.97), (24, 0.99))
SHARED, RESAMPLES = (-0.5, 0.0, 0.6), 200
SHARE_CASES, ALIKE, RECORDS = ((5, 0.65), (5, 0.9), (24, 0.65), (24, 0.9)), (0.0, 0.3), 4


def resampled(gearboxes: int, area: float, shared: float, seed: int) -> np.ndarray:
    """Return an AUC, then those of resampled gearboxes."""
    rng = np.random.default_rng(seed)
    own = np.sqrt(abs(shared)) * rng.standard_normal(gearboxes)
    healthy, damaged = np.sqrt(1.0 - abs(shared)) * rng.standard_normal((2, gearboxes))
    damaged = damaged + norm.ppf(area) * np.sqrt(2.0) + np.sign(shared) * own
    specimen, positive = np.tile(np.arange(gearboxes), 2), np.arange(2 * gearboxes) >= gearboxes
    won, every = wins(np.r_[healthy + own, damaged], positive, specimen, bootstrap_weights(specimen, seed, RESAMPLES))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.where(every > 0.0, won / every, np.nan))


def both(gearboxes: int, share: float, alike: float, seed: int) -> tuple[Interval, Interval]:
    """Return the limits of a share from resampled gearboxes alone, and as they are now."""
    rng, specimen = np.random.default_rng(seed), np.repeat(np.arange(gearboxes), RECORDS)
    spread = 1.0 / alike - 1.0 if alike else np.inf
    mine = rng.beta(share * spread, (1.0 - share) * spread, gearboxes) if alike else np.full(gearboxes, share)
    right = (rng.random(specimen.size) < mine[specimen]).astype(np.float64)
    weights = bootstrap_weights(specimen, seed, RESAMPLES)
    samples = weights @ right / weights.sum(axis=1)
    return interval(samples, gearboxes), area_interval(samples, gearboxes)


def main(trials: int) -> None:
    """Print one row per case of both tables."""
    print("| gearboxes, true AUC | shared | bootstrap alone | now |\n|---|---|---|---|")
    for gearboxes, area in CASES:
        for shared in SHARED:
            every = [resampled(gearboxes, area, shared, seed) for seed in range(trials)]
            shares = [
                np.mean([law(found, gearboxes).low <= area for found in every]) for law in (interval, area_interval)
            ]
            print(f"| {gearboxes}, {area} | {shared} | {shares[0]:.2f} | {shares[1]:.2f} |", flush=True)

    print("\n| gearboxes, true share | alike within one | bootstrap alone | now |\n|---|---|---|---|")
    for gearboxes, share in SHARE_CASES:
        for alike in ALIKE:
            held = [
                [limits.low <= share <= limits.high for limits in both(gearboxes, share, alike, seed)]
                for seed in range(trials)
            ]
            shares = np.mean(held, axis=0)
            print(f"| {gearboxes}, {share} | {alike} | {shares[0]:.2f} | {shares[1]:.2f} |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 600)
