"""Labels and indicators of records as arrays.

What the columns of a table of records are to whoever learns from them: condition, target, key; read, never guessed.

Only a target is to be predicted, and only a condition is known before a measurement. What follows from the damage, as
the loss of mesh stiffness does, would give the answer away.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnostics.records.state_classes import CLASS

KEY, CONDITION, MEASURED, CONSEQUENCE, TARGET = "key", "condition", "measured", "consequence", "target"
LABEL_ROLES = {
    **dict.fromkeys(("record_id", "specimen_id", "state_id", "operating_point_id", "repeat", "split"), KEY),
    **dict.fromkeys(("teeth_pinion", "teeth_gear", "speed_hz", "torque_nm"), CONDITION),
    **dict.fromkeys(("state", CLASS, "fault", "severity", "damaged_area_mm2", "damaged_area_share"), TARGET),
    **dict.fromkeys(("through_face", "sham"), TARGET),  # where a set has them
    "mesh_stiffness_loss": CONSEQUENCE,
}
"""Role of every label that goes along with indicators."""


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

    @property
    def groups(self) -> np.ndarray:
        """(records,) int: the gearbox of each record; one gearbox belongs to one side of any split or fold."""
        return self.labels["specimen_id"]

    @property
    def classes(self) -> tuple[str, ...]:
        """The classes in the order of the configuration; `class_id` of a loader is the place in it."""
        order = np.argsort(self.labels["state_id"], kind="stable")
        return tuple(dict.fromkeys(self.labels[CLASS][order].tolist()))

    @property
    def roles(self) -> dict[str, str]:
        """Role of every column: `measured` of indicators; `key`, `condition`, `consequence`, `target` of labels."""
        return {**dict.fromkeys(self.names, MEASURED), **{name: LABEL_ROLES[name] for name in self.labels}}

    def split(self, name: str) -> FeatureMatrix:
        """Return the records of a split: train, validation or test."""
        return self.rows(self.labels["split"] == name)

    def rows(self, mask: np.ndarray) -> FeatureMatrix:
        """Return the chosen records."""
        return FeatureMatrix(self.values[mask], self.names, {k: v[mask] for k, v in self.labels.items()})

    def columns(self, names: Sequence[str]) -> FeatureMatrix:
        """Return the chosen columns."""
        place = {name: k for k, name in enumerate(self.names)}
        return FeatureMatrix(self.values[:, [place[name] for name in names]], tuple(names), self.labels)
