"""The attacker that asks every tooth of the first driver whether its engagement stands out of those of the others.

The energy of a tooth's `innovations`, in slices of a pitch and three bands, is compared with that of the other teeth at
the same place. Logistic regression learns from the teeth that the labels name against all teeth of healthy records; a
record has the score of its loudest tooth. Derived.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from diagnostics.audit.held_out import Attacker, Trial, Verdicts
from diagnostics.audit.innovations import measured_channels
from diagnostics.audit.measured_set import MeasuredSet

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


def tooth_attacker(name: str, measured: MeasuredSet, lines: np.ndarray) -> Attacker | None:
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
    teeth = measured.teeth
    asked = {row: tooth_energies(lines[row], int(teeth[row])) for row in np.flatnonzero(usable).tolist()}

    def attack(trial: Trial) -> Verdicts:
        learnt, judged = trial.rows[trial.train].tolist(), trial.rows[~trial.train].tolist()
        damaged = trial.positive[0][trial.train].tolist()
        rows = [_known(asked[row], faulty[row], ill) for row, ill in zip(learnt, damaged, strict=True)]
        target = np.repeat(damaged, [len(one) for one in rows])
        if not 0 < target.sum() < target.size:  # no label names a tooth
            return Verdicts(np.zeros((1, len(judged))))
        said = _learnt(np.concatenate(rows), target)(np.concatenate([asked[row] for row in judged]))
        first = np.cumsum([0, *(len(asked[row]) for row in judged[:-1])])
        return Verdicts(np.maximum.reduceat(said, first)[None])

    columns = next(iter(asked.values())).shape[1] if asked else 0
    return Attacker(name, attack, usable, columns, deals=1, permutable=False)


def _known(energies: np.ndarray, faulty: Sequence[int], damaged: bool) -> np.ndarray:
    """Return the teeth to learn from: all of a healthy record, else those named; foreign labels may count from 1."""
    return energies[[tooth for tooth in faulty if 0 <= tooth < len(energies)]] if damaged else energies


def _learnt(values: np.ndarray, target: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Return what gives the score of teeth from those that are known."""
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    model = make_pipeline(StandardScaler(), LogisticRegression(C=STRENGTH, class_weight="balanced", max_iter=300))
    fitted = model.fit(values, target)
    return lambda rows: np.asarray(fitted.decision_function(rows))
