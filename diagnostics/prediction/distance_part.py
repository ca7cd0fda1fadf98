"""How far records lie from a straight line in log speed: robust Mahalanobis distance on a few log features.

Speed moves all features and is known, so a straight line in log speed is taken off first. Spreads are medians, no
feature counts as more than six of them (a line near a node falls without limit in logarithms), and the covariance is
shrunk (Ledoit & Wolf 2004). Source: standard literature.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

SMALLEST_SPREAD = 0.02
"""Two per cent: differences below the tolerance of a sensor's sensitivity make no machine foreign."""

SMALLEST_SPEED_RANGE = 0.05
"""Range of log speed below which no line is fitted."""

CLIPPED_AT = 6.0
ARRAYS = ("centre", "slope", "spread", "precision")


@dataclass(frozen=True, slots=True)
class DistancePart:
    """Where training records lie in some of their features.

    Attributes
    ----------
    features : tuple of str
        Columns it takes.
    centre, slope : (k,) float64
        Log features at a pinion speed of 1 Hz on the fitted line, and their slope over log speed.
    spread : (k,) float64
        Median absolute deviation from the line, times 1.4826.
    precision : (k, k) float64
        Inverse covariance of the standardised log features.
    scale : float
        What the distance is divided by: a bound that nine of ten records of new gearboxes keep.
    """

    features: tuple[str, ...]
    centre: np.ndarray
    slope: np.ndarray
    spread: np.ndarray
    precision: np.ndarray
    scale: float = 1.0

    def standardised(self, logs: np.ndarray, speed_hz: np.ndarray) -> np.ndarray:
        """Return how far log features (n, k) lie off the line at speeds (n,) [Hz], in spreads; 0 where undefined."""
        line = self.centre + np.log(speed_hz)[:, None] * self.slope
        return np.asarray(np.nan_to_num((logs - line) / self.spread))

    def distance(self, logs: np.ndarray, speed_hz: np.ndarray) -> np.ndarray:
        """Return the distance of records, (n,), in `scale`; undefined features count as typical.

        Parameters
        ----------
        logs : (n, k) float64
            Log features in the order of `features`.
        speed_hz : (n,) float64
            Mean speed of the pinion.
        """
        standard = np.clip(self.standardised(logs, speed_hz), -CLIPPED_AT, CLIPPED_AT)
        square = np.einsum("ij,jk,ik->i", standard, self.precision, standard) / logs.shape[1]
        return np.asarray(np.sqrt(square) / self.scale)


def fit_part(logs: np.ndarray, speed_hz: np.ndarray, features: tuple[str, ...]) -> DistancePart:
    """Return the distance to records (n, k) at speeds (n,)."""
    from sklearn.covariance import LedoitWolf

    lines = np.array([_line(np.log(speed_hz), column) for column in logs.T])
    off = logs - lines[:, 0] - np.log(speed_hz)[:, None] * lines[:, 1]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # a feature that is undefined throughout has no median
        spread = np.nan_to_num(1.4826 * np.nanmedian(np.abs(off), axis=0))
    spread = np.maximum(spread, SMALLEST_SPREAD)
    clipped = np.clip(np.nan_to_num(off / spread), -CLIPPED_AT, CLIPPED_AT)
    covariance = LedoitWolf(assume_centered=True).fit(clipped).covariance_
    return DistancePart(features, lines[:, 0], lines[:, 1], spread, np.linalg.inv(covariance))


def _line(log_speed: np.ndarray, column: np.ndarray) -> tuple[float, float]:
    """Return intercept and slope of the least-squares line through the defined values; level where speeds are alike."""
    defined = np.isfinite(column)
    if not defined.any():
        return 0.0, 0.0
    x, y = log_speed[defined], column[defined]
    if np.ptp(x) < SMALLEST_SPEED_RANGE:
        return float(np.median(y)), 0.0
    slope = float(np.cov(x, y, bias=True)[0, 1] / np.var(x))
    return float(y.mean() - slope * x.mean()), slope


def part_facts(found: DistancePart) -> dict[str, Any]:
    """Return the distance as JSON can hold it."""
    arrays = {name: getattr(found, name).tolist() for name in ARRAYS}
    return {"features": list(found.features), **arrays, "scale": found.scale}


def part_from_facts(facts: dict[str, Any]) -> DistancePart:
    """Return what `part_facts` wrote.

    Raises
    ------
    ValueError, KeyError
        If shapes do not fit or something is missing.
    """
    features, size = tuple(facts["features"]), len(facts["features"])
    arrays = {name: np.asarray(facts[name], dtype=np.float64) for name in ARRAYS}
    for name, array in arrays.items():
        if array.shape != ((size, size) if name == "precision" else (size,)):
            raise ValueError(f"distance: {size} features, but {name} has shape {array.shape}")
    return DistancePart(features, **arrays, scale=float(facts["scale"]))
