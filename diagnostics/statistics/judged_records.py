"""What the judgements of all indicators of a set share: labels, states, resamples, pairs, steps of ladders.

Whether an indicator rises from state to state: mean sign of its steps over the severity ladder.

Each ladder is one specimen at one operating point and repeat, its records in order of damaged area. 1: every step up;
-1: every step down; 0: as often up as down. Source: Coble & Hines 2009 (there its magnitude), standard literature.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from diagnostics.indicators.history import histories
from diagnostics.records.state_classes import HEALTHY, ordered_states
from diagnostics.statistics.evaluation import CentredRanks, Interval, bootstrap_weights, centred_ranks, interval
from diagnostics.statistics.multiple_tests import PairedRecords, paired_records

RESAMPLES = 400
LARGEST_BLOCK = 4_000_000
"""Largest resamples times records; more records get fewer resamples, since their intervals are narrow anyway."""

MOST_KNOWN = 2
"""Ranks of labels that are kept: area and loss of stiffness where most indicators are defined; more fill memory."""


def ladder_steps(ladders: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows before and after each step of all ladders, (k,) int each.

    Parameters
    ----------
    ladders : sequence of (m,) int
        Rows of each ladder in order of severity.
    """
    pairs = [(int(a), int(b)) for rows in ladders for a, b in pairwise(rows)]
    found = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    return found[:, 0], found[:, 1]


def monotonicity(steps: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the weighted mean sign of the steps, (b,); NaN without weight.

    Parameters
    ----------
    steps : (k,) float64
        Value after minus value before each step, without NaN.
    weights : (b, k) float64
        Weights of the steps, those of their specimens.
    """
    total = weights.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(weights @ np.sign(steps) / total)


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
    known : dict
        Ranks of labels that were asked for.
    """

    labels: dict[str, np.ndarray]
    states: tuple[str, ...]
    weights: np.ndarray
    pairs: PairedRecords
    steps: tuple[np.ndarray, np.ndarray]
    known: dict[tuple[str, bytes], CentredRanks] = field(default_factory=dict, repr=False, compare=False)

    def centred(self, label: str, rows: np.ndarray) -> CentredRanks:
        """Return the centred ranks of a label over these rows; most indicators are defined on the same."""
        key = (label, rows.tobytes())
        if key not in self.known:
            if len(self.known) >= MOST_KNOWN:
                self.known.clear()
            self.known[key] = centred_ranks(self.labels[label][rows], self.weights[:, rows])
        return self.known[key]

    def centred_values(self, values: np.ndarray) -> CentredRanks:
        """Return the centred ranks of an indicator, (records,), over the rows where it is defined."""
        rows = np.flatnonzero(np.isfinite(values))
        return centred_ranks(values[rows], self.weights[:, rows])

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
