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
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnostics.prediction.distance_part import CLIPPED_AT, DistancePart, fit_part, part_facts, part_from_facts
from diagnostics.prediction.floor_roughness import DIFFERENCE, ROUGHNESS
from diagnostics.prediction.group_bound import group_bound
from diagnostics.prediction.noise_floor import FLOOR
from diagnostics.training.splits import SpecimenSplit

LINES = (
    *("rms", "average_rms_pinion", "energy_ratio_pinion"),
    *(f"mesh_amplitude_h{h}" for h in range(1, 6)),
    "sideband_ratio_pinion_h1_k3",
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
            Mean speed of the pinion.
        """
        return np.asarray(np.max([part.distance(own, speed_hz) for part, own in self._columns(logs)], axis=0))

    def farthest(self, logs: np.ndarray, speed_hz: np.ndarray) -> np.ndarray:
        """Return how far the farthest feature of every record lies off, (n,), in spreads; arguments as above."""
        every = [np.abs(part.standardised(own, speed_hz)).max(axis=1) for part, own in self._columns(logs)]
        return np.asarray(np.max(every, axis=0))

    def strangest(self, logs: np.ndarray, speed_hz: float, count: int = 3) -> list[tuple[str, float]]:
        """Return the features of one record (k,) farthest off the line, in spreads."""
        speed = np.array([speed_hz])
        off = np.concatenate([part.standardised(own, speed)[0] for part, own in self._columns(logs[None, :])])
        return [(self.features[k], float(off[k])) for k in np.argsort(-np.abs(off))[:count]]

    def _columns(self, logs: np.ndarray) -> list[tuple[DistancePart, np.ndarray]]:
        ends = np.cumsum([len(part.features) for part in self.parts])
        return list(zip(self.parts, np.split(logs, ends[:-1], axis=1), strict=True))


def distance_features(names: tuple[str, ...]) -> tuple[tuple[str, ...], ...]:
    """Return the columns that each part of the distance takes, of all channels."""
    lines = tuple(name for name in names if name.split("__")[0] in LINES)
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
        Their mean pinion speed.
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


def distance_facts(found: TrainingDistance) -> dict[str, Any]:
    """Return the distance as JSON can hold it."""
    return {
        "parts": [part_facts(part) for part in found.parts],
        "threshold": found.threshold,
        "held_out_specimens": found.held_out_specimens,
        "largest_spreads": found.largest_spreads if np.isfinite(found.largest_spreads) else None,
    }


def distance_from_facts(facts: dict[str, Any]) -> TrainingDistance:
    """Return what `distance_facts` wrote.

    Raises
    ------
    ValueError, KeyError
        If shapes do not fit or something is missing.
    """
    parts = tuple(part_from_facts(part) for part in facts["parts"])
    largest = facts.get("largest_spreads")  # models of earlier versions have none
    known = np.inf if largest is None else float(largest)
    return TrainingDistance(parts, float(facts["threshold"]), int(facts["held_out_specimens"]), known)
