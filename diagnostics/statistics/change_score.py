"""ChangeScore: how far a recording stands from healthy ones of the same machine, and how rare that is.

Every recording of a bag (the references and the new one) is judged against all others of the bag in the same way, so
healthy recordings are exchangeable and the rank of the new one's score has a known distribution whatever the
features are: conformal prediction (Vovk et al. 2005). Among n references no smaller rate of false alarms than
1/(n + 1) can be had by ranks alone. Below that the logarithm of the score is compared with those of the references,
as if these were normally distributed (Student's t): a second condition, which can only take alarms away.

Where loads or speeds differ, a recording is compared with what the others say of its own. Between two recordings the
logarithm of an indicator differs by noise and by what the conditions do. The latter is a Gaussian process over each
condition: a slope, and bends whose correlation ends within a length (universal kriging; Cressie, Statistics for Spatial
Data, 1993, chapter 3). How strongly an indicator follows the conditions and how much it scatters are not known: both
are averaged over a grid, weighted by the restricted likelihood and a prior. The prior of the noise is fitted to all
indicators (empirical Bayes), since three recordings cannot tell it for one alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np

from siggen.errors import UsageError, counted

STRENGTHS = 2.0 ** np.arange(-2, 4)
"""Factors on slope and bends."""
STRENGTH_SPREAD = 1.5
"""Standard deviation of the logarithm of that factor between indicators."""
NOISES = np.geomspace(1e-3, 1.0, 9) ** 2
"""Variances of a repeat: from what no recording repeats to, to a factor of e."""
LEAST_NOISE_SPREAD = 0.5
"""Of the logarithm of the noise between indicators."""
ROUNDS = 8
"""Of fitting the prior of the noise; it moves by less than 1 % then."""


@dataclass(frozen=True, slots=True)
class Condition:
    """One condition of all recordings of a bag.

    Attributes
    ----------
    values : (n,) float64
        On a scale where the slope is alike over the whole range, such as a logarithm.
    slope, bend : float
        Standard deviations of the slope of a logarithm and of the departure from it, at strength 1.
    length : float
        Distance over which departures forget each other.
    """

    values: np.ndarray
    slope: float
    bend: float
    length: float

    def covariance(self) -> np.ndarray:
        """Return the covariance (n, n) of an indicator's logarithm between recordings; noise left out."""
        away = np.abs(self.values[:, None] - self.values)
        centred = self.values - self.values.mean()
        return np.asarray(self.slope**2 * np.outer(centred, centred) + self.bend**2 * np.exp(-away / self.length))


def deviation_among_conditions(bag: np.ndarray, i: int, covariance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return what all other rows of a bag say of row i, (features,), and how far it stands from that, in spreads.

    Parameters
    ----------
    bag : (n, features) float64
    i : int
    covariance : (n, n) float64
        Sum over the conditions.
    """
    kept = np.delete(np.arange(len(bag)), i)
    among, across = covariance[np.ix_(kept, kept)], covariance[i, kept]
    contrasts = _contrasts(len(kept))
    modes, turned = np.linalg.eigh(contrasts.T @ among @ contrasts)
    basis = contrasts @ turned
    own = float(covariance[i, i] - 2.0 * across.mean() + among.mean())
    process = _Process(np.maximum(modes, 0.0), basis.T @ (across - among.mean(axis=1)), own)
    offset, variance = process.told(basis.T @ bag[kept])
    mean = bag[kept].mean(axis=0) + offset
    return mean, np.asarray((bag[i] - mean) / np.sqrt(variance))


@dataclass(frozen=True, slots=True)
class _Process:
    """Eigenvalues (k,) of the conditions over differences of the others, their covariance (k,) with row i, and its."""

    modes: np.ndarray
    across: np.ndarray
    own: float

    def told(self, parts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return mean and variance (features,) of row i about the mean of the others, from their parts (k, features).

        Arrays are (strengths, noises, k, features), then summed over k.
        """
        strength, noise = STRENGTHS[:, None, None, None] ** 2, NOISES[:, None, None]
        total = strength * self.modes[:, None] + noise
        likelihood = -0.5 * (np.log(total) + parts**2 / total).sum(axis=2)
        prior = -0.5 * (np.log(STRENGTHS) / STRENGTH_SPREAD) ** 2
        weights = _weights(likelihood + prior[:, None, None])
        across = strength * self.across[:, None]
        mean = (across * parts / total).sum(axis=2)
        count = len(self.modes) + 1.0
        left = strength[..., 0] * self.own - (across**2 / total).sum(axis=2)
        variance = NOISES[:, None] * (1.0 + 1.0 / count) + np.maximum(left, 0.0)
        middle = (weights * mean).sum(axis=(0, 1))
        return middle, np.asarray((weights * (variance + (mean - middle) ** 2)).sum(axis=(0, 1)))


def _contrasts(count: int) -> np.ndarray:
    """Return an orthonormal basis (count, count - 1) of all differences between rows."""
    return np.asarray(np.linalg.qr(np.column_stack([np.ones(count), np.eye(count)[:, 1:]]))[0][:, 1:])


def _weights(logs: np.ndarray) -> np.ndarray:
    """Return the weight of every strength and noise (strengths, noises, features); the noise's prior is fitted."""
    sizes, prior = 0.5 * np.log(NOISES), np.zeros(NOISES.size)
    for _ in range(ROUNDS):
        weights = logs + prior[:, None]
        weights = np.exp(weights - weights.max(axis=(0, 1)))
        weights /= weights.sum(axis=(0, 1))
        share = weights.sum(axis=0).mean(axis=1)
        middle = float(share @ sizes)
        spread = max(float(np.sqrt(share @ (sizes - middle) ** 2)), LEAST_NOISE_SPREAD)
        prior = -0.5 * ((sizes - middle) / spread) ** 2
    return np.asarray(weights)


FEWEST = 4
"""References below which nothing is said: of three that span loads most broken teeth are missed."""
PRIOR_RECORDINGS = 3.0
"""Weight, in recordings, of the median spread over all features in the spread of each."""
SHARE = 0.1
"""Share of the features, those farthest off, that make the score."""
PRIOR_SCORES, PRIOR_SCORE_SPREAD = 4.0, 0.4
"""Weight and spread of what is known of log scores where conditions differ: three of them do not tell their spread."""
LEAST_SPREAD = 1e-3
"""Of a logarithm: what no recording repeats to."""


@dataclass(frozen=True, slots=True)
class ChangeScore:
    """What one recording gave.

    Attributes
    ----------
    score : float
        Root mean square of the largest tenth of the deviations, in spreads.
    limit : float
        Score from which it is called a change.
    references : (n,) float64
        Scores of the references, each against the others and the new one.
    deviation : (features,) float64
        Of the new recording from what the references say of it, in spreads; NaN where undefined.
    mean : (features,) float64
        What they say: logarithms; NaN where undefined.
    changed : bool
    """

    score: float
    limit: float
    references: np.ndarray
    deviation: np.ndarray
    mean: np.ndarray
    changed: bool


def attainable_rate(references: int, wanted: float) -> float:
    """Return the rate of false alarms that ranks among so many references can promise: `wanted`, or 1/(n + 1)."""
    return max(wanted, 1.0 / (references + 1.0))


def change_score(
    healthy: np.ndarray, new: np.ndarray, false_alarms: float = 0.05, conditions: Sequence[Condition] = ()
) -> ChangeScore:
    """Return how far a recording stands from healthy ones.

    Parameters
    ----------
    healthy : (n, features) float64
        Logarithms of the features of the references, NaN where undefined.
    new : (features,) float64
    false_alarms : float
        Wanted rate of false alarms.

    Raises
    ------
    UsageError
        If there are fewer than four references, or no feature is defined in all recordings.
    """
    if len(healthy) < FEWEST:
        raise UsageError(
            f"{counted(len(healthy), 'healthy recording')} at this speed and load; {FEWEST} are needed, 19 for a rate "
            "of false alarms of 5 %"
        )
    bag = np.vstack([healthy, new])
    known = np.isfinite(bag).all(axis=0)
    if not known.any():
        raise UsageError(
            "no indicator is defined in all recordings; use longer recordings with two whole turns or more"
        )
    told = [_deviation(bag[:, known], i, conditions) for i in range(len(bag))]
    scores = np.array([_score(deviation) for _, deviation in told])
    references, score = scores[:-1], float(scores[-1])
    rank_p = (1.0 + np.count_nonzero(references >= score)) / len(bag)
    normal_p, normal_limit = _normal(
        np.log(references), float(np.log(score)), false_alarms, PRIOR_SCORES if conditions else 0.0
    )
    rate = attainable_rate(len(healthy), false_alarms)
    allowed_above = int(np.floor(rate * len(bag) + 1e-9)) - 1
    rank_limit = float(np.sort(references)[::-1][allowed_above])
    few = rate > false_alarms
    deviation, mean = np.full((2, bag.shape[1]), np.nan)
    mean[known], deviation[known] = told[-1]
    return ChangeScore(
        score,
        max(rank_limit, normal_limit) if few else rank_limit,
        references,
        deviation,
        mean,
        bool(rank_p <= rate and (not few or normal_p <= false_alarms)),
    )


def _deviation(bag: np.ndarray, i: int, conditions: Sequence[Condition]) -> tuple[np.ndarray, np.ndarray]:
    """Return what the others say of row i (features,), and how far it stands from that, in spreads."""
    if conditions:
        return deviation_among_conditions(
            bag, i, sum((one.covariance() for one in conditions[1:]), conditions[0].covariance())
        )
    others = np.delete(bag, i, axis=0)
    variance = others.var(axis=0, ddof=1)
    typical = max(float(np.median(variance)), LEAST_SPREAD**2)
    degrees = len(others) - 1.0
    shrunk = (PRIOR_RECORDINGS * typical + degrees * variance) / (PRIOR_RECORDINGS + degrees)
    mean = others.mean(axis=0)
    return mean, np.asarray((bag[i] - mean) / np.sqrt(shrunk * (1.0 + 1.0 / len(others))))


def _score(deviation: np.ndarray) -> float:
    count = max(1, round(SHARE * deviation.size))
    return float(np.sqrt(np.mean(np.sort(np.abs(deviation))[-count:] ** 2)))


def _normal(references: np.ndarray, new: float, rate: float, prior: float) -> tuple[float, float]:
    """Return the share of log scores above the new one, and the score that `rate` of them exceed."""
    from scipy.special import stdtr, stdtrit

    middle, degrees = float(references.mean()), prior + references.size - 1
    squares = prior * PRIOR_SCORE_SPREAD**2 + float(((references - middle) ** 2).sum())
    spread = max(sqrt(squares / degrees), LEAST_SPREAD) * sqrt(1.0 + 1.0 / references.size)
    limit = np.exp(middle - spread * stdtrit(degrees, rate))
    return float(stdtr(degrees, (middle - new) / spread)), float(limit)
