"""The attacker that asks every tooth of the first driver whether its engagement stands out of those of the others.

The energy of a tooth's `innovations`, in slices of a pitch and three bands, is compared with that of the other teeth at
the same place. Logistic regression learns from the teeth that the labels name against all teeth of healthy records; a
record has the score of its loudest tooth. Derived.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from itertools import pairwise

import numpy as np

from diagnostics.audit.innovations import measured_channels
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.judging.evaluation import Entry

STEPS = 48
"""Angle steps of a pitch."""
WINDOW = 64
"""Steps from where a tooth enters that belong to it; the next one is in them."""
SLICE, APART = 4, 3
"""Steps of a slice, and from one to the next."""
MESHES = (0.5, 3.0, 9.0, 1e9)
"""Edges of the three bands, in mesh orders: what a small spall changes lies in one of them."""
FLOOR = 0.15
"""Added to ratios of energies, whose logarithm a quiet slice would else decide."""
STRENGTH = 1e-3
"""C of the regression: columns are many, teeth to learn from few."""
TINY = 1e-30


def tooth_energies(lines: np.ndarray, teeth: int) -> np.ndarray:
    """Return logarithms of each tooth's energy over that of the others, (teeth, bands * channels * slices).

    Parameters
    ----------
    lines : (channels, orders) complex128
        Innovations of one record.
    teeth : int
    """
    from scipy import fft

    steps, order = teeth * STEPS, np.arange(lines.shape[-1])
    start = np.arange(teeth)[:, None] * STEPS + np.arange(0, WINDOW - SLICE + 1, APART)
    found = []
    for low, high in pairwise(MESHES):
        kept = np.where((order >= low * teeth) & (order < high * teeth), lines, 0.0)[:, : steps // 2]
        power = np.square(fft.irfft(kept, steps, axis=-1))
        energy = np.sum([np.roll(power, -step, axis=-1) for step in range(SLICE)], axis=0)
        own = energy[:, start % steps]
        others = (own.sum(axis=1, keepdims=True) - own) / (teeth - 1)
        found += list(np.log(own / (others + TINY) + FLOOR))
    return np.concatenate(found, axis=-1)


class _LoudestTooth:
    """Logistic regression on energies of teeth (teeth, columns) by record; X are places of records."""

    def __init__(self, energies: Mapping[int, np.ndarray], faulty: np.ndarray) -> None:
        self.energies, self.faulty = energies, faulty

    def fit(self, X: np.ndarray, y: np.ndarray, groups: np.ndarray) -> _LoudestTooth:  # noqa: ARG002
        """Fit to all teeth of healthy records and to those that labels name; y (1, n)."""
        from sklearn.linear_model import LogisticRegression
        from sklearn.pipeline import make_pipeline
        from sklearn.preprocessing import StandardScaler

        damaged = y[0].tolist()
        rows = [self._known(row, ill) for row, ill in zip(X.tolist(), damaged, strict=True)]
        target = np.repeat(damaged, [len(one) for one in rows])
        self.model = None
        if 0 < target.sum() < target.size:
            model = LogisticRegression(C=STRENGTH, class_weight="balanced", max_iter=300)
            self.model = make_pipeline(StandardScaler(), model).fit(np.concatenate(rows), target)
        return self

    def _known(self, row: int, ill: bool) -> np.ndarray:
        """Return the teeth to learn from: all of a healthy record, else those named; strangers may count from 1."""
        own = self.energies[row]
        return own[[tooth for tooth in self.faulty[row] if 0 <= tooth < len(own)]] if ill else own

    def score(self, X: np.ndarray) -> np.ndarray:
        """Return the score of the loudest tooth of every record, (1, m); all alike where no label names a tooth."""
        if self.model is None:
            return np.zeros((1, X.size))
        asked = [self.energies[row] for row in X.tolist()]
        first = np.cumsum([0, *map(len, asked[:-1])])
        return np.maximum.reduceat(self.model.decision_function(np.concatenate(asked)), first)[None]


def tooth_attacker(name: str, measured: MeasuredSet, lines: np.ndarray) -> Entry | None:
    """Return the attacker, or None where no label names a tooth of the first driver.

    Parameters
    ----------
    name : str
    measured : MeasuredSet
    lines : (records, channels, orders) complex128
        Innovations, of records or of their differences from the reference; NaN where there is none.
    """
    faulty = measured.first("faulty_teeth")
    if faulty is None:
        return None
    usable = np.asarray(measured_channels(lines).all(axis=1))
    teeth, places = measured.teeth, np.arange(len(lines))
    energies = {row: tooth_energies(lines[row], int(teeth[row])) for row in places[usable].tolist()}
    columns = next(iter(energies.values())).shape[1] if energies else 0
    return Entry(name, partial(_LoudestTooth, energies, faulty), places, usable, columns, deals=1, many=False)
