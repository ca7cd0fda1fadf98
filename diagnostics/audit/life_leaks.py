"""Leaks of lives: whether what should tell nothing tells how long a gearbox still runs, beside its age.

The same trees learn from age alone and from age with a clue, on gearboxes that are not predicted. A clue leaks where it
lowers the error by more than resampled gearboxes explain. Clues: the number of the inspection, the identity of gearbox
and record, hours since the inspections before, and the bytes of the samples.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.statistics.evaluation import bootstrap_weights
from diagnostics.training.lives import Inspections, tree_predictions

CHANCE = 0.05
"""Of a leak where there is none, over all clues together."""
EARLIER = 3
"""Inspections before, back to which the hours are a clue."""


@dataclass(frozen=True, slots=True)
class Leak:
    """By how many hours a clue lowers the RMSE of age alone, and the least that resampled gearboxes leave of it."""

    clue: str
    age_rmse_h: float
    gain_h: float
    least_gain_h: float

    @property
    def found(self) -> bool:
        """Whether the clue tells the remaining life."""
        return self.least_gain_h > 0.0

    def numbers(self) -> dict[str, object]:
        """Return it for JSON."""
        gains = {"gain_h": self.gain_h, "least_gain_h": self.least_gain_h}
        return {"clue": self.clue, "age_rmse_h": self.age_rmse_h, **gains, "leaks": self.found}


def life_leaks(found: Inspections, seed: int) -> tuple[Leak, ...]:
    """Return what each clue tells beside age, of gearboxes that failed."""
    clues, known = _clues(found), np.isfinite(found.rul_h)
    weights = bootstrap_weights(found.specimen[known], seed)

    def rmse_h(values: np.ndarray) -> np.ndarray:
        error = (tree_predictions(values, found, seed, (0.5,))[:, 0] - found.rul_h)[known]
        return np.asarray(np.sqrt(weights @ error**2 / weights.sum(axis=1)))

    age = found.age_h[:, None]
    alone = rmse_h(age)
    gains = {name: alone - rmse_h(np.concatenate([age, values], axis=1)) for name, values in clues.items()}
    least = CHANCE / len(clues)
    return tuple(
        Leak(name, float(alone[0]), float(gain[0]), float(np.quantile(gain[1:], least))) for name, gain in gains.items()
    )


def _clues(found: Inspections) -> dict[str, np.ndarray]:
    first = np.flatnonzero(np.diff(found.specimen, prepend=-1))  # inspections stand in the order of gearbox and age
    number = np.arange(found.specimen.size) - np.repeat(first, np.diff(first, append=found.specimen.size))
    gaps = [
        np.where(number >= back, found.age_h - np.roll(found.age_h, back), np.nan) for back in range(1, EARLIER + 1)
    ]
    return {
        "number of the inspection": number[:, None].astype(np.float64),
        "identity of gearbox and record": np.stack([found.specimen, found.record_id], axis=1).astype(np.float64),
        "hours since the inspections before": np.stack(gaps, axis=1),
        "bytes of the samples": found.sample_bytes,
    }
