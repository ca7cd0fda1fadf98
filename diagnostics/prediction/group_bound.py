"""Upper bound for a value of a new group, from values in a few groups: Student's, with as many degrees as groups allow.

Records of one gearbox are alike, so n gearboxes with m records each are no n m draws. Values are taken as mean plus
group effect plus scatter within a group; the bound is mean + t sqrt(between + within + variance of the mean) with t of
n - 1 degrees of freedom: for few groups it is wide, since little is known of how groups differ. Source: standard
literature (one-way random-effects model; the degrees of freedom are those of the group effect, on the safe side).
"""

from __future__ import annotations

import numpy as np


def group_bound(values: np.ndarray, group: np.ndarray, share: float) -> float:
    """Return what a share of the values of new groups lies below.

    Parameters
    ----------
    values : (n,) float64
        Roughly normal.
    group : (n,) int
        Group of each; at least one.
    share : float
        Between 0.5 and 1.
    """
    from scipy.stats import t

    members = [values[group == number] for number in np.unique(group)]
    means = np.array([found.mean() for found in members])
    freedom = sum(found.size - 1 for found in members)
    within = sum(float(np.sum((found - found.mean()) ** 2)) for found in members) / max(freedom, 1)
    of_means = float(means.var(ddof=1)) if means.size > 1 else within
    records = np.mean([1.0 / found.size for found in members])  # what scatter within adds to a mean's variance
    between = max(of_means - within * float(records), 0.0)
    quantile = float(t.ppf(share, max(means.size - 1, 1)))
    return float(means.mean()) + quantile * float(np.sqrt(between + within + of_means / means.size))
