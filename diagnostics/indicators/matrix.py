"""Labels and indicators of records as arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class FeatureMatrix:
    """Labels and indicators of all records as arrays.

    Attributes
    ----------
    values : (records, columns) float64
        NaN where undefined.
    names : tuple of str
        Column names, `<indicator>__<channel>`.
    labels : dict of str to (records,)
        Label columns, and `class`: what classifiers tell apart.
    """

    values: np.ndarray
    names: tuple[str, ...]
    labels: dict[str, np.ndarray]

    def rows(self, mask: np.ndarray) -> FeatureMatrix:
        """Return the chosen records."""
        return FeatureMatrix(self.values[mask], self.names, {k: v[mask] for k, v in self.labels.items()})

    def columns(self, names: Sequence[str]) -> FeatureMatrix:
        """Return the chosen columns."""
        place = {name: k for k, name in enumerate(self.names)}
        return FeatureMatrix(self.values[:, [place[name] for name in names]], tuple(names), self.labels)
