"""How far a record lies from the training records: robust Mahalanobis distance on log features, with a threshold.

Few features, since the distance is estimated from few gearboxes: level, shape, mesh lines (what the transfer path
makes of them), how much is synchronous, and sidebands; not those that damage moves most (FM4 and its like), which would
make the states clusters. Speed moves all of them and is known, so a straight line in log speed is taken off first.
Spreads are medians, no feature counts as more than six of them (a line near a node falls without limit in logarithms),
and the covariance is shrunk (Ledoit & Wolf 2004).

The threshold comes from held-out gearboxes alone: the validation specimens, and every training specimen left out of the
fit in turn. Source: standard literature; the rule for the threshold is that of conformal prediction (Vovk 2005), with
half of the allowed false alarms, since records of one gearbox are alike and the quantile scatters accordingly.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnostics.splits import SpecimenSplit

DEFINITIONS = (
    *("rms", "kurtosis", "crest_factor", "average_rms_pinion", "energy_ratio_pinion"),
    *(f"mesh_amplitude_h{h}" for h in range(1, 6)),
    *(f"sideband_ratio_pinion_h{h}_k3" for h in range(1, 4)),
)
SHARE_INSIDE = 0.975
"""Share of held-out records that count as like training: half of the 5 % of false alarms that are allowed."""

SMALLEST_SPREAD = 0.02
"""Two per cent: differences below the tolerance of a sensor's sensitivity make no machine foreign."""

SMALLEST_SPEED_RANGE = 0.05
"""Range of log speed below which no line is fitted."""

CLIPPED_AT = 6.0


@dataclass(frozen=True, slots=True)
class TrainingDistance:
    """Where training records lie.

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
    threshold : float
        Largest distance that counts as like training; NaN before it is chosen.
    held_out_specimens : int
        How many gearboxes the threshold was chosen on.
    """

    features: tuple[str, ...]
    centre: np.ndarray
    slope: np.ndarray
    spread: np.ndarray
    precision: np.ndarray
    threshold: float = np.nan
    held_out_specimens: int = 0

    def standardised(self, logs: np.ndarray, speed_hz: np.ndarray) -> np.ndarray:
        """Return how far log features (n, k) lie off the line at speeds (n,) [Hz], in spreads; 0 where undefined."""
        line = self.centre + np.log(speed_hz)[:, None] * self.slope
        return np.asarray(np.nan_to_num((logs - line) / self.spread))

    def distance(self, logs: np.ndarray, speed_hz: np.ndarray) -> np.ndarray:
        """Return the distance of records, (n,), one for a typical training record; undefined features count as typical.

        Parameters
        ----------
        logs : (n, k) float64
            Log features in the order of `features`.
        speed_hz : (n,) float64
            Mean speed of the pinion.
        """
        standard = np.clip(self.standardised(logs, speed_hz), -CLIPPED_AT, CLIPPED_AT)
        return np.asarray(np.sqrt(np.einsum("ij,jk,ik->i", standard, self.precision, standard) / logs.shape[1]))

    def strangest(self, logs: np.ndarray, speed_hz: float, count: int = 3) -> list[tuple[str, float]]:
        """Return the features of one record (k,) farthest off the line, in spreads."""
        off = self.standardised(logs[None, :], np.array([speed_hz]))[0]
        return [(self.features[k], float(off[k])) for k in np.argsort(-np.abs(off))[:count]]


def distance_features(names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the columns that the distance takes, of all channels."""
    return tuple(name for name in names if name.split("__")[0] in DEFINITIONS)


def fit_distance(logs: np.ndarray, speed_hz: np.ndarray, features: tuple[str, ...]) -> TrainingDistance:
    """Return the distance to records (n, k) at speeds (n,), without a threshold."""
    from sklearn.covariance import LedoitWolf

    lines = np.array([_line(np.log(speed_hz), column) for column in logs.T])
    off = logs - lines[:, 0] - np.log(speed_hz)[:, None] * lines[:, 1]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # a feature that is undefined throughout has no median
        spread = np.nan_to_num(1.4826 * np.nanmedian(np.abs(off), axis=0))
    spread = np.maximum(spread, SMALLEST_SPREAD)
    clipped = np.clip(np.nan_to_num(off / spread), -CLIPPED_AT, CLIPPED_AT)
    covariance = LedoitWolf(assume_centered=True).fit(clipped).covariance_
    return TrainingDistance(features, lines[:, 0], lines[:, 1], spread, np.linalg.inv(covariance))


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


def calibrated_distance(
    logs: np.ndarray, speed_hz: np.ndarray, features: tuple[str, ...], split: SpecimenSplit, specimen: np.ndarray
) -> TrainingDistance:
    """Return the distance to the training specimens with the threshold of the held-out ones; test is not touched.

    Parameters
    ----------
    logs : (records, k) float64
        Log features of all records.
    speed_hz : (records,) float64
        Their mean pinion speed.
    features : tuple of str
        Their names.
    split : SpecimenSplit
        Whose specimens are which.
    specimen : (records,) int
        Specimen of every record.
    """
    found = fit_distance(logs[split.train], speed_hz[split.train], features)
    held_out = found.distance(logs, speed_hz)  # of the validation specimens so far
    trained = np.unique(specimen[split.train])
    for number in trained if trained.size > 2 else ():
        own = split.train & (specimen == number)
        others = split.train & ~own
        left = fit_distance(logs[others], speed_hz[others], features)
        held_out[own] = left.distance(logs[own], speed_hz[own])
    used = split.train | split.validation
    ordered = np.sort(held_out[used])
    rank = min(int(np.ceil(SHARE_INSIDE * (ordered.size + 1))), ordered.size)
    return replace(found, threshold=float(ordered[rank - 1]), held_out_specimens=int(np.unique(specimen[used]).size))


def distance_facts(found: TrainingDistance) -> dict[str, Any]:
    """Return the distance as JSON can hold it."""
    return {
        "features": list(found.features),
        "centre": found.centre.tolist(),
        "slope": found.slope.tolist(),
        "spread": found.spread.tolist(),
        "precision": found.precision.tolist(),
        "threshold": found.threshold,
        "held_out_specimens": found.held_out_specimens,
    }


def distance_from_facts(facts: dict[str, Any]) -> TrainingDistance:
    """Return what `distance_facts` wrote.

    Raises
    ------
    ValueError, KeyError
        If shapes do not fit or something is missing.
    """
    features, size = tuple(facts["features"]), len(facts["features"])
    arrays = {name: np.asarray(facts[name], dtype=np.float64) for name in ("centre", "slope", "spread", "precision")}
    for name, array in arrays.items():
        if array.shape != ((size, size) if name == "precision" else (size,)):
            raise ValueError(f"distance: {size} features, but {name} has shape {array.shape}")
    return TrainingDistance(
        features,
        **arrays,
        threshold=float(facts["threshold"]),
        held_out_specimens=int(facts["held_out_specimens"]),
    )
