"""How often the lower limit of an AUC lies below the true one: `python docs/scripts/area_coverage.py [TRIALS]`.

Every gearbox gives a healthy and a damaged record with normal scores; a part of the noise is shared by both, with the
same sign or the opposite one. Wanted: 0.975.
"""

from __future__ import annotations

import sys

import numpy as np
from scipy.stats import norm

from diagnostics.attacks.held_out import wins
from diagnostics.statistics.area_interval import area_interval
from diagnostics.statistics.evaluation import bootstrap_weights, interval

CASES = ((8, 0.9), (8, 0.99), (24, 0.9), (24, 0.97), (24, 0.99))
SHARED, RESAMPLES = (-0.5, 0.0, 0.6), 200


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


def main(trials: int) -> None:
    """Print one row per case."""
    print("| gearboxes, true AUC | shared | bootstrap alone | now |\n|---|---|---|---|")
    for gearboxes, area in CASES:
        for shared in SHARED:
            every = [resampled(gearboxes, area, shared, seed) for seed in range(trials)]
            shares = [
                np.mean([law(found, gearboxes).low <= area for found in every]) for law in (interval, area_interval)
            ]
            print(f"| {gearboxes}, {area} | {shared} | {shares[0]:.2f} | {shares[1]:.2f} |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 600)
