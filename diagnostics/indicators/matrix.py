"""Labels and indicators of records as arrays, with the role of every column as the set has it.

Only a target is to be predicted, and only a condition is known before a measurement. What follows from the damage, as
the loss of mesh stiffness does, would give the answer away.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from diagnostics.records.gear_train import PAIR, GearNames
from diagnostics.records.state_classes import CLASS
from siggen.keys.column import Role


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
        Label columns, and `class`: what classifiers tell apart; of lives `age_h` and `rul_h` in its place.
    label_roles : mapping of str to Role
        Of labels, as the set says them; others are conditions.
    gears : GearNames
        What columns are called after.
    undefined : tuple of str
        Columns that are left out because no record has a value there.
    """

    values: np.ndarray
    names: tuple[str, ...]
    labels: dict[str, np.ndarray]
    label_roles: Mapping[str, Role] = field(default_factory=dict)
    gears: GearNames = PAIR
    undefined: tuple[str, ...] = ()

    def __iter__(self) -> Iterator[np.ndarray]:
        """Yield values, target and groups: `X, y, groups = diagnostics.table(dataset)`; of lives y is `rul_h`."""
        yield from (self.values, self.labels[CLASS if CLASS in self.labels else "rul_h"], self.groups)

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
    def roles(self) -> dict[str, Role]:
        """Role of every column: `measured` of indicators; `key`, `condition`, `consequence`, `target` of labels."""
        labels = {name: self.label_roles.get(name, Role.CONDITION) for name in self.labels}
        return {**dict.fromkeys(self.names, Role.MEASURED), **labels}

    def split(self, name: str) -> FeatureMatrix:
        """Return the records of a split: train, validation or test."""
        return self.rows(self.labels["split"] == name)

    def rows(self, mask: np.ndarray) -> FeatureMatrix:
        """Return the chosen records."""
        return replace(self, values=self.values[mask], labels={k: v[mask] for k, v in self.labels.items()})

    def columns(self, names: Sequence[str]) -> FeatureMatrix:
        """Return the chosen columns, such as those of another set; those that no record here has are NaN."""
        place = {name: k for k, name in enumerate(self.names)}
        nowhere = np.full(len(self.values), np.nan)
        found = [nowhere if name in self.undefined else self.values[:, place[name]] for name in names]
        return replace(self, values=np.stack(found, axis=1), names=tuple(names), undefined=())

    def defined(self) -> FeatureMatrix:
        """Return the columns that some record has a value of; the others by name in `undefined`."""
        known = np.isfinite(self.values).any(axis=0)
        kept, lost = (tuple(np.array(self.names)[chosen].tolist()) for chosen in (known, ~known))
        return replace(self, values=self.values[:, known], names=kept, undefined=lost)
