"""How far a record lies from the training records, with a threshold: the largest of the distances of three parts.

One part takes what gears and supports decide (levels, mesh lines, first sidebands), one the noise floor by octaves,
which path, mounting and sensor decide, one the roughness of that floor, which damping and number of modes decide. Few
features each, since distances are estimated from few gearboxes, and not those that damage moves most (FM4 and its
like), which would make the states clusters. Taken together in one covariance the parts would dilute each other; over
their medians the part with the fewest features, whose distance scatters most, would rule the largest. So each is
divided by a bound that nine of ten records of new gearboxes keep.

The threshold comes from held-out gearboxes alone: the validation specimens, and every training specimen left out of
the fit in turn. It is an upper prediction bound for the record of a new gearbox (see `group_bound`), so that it widens
where gearboxes are few. Source: derived.

How far records lie from a straight line in log speed: robust Mahalanobis distance on a few log features.

Speed moves all features and is known, so a straight line in log speed is taken off first. Spreads are medians, no
feature counts as more than six of them (a line near a node falls without limit in logarithms), and the covariance is
shrunk (Ledoit & Wolf 2004). Source: standard literature.

Upper bound for a value of a new group, from values in a few groups: Student's, with as many degrees as groups allow.

Records of one gearbox are alike, so n gearboxes with m records each are no n m draws. Values are taken as mean plus
group effect plus scatter within a group; the bound is mean + t sqrt(between + within + variance of the mean) with t of
n - 1 degrees of freedom: for few groups it is wide, since little is known of how groups differ. Source: standard
literature (one-way random-effects model; the degrees of freedom are those of the group effect, on the safe side).
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnostics.indicators.registry import first_columns
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.prediction.noise_floor import DIFFERENCE, FLOOR, ROUGHNESS
from diagnostics.records.gear_train import GearNames
from diagnostics.training.splits import SpecimenSplit

SMALLEST_SPREAD = 0.02
"""Two per cent: differences below the tolerance of a sensor's sensitivity make no machine foreign."""

SMALLEST_SPEED_RANGE = 0.05
"""Range of log speed below which no line is fitted."""

CLIPPED_AT = 6.0
ARRAYS = ("centre", "slope", "spread", "precision")

LINES = (
    *(("rms", {}), ("average_rms", {}), ("energy_ratio", {})),
    *(("mesh_amplitude", {"harmonic": h}) for h in range(1, 6)),
    ("sideband_ratio", {"harmonic": 1}),
)
SHARE_INSIDE = 0.97
"""Share of records of new gearboxes that counts as like training: 5 % of false alarms are allowed, of which two fifths
are kept for what a threshold from few gearboxes misses by."""

SHARE_OF_SINGLES = 0.99
"""Share of records of new gearboxes no feature of which lies farther off than `largest_spreads`."""

SHARE_IN_SCALE = 0.9
"""Share of records of new gearboxes that the distance of one part, divided by its scale, keeps below one."""

SMALLEST_DISTANCE = 1e-6
"""Keeps the logarithm finite where records are equal."""


@dataclass(frozen=True, slots=True)
class DistancePart:
    """Where training records lie in some of their features.

    Attributes
    ----------
    features : tuple of str
        Columns it takes.
    centre, slope : (k,) float64
        Log features at a speed of 1 Hz on the fitted line, and their slope over log speed.
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
            Mean speed of the first shaft.
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


def part_from_facts(facts: dict[str, Any]) -> DistancePart:
    """Return the distance that its fields in JSON are of.

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
    from scipy.special import stdtrit

    members = [values[group == number] for number in np.unique(group)]
    means = np.array([found.mean() for found in members])
    freedom = sum(found.size - 1 for found in members)
    within = sum(float(np.sum((found - found.mean()) ** 2)) for found in members) / max(freedom, 1)
    of_means = float(means.var(ddof=1)) if means.size > 1 else within
    records = np.mean([1.0 / found.size for found in members])  # what scatter within adds to a mean's variance
    between = max(of_means - within * float(records), 0.0)
    quantile = float(stdtrit(max(means.size - 1, 1), share))
    return float(means.mean()) + quantile * float(np.sqrt(between + within + of_means / means.size))


@dataclass(frozen=True, slots=True)
class TrainingDistance:
    """Where training records lie.

    Attributes
    ----------
    parts : tuple of DistancePart
        Whose largest distance counts.
    threshold : float
        Largest distance that counts as like training.
    held_out_specimens : int
        How many gearboxes the threshold was chosen on.
    largest_spreads : float
        Most that a single feature may lie off, in spreads. The distance counts no feature as more than six, so that a
        line near a node does not rule; without this second bound every feature might be infinitely far.
    """

    parts: tuple[DistancePart, ...]
    threshold: float
    held_out_specimens: int
    largest_spreads: float = np.inf

    @property
    def features(self) -> tuple[str, ...]:
        """Columns it takes, part by part."""
        return tuple(name for part in self.parts for name in part.features)

    def distance(self, logs: np.ndarray, speed_hz: np.ndarray) -> np.ndarray:
        """Return the distance of records, (n,); undefined features count as typical.

        Parameters
        ----------
        logs : (n, k) float64
            Log features in the order of `features`.
        speed_hz : (n,) float64
            Mean speed of the first shaft.
        """
        return np.asarray(np.max([part.distance(own, speed_hz) for part, own in self._columns(logs)], axis=0))

    def farthest(self, logs: np.ndarray, speed_hz: np.ndarray) -> np.ndarray:
        """Return how far the farthest feature of every record lies off, (n,), in spreads; arguments as above."""
        every = [np.abs(part.standardised(own, speed_hz)).max(axis=1) for part, own in self._columns(logs)]
        return np.asarray(np.max(every, axis=0))

    def strangest(self, logs: np.ndarray, speed_hz: float) -> list[tuple[str, float]]:
        """Return the three features of one record (k,) farthest off the line, in spreads."""
        speed = np.array([speed_hz])
        off = np.concatenate([part.standardised(own, speed)[0] for part, own in self._columns(logs[None, :])])
        return [(self.features[k], float(off[k])) for k in np.argsort(-np.abs(off))[:3]]

    def _columns(self, logs: np.ndarray) -> list[tuple[DistancePart, np.ndarray]]:
        ends = np.cumsum([len(part.features) for part in self.parts])
        return list(zip(self.parts, np.split(logs, ends[:-1], axis=1), strict=True))


def distance_features(names: tuple[str, ...], gears: GearNames) -> tuple[tuple[str, ...], ...]:
    """Return the columns that each part of the distance takes, of all channels."""
    settings = IndicatorSettings()
    of_lines = {column for line, fields in LINES for column in first_columns(settings, gears, line, **fields)}
    lines = tuple(name for name in names if name.split("__")[0] in of_lines)
    floor = tuple(name for name in names if name.startswith(FLOOR))
    roughness = tuple(name for name in names if name in (ROUGHNESS, DIFFERENCE))
    return tuple(part for part in (lines, floor, roughness) if part)


def calibrated_distance(
    logs: np.ndarray,
    speed_hz: np.ndarray,
    parts: tuple[tuple[str, ...], ...],
    split: SpecimenSplit,
    specimen: np.ndarray,
) -> TrainingDistance:
    """Return the distance to the training specimens with the threshold of the held-out ones; test is not touched.

    Parameters
    ----------
    logs : (records, k) float64
        Log features of all records, part by part.
    speed_hz : (records,) float64
        Their mean speed of the first shaft.
    parts : tuple of tuple of str
        Names of the features of each part.
    split : SpecimenSplit
        Whose specimens are which.
    specimen : (records,) int
        Specimen of every record.
    """
    used = split.train | split.validation
    ends = np.cumsum([len(part) for part in parts])
    fitted, farthest, single = [], np.zeros(len(logs)), np.zeros(len(logs))
    for names, own in zip(parts, np.split(logs, ends[:-1], axis=1), strict=True):
        part = fit_part(own[split.train], speed_hz[split.train], names)
        held_out, spreads = _held_out(part, own, speed_hz, split, specimen)
        single = np.maximum(single, spreads)
        scale = _bound(held_out[used], specimen[used], SHARE_IN_SCALE)
        fitted.append(replace(part, scale=scale))
        farthest = np.maximum(farthest, held_out / scale)
    threshold = _bound(farthest[used], specimen[used], SHARE_INSIDE)
    largest = _bound(single[used], specimen[used], SHARE_OF_SINGLES)
    return TrainingDistance(tuple(fitted), threshold, int(np.unique(specimen[used]).size), max(largest, CLIPPED_AT))


def _bound(distance: np.ndarray, specimen: np.ndarray, share: float) -> float:
    """Return what a share of the distances of new gearboxes lies below, taken as log-normal."""
    return float(np.exp(group_bound(np.log(np.maximum(distance, SMALLEST_DISTANCE)), specimen, share)))


def _held_out(
    part: DistancePart, logs: np.ndarray, speed_hz: np.ndarray, split: SpecimenSplit, specimen: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return distance and farthest feature of all records, of those of a training specimen from a fit without it."""
    found, single = part.distance(logs, speed_hz), np.abs(part.standardised(logs, speed_hz)).max(axis=1)
    trained = np.unique(specimen[split.train])
    for number in trained if trained.size > 2 else ():
        own = split.train & (specimen == number)
        others = split.train & ~own
        fitted = fit_part(logs[others], speed_hz[others], part.features)
        found[own] = fitted.distance(logs[own], speed_hz[own])
        single[own] = np.abs(fitted.standardised(logs[own], speed_hz[own])).max(axis=1)
    return found, single


def distance_from_facts(facts: dict[str, Any]) -> TrainingDistance:
    """Return the distance that its fields in JSON are of.

    Raises
    ------
    ValueError, KeyError
        If shapes do not fit or something is missing.
    """
    parts = tuple(part_from_facts(part) for part in facts["parts"])
    largest = facts["largest_spreads"]
    known = np.inf if largest is None else float(largest)
    return TrainingDistance(parts, float(facts["threshold"]), int(facts["held_out_specimens"]), known)
