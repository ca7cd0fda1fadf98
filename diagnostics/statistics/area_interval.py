"""Interval of an AUC or a share from resampled gearboxes that does not shrink to nothing where all are won.

Near 1 the bootstrap is too narrow: where every damaged record lies above every healthy one, so does it in every
resample. So its limits are widened to those of Clopper and Pearson for a proportion among as many independent gearboxes
as the resamples' variance stands for, and not fewer than there are. Source: Clopper and Pearson 1934, with the
effective sample size of Korn and Graubard (Survey Methodology 24, 1998, 193-201); its least value, the gearboxes of the
smaller class, since the variance of an AUC is at most A(1 - A)/min(m, n): Birnbaum and Klose 1957. Where the resamples
scatter less than that, more gearboxes count than there are, since each is compared with all of the other class; so
limits between the ends may be narrower than those of the gearboxes counted. A share of records is treated like an
AUC: 0 and 1 get the exact limits of so many gearboxes. No AUC gets a higher lower limit than 1
itself would, which is 0.025^(1/n). The combination is derived; its coverage is tested.
"""

from __future__ import annotations

import math

import numpy as np

from diagnostics.statistics.evaluation import LEVEL, Interval, interval


def area_interval(samples: np.ndarray, specimens: int) -> Interval:
    """Return an AUC, or a share of records, with its limits; NaN where it is.

    Parameters
    ----------
    samples : (resamples + 1,) float64
        The value itself, then those of resampled gearboxes.
    specimens : int
        Gearboxes of the class that has fewer; of a share, those that have such records.
    """
    found = interval(samples, specimens)
    if not math.isfinite(found.value) or specimens < 2:
        return found
    low, high = clopper_pearson(found.value, effective_size(found.value, samples[1:], specimens))
    highest_low, lowest_high = clopper_pearson(1.0, specimens)[0], clopper_pearson(0.0, specimens)[1]
    low, high = min(low, highest_low), max(high, lowest_high)
    return Interval(found.value, float(np.fmin(low, found.low)), float(np.fmax(high, found.high)))


def effective_size(value: float, resamples: np.ndarray, specimens: int) -> float:
    """Return how many independent gearboxes an AUC of this scatter stands for, at least those that there are."""
    defined = resamples[np.isfinite(resamples)]
    variance = float(np.var(defined)) if defined.size else 0.0
    own = value * (1.0 - value)
    return max(own / variance, float(specimens)) if variance > 0.0 and own > 0.0 else float(specimens)


def clopper_pearson(share: float, size: float) -> tuple[float, float]:
    """Return the exact 95 % limits of a proportion; sizes may be fractions. All of n won: from 0.025^(1/n) to 1."""
    from scipy.stats import beta

    tail, won = (1.0 - LEVEL) / 2.0, share * size
    low = float(beta.ppf(tail, won, size - won + 1.0)) if won > 0.0 else 0.0
    return low, float(beta.ppf(1.0 - tail, won + 1.0, size - won)) if won < size else 1.0
