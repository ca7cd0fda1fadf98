"""Conditions: what indicators are expected to do with load and speed, and how well recordings elsewhere tell it.

Between two recordings the logarithm of an indicator differs by noise and by what the conditions do. The latter is a
Gaussian process over each condition: a slope, and bends whose correlation ends within a length (universal kriging;
Cressie, Statistics for Spatial Data, 1993, chapter 3). How strongly an indicator follows the conditions and how much
it scatters are not known: both are averaged over a grid, weighted by the restricted likelihood and a prior. The prior
of the noise is fitted to all indicators (empirical Bayes), since three recordings cannot tell it for one alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

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
