"""How far a record lies from the training records: robust Mahalanobis distance on log features, with a threshold.

Few features, since the distance is estimated from few gearboxes: level, shape, mesh lines (what the transfer path
makes of them), how much is synchronous, and sidebands. Centre and spread are medians, outliers are clipped before the
covariance is taken, and the covariance is shrunk (Ledoit & Wolf 2004). The threshold comes from held-out gearboxes
alone: the validation specimens, and every training specimen left out of the fit in turn. Source: standard literature;
the threshold's rule is derived.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.splits import SpecimenSplit

DEFINITIONS = (
    *("rms", "kurtosis", "crest_factor", "average_rms_pinion", "energy_ratio_pinion", "fm4_pinion"),
    *(f"mesh_amplitude_h{h}" for h in range(1, 6)),
    *(f"sideband_ratio_pinion_h{h}_k3" for h in range(1, 4)),
)
HELD_OUT_SHARE_INSIDE = 0.975
"""Half of the false alarms that are allowed (5 %): held-out records of one specimen are alike, so the quantile itself
scatters by about as much again."""

SMALLEST_SPREAD = 0.02
"""Two per cent: differences below the tolerance of a sensor's sensitivity make no machine foreign."""

CLIPPED_AT = 3.0


@dataclass(frozen=True, slots=True)
class TrainingDistance:
    """Where training records lie.

    Attributes
    ----------
    features : tuple of str
        Columns it takes.
    centre, spread : (k,) float64
        Median, and median absolute deviation times 1.4826, of the log features.
    precision : (k, k) float64
        Inverse covariance of the standardised log features.
    threshold : float
        Largest distance that counts as like training; NaN before it is chosen.
    held_out_records, held_out_specimens : int
        What the threshold was chosen on.
    """

    features: tuple[str, ...]
    centre: np.ndarray
    spread: np.ndarray
    precision: np.ndarray
    threshold: float = np.nan
    held_out_records: int = 0
    held_out_specimens: int = 0

    def distance(self, logs: np.ndarray) -> np.ndarray:
        """Return the distance of records, (n,), one for a typical training record; undefined features count as typical.

        Parameters
        ----------
        logs : (n, k) float64
            Log features in the order of `features`.
        """
        standard = np.nan_to_num((logs - self.centre) / self.spread)
        return np.asarray(np.sqrt(np.einsum("ij,jk,ik->i", standard, self.precision, standard) / logs.shape[1]))

    def strangest(self, logs: np.ndarray, count: int = 3) -> list[tuple[str, float]]:
        """Return the features of one record (k,) farthest off their centre, in spreads."""
        off = np.nan_to_num((logs - self.centre) / self.spread)
        return [(self.features[k], float(off[k])) for k in np.argsort(-np.abs(off))[:count]]


def distance_features(names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the columns that the distance takes, of all channels."""
    return tuple(name for name in names if name.split("__")[0] in DEFINITIONS)


def fit_distance(logs: np.ndarray, features: tuple[str, ...]) -> TrainingDistance:
    """Return the distance to records (n, k), without a threshold."""
    from sklearn.covariance import LedoitWolf

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # a feature that is undefined throughout stays out: zero below
        centre = np.nan_to_num(np.nanmedian(logs, axis=0))
        spread = np.nan_to_num(1.4826 * np.nanmedian(np.abs(logs - centre), axis=0))
    spread = np.maximum(spread, SMALLEST_SPREAD)
    clipped = np.clip(np.nan_to_num((logs - centre) / spread), -CLIPPED_AT, CLIPPED_AT)
    covariance = LedoitWolf(assume_centered=True).fit(clipped).covariance_
    # a feature that is undefined in all training records has no variance: unit variance leaves it without effect
    covariance[np.diag_indices_from(covariance)] = np.where(np.diag(covariance) > 0.0, np.diag(covariance), 1.0)
    return TrainingDistance(features, centre, spread, np.linalg.inv(covariance))


def calibrated_distance(
    logs: np.ndarray, features: tuple[str, ...], split: SpecimenSplit, specimen: np.ndarray
) -> TrainingDistance:
    """Return the distance to the training specimens with the threshold of the held-out ones; test is not touched.

    Parameters
    ----------
    logs : (records, k) float64
        Log features of all records.
    features : tuple of str
        Their names.
    split : SpecimenSplit
        Whose specimens are which.
    specimen : (records,) int
        Specimen of every record.
    """
    found = fit_distance(logs[split.train], features)
    held_out = [found.distance(logs[split.validation])]
    trained = np.unique(specimen[split.train])
    for number in trained if trained.size > 2 else ():
        own = split.train & (specimen == number)
        held_out.append(fit_distance(logs[split.train & ~own], features).distance(logs[own]))
    distances = np.concatenate(held_out)
    if not distances.size:
        distances = found.distance(logs[split.train])
    threshold = float(np.quantile(distances, HELD_OUT_SHARE_INSIDE, method="higher"))
    specimens = int(np.unique(specimen[split.validation]).size) + (trained.size if trained.size > 2 else 0)
    return TrainingDistance(
        features, found.centre, found.spread, found.precision, threshold, int(distances.size), specimens
    )


def distance_facts(found: TrainingDistance) -> dict[str, Any]:
    """Return the distance as JSON can hold it."""
    return {
        "features": list(found.features),
        "centre": found.centre.tolist(),
        "spread": found.spread.tolist(),
        "precision": found.precision.tolist(),
        "threshold": found.threshold,
        "held_out_records": found.held_out_records,
        "held_out_specimens": found.held_out_specimens,
    }


def distance_from_facts(facts: dict[str, Any]) -> TrainingDistance:
    """Return what `distance_facts` wrote.

    Raises
    ------
    ValueError, KeyError
        If shapes do not fit or something is missing.
    """
    features = tuple(facts["features"])
    centre, spread, precision = (
        np.asarray(facts[name], dtype=np.float64) for name in ("centre", "spread", "precision")
    )
    size = len(features)
    if centre.shape != (size,) or spread.shape != (size,) or precision.shape != (size, size):
        raise ValueError(f"distance: {size} features, but {centre.shape}, {spread.shape}, {precision.shape}")
    return TrainingDistance(
        features, centre, spread, precision, float(facts["threshold"]),
        int(facts["held_out_records"]), int(facts["held_out_specimens"]),
    )  # fmt: skip
