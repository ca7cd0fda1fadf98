"""What the judgements of all indicators of a set share: labels, states, resamples, pairs, steps of ladders."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.indicators.history import histories
from diagnostics.records.state_classes import HEALTHY, ordered_states
from diagnostics.statistics.evaluation import Interval, bootstrap_weights, interval
from diagnostics.statistics.monotonicity import ladder_steps
from diagnostics.statistics.paired_differences import PairedRecords, paired_records

RESAMPLES = 400
LARGEST_BLOCK = 4_000_000
"""Largest resamples times records; more records get fewer resamples, since their intervals are narrow anyway."""


@dataclass(frozen=True, slots=True)
class JudgedRecords:
    """What all indicators share.

    Attributes
    ----------
    labels : dict of str to (records,)
    states : tuple of str
        Those with damaged records, in the order of the configuration.
    weights : (resamples + 1, records) float64
        Row 0 is the sample itself.
    pairs : PairedRecords
        Same specimen before and after.
    steps : ((k,) int, (k,) int)
        Rows before and after each step up a ladder of damage.
    """

    labels: dict[str, np.ndarray]
    states: tuple[str, ...]
    weights: np.ndarray
    pairs: PairedRecords
    steps: tuple[np.ndarray, np.ndarray]

    def interval(self, samples: np.ndarray, rows: np.ndarray) -> Interval:
        """Return the interval of a statistic over these rows."""
        return interval(samples, int(np.unique(self.labels["specimen_id"][rows]).size))


def judged_records(labels: dict[str, np.ndarray], seed: int, resamples: int = RESAMPLES) -> JudgedRecords:
    """Return what all indicators of records with these labels share."""
    count = labels["specimen_id"].size
    weights = bootstrap_weights(labels["specimen_id"], seed, min(resamples, max(50, LARGEST_BLOCK // count)))
    damaged = set(labels["state"][labels["fault"] != HEALTHY].tolist())
    states = tuple(state for state in ordered_states(labels) if state in damaged)
    return JudgedRecords(labels, states, weights, paired_records(labels), ladder_steps(histories(labels)))
