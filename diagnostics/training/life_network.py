"""A small network on the averages of a gearbox's inspections in their order: quantiles of its remaining life.

Averages of one revolution go through convolutions round the shaft. What they give, less what the gearbox's first
inspection gave, goes with age through a recurrent layer, inspection by inspection. The result corrects what age alone
tells: before training the network is the law of age. Of the training gearboxes every fifth chooses when to stop, the
start included. Source: gated recurrent units (Cho et al. 2014), standard literature; the rest derived.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import nn

from diagnostics.base.seeding import Purpose, generator
from diagnostics.statistics.life_scores import QUANTILES
from diagnostics.training.cnn import SMALLEST_LEVEL, CircularConvolution
from diagnostics.training.loop import LoopSettings, fit_network, seeded

CONVOLUTIONS = ((4, 31, 4), (8, 7, 2))
"""Width, kernel and stride, each followed by a maximum over two steps."""
HIDDEN = 8
"""Of the recurrent layer, and of what goes into it."""
STEPS, BATCH, EVERY = 240, 8, 20
"""Gradient steps at most, gearboxes in each, and steps from one look at those that choose to the next."""
LEARNING_RATE, WEIGHT_DECAY, DROPOUT = 3e-3, 0.3, 0.5
CHOOSING = 5
"""One of so many training gearboxes chooses when to stop."""


@dataclass(frozen=True, slots=True)
class LifeSequences:
    """Inspections in the order of gearbox and age, with what age alone tells of them.

    Attributes
    ----------
    rows : (n, rows, steps) float32
        Averages of one revolution, see `average_rows`.
    specimen, age_h, rul_h : (n,)
        Gearbox, age, remaining life; NaN where nobody knows it.
    of_age_h : (n, 3) float64
        Quantiles of the remaining life at that age.
    """

    rows: np.ndarray
    specimen: np.ndarray
    age_h: np.ndarray
    rul_h: np.ndarray
    of_age_h: np.ndarray

    def units(self, among: np.ndarray) -> list[np.ndarray]:
        """Return the inspections of each gearbox among some (n,) bool, in order of age."""
        return [np.flatnonzero(among & (self.specimen == unit)) for unit in np.unique(self.specimen[among])]


class LifeNetwork(nn.Module):  # type: ignore[misc]  # the type checker does not read torch
    """Averages (inspections, rows, steps) of some gearboxes to three numbers that correct the quantiles of age."""

    def __init__(self, rows: int) -> None:
        super().__init__()
        layers: list[nn.Module] = []
        before = rows
        for width, kernel, stride in CONVOLUTIONS:
            layers += [CircularConvolution(before, width, kernel, stride), nn.MaxPool1d(2)]
            before = width
        self.body, self.dropout = nn.Sequential(*layers), nn.Dropout(DROPOUT)
        self.narrow = nn.Linear(2 * before + rows + 1, HIDDEN)
        self.recurrent = nn.GRU(HIDDEN, HIDDEN, batch_first=True)
        self.head = nn.Linear(HIDDEN, len(QUANTILES))
        nn.init.zeros_(self.head.weight)
        nn.init.zeros_(self.head.bias)

    def forward(self, rows: torch.Tensor, age: torch.Tensor, counts: Sequence[int]) -> torch.Tensor:
        """Return the corrections (inspections, 3) of gearboxes with so many inspections each."""
        level = torch.sqrt((rows * rows).mean(dim=2)) + SMALLEST_LEVEL
        mapped = self.body(rows / level.unsqueeze(2))
        seen = torch.cat([mapped.mean(dim=2), mapped.amax(dim=2), torch.log(level)], dim=1)
        first = torch.from_numpy(np.repeat(np.cumsum([0, *counts[:-1]]), counts))
        taken = torch.tanh(self.narrow(torch.cat([self.dropout(seen - seen[first]), age.unsqueeze(1)], dim=1)))
        padded = nn.utils.rnn.pad_sequence(list(torch.split(taken, list(counts))), batch_first=True)
        found, _ = self.recurrent(padded)
        corrections: torch.Tensor = self.head(torch.cat([found[k, :n] for k, n in enumerate(counts)]))
        return corrections


def network_quantiles(known: LifeSequences, seed: int, train: np.ndarray, test: np.ndarray) -> np.ndarray:
    """Return what a network trained on some rows (n,) bool says of others, (test rows, 3) in hours at `QUANTILES`.

    Gearboxes are in one of both alone. The same seed gives the same numbers on one machine.
    """
    with seeded(seed):
        network = LifeNetwork(known.rows.shape[1])
        _fit(network, known, known.units(train & np.isfinite(known.rul_h)), seed)
        with torch.no_grad():
            return np.concatenate([_quantiles(network, known, [unit]).numpy() for unit in known.units(test)])


def _fit(network: LifeNetwork, known: LifeSequences, units: list[np.ndarray], seed: int) -> None:
    chosen = generator(seed, Purpose.LIFE_NETWORK).permutation(len(units))
    choosing = [units[k] for k in chosen[::CHOOSING]]
    learning = [units[k] for k in np.setdiff1d(chosen, chosen[::CHOOSING])]

    def batches(step: int) -> Iterator[torch.Tensor]:
        if learning:
            order = generator(seed, Purpose.LIFE_NETWORK, step).permutation(len(learning))
            yield _loss(network, known, [learning[k] for k in order[:BATCH]])

    def judged() -> float:
        return float(_loss(network, known, choosing)) if choosing else 0.0

    fit_network(
        network, batches, judged, LoopSettings(STEPS, LEARNING_RATE, WEIGHT_DECAY, every=EVERY, from_start=True)
    )


def _loss(network: LifeNetwork, known: LifeSequences, units: list[np.ndarray]) -> torch.Tensor:
    """Return the mean pinball loss in spreads of the law of age."""
    predicted = _quantiles(network, known, units)
    rows = np.concatenate(units)
    missed = torch.from_numpy(known.rul_h[rows]).unsqueeze(1) - predicted
    level = torch.tensor(QUANTILES, dtype=missed.dtype)
    return torch.maximum(level * missed, (level - 1.0) * missed).mean() / float(_spread_h(known.of_age_h).mean())


def _quantiles(network: LifeNetwork, known: LifeSequences, units: list[np.ndarray]) -> torch.Tensor:
    """Return the quantiles of all inspections of some gearboxes, (inspections, 3) [h]; none crosses another."""
    rows = np.concatenate(units)
    seen = torch.from_numpy(known.rows[rows])
    age = torch.from_numpy((known.age_h[rows] / known.age_h.max()).astype(np.float32))
    middle, below, above = network(seen, age, [unit.size for unit in units]).double().T
    of_age = torch.from_numpy(known.of_age_h[rows])
    spread = torch.from_numpy(_spread_h(known.of_age_h[rows]))
    median = of_age[:, 1] + spread * middle
    low = median - (of_age[:, 1] - of_age[:, 0]) * torch.exp(below)
    return torch.stack([low, median, median + (of_age[:, 2] - of_age[:, 1]) * torch.exp(above)], dim=1)


def _spread_h(of_age_h: np.ndarray) -> np.ndarray:
    """Return half the interval of the law of age, (n,)."""
    return np.asarray(0.5 * (of_age_h[:, 2] - of_age_h[:, 0]))
