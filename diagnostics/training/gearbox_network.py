"""A residual network that asks every gear of a gearbox alike, with and without a healthy record of the same gearbox.

Turns of all gears go through the same convolutions round the shaft; largest value and mean over the angle pool them,
then largest value and mean over the gears. So teeth and number of gears do not matter, nor which tooth is damaged. Four
heads: whether there is damage, which kind it is, which gear has it, and its size with an interval. While it learns,
healthy records are taken away at random, so that one set of weights answers alone and beside.

Source: residual networks (He et al. 2016), quantiles by the pinball loss (Koenker and Bassett 1978), their interval
widened on gearboxes left out (Romano et al. 2019); the rest derived.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import nn

from diagnostics.training.gear_rows import ALONE, ROWS
from diagnostics.training.likeness import NUMBERS, distances, farthest
from diagnostics.training.loop import in_one_thread
from diagnostics.training.weights_file import load_weights, other_schema, read_facts, save_weights

FORMAT = "siggen-diagnostics network on gears 2"

WIDTHS = (24, 32, 48)
"""Channels of the stages; a maximum over two steps stands between them."""
FIRST, KERNEL, STRIDE = 15, 5, 2
"""Steps of the first kernel and of all others, and the stride of the first."""
TOLD, DROPPED = 48, 0.3
"""Numbers that tell of a gear, and the share of what goes into them that is dropped while learning."""
QUANTILES = (0.05, 0.5, 0.95)
"""Of the size: an interval of 90 %."""
LEVELS = 401
"""Quantiles that are kept of what was said of unseen records."""
GEARS = ("pinion", "gear")
"""Whose averages a record has, in order of power."""
NOWHERE = -1
"""Gear or kind of a record without damage, or with damage in several gears."""
SAID = 0.99
"""Share of unseen sound records of which damage is not said."""
BATCH = 256
"""Channels of records that are asked at a time."""
WEIGHTS = {"damage": 1.0, "kind": 0.3, "gear": 0.3, "size": 0.3}
"""Shares of the heads in the loss: damage is what all others rest on."""


class CircularResidual(nn.Module):  # type: ignore[misc]  # the type checker does not read torch
    """Two convolutions over a signal whose ends meet, added to what went in."""

    def __init__(self, width: int) -> None:
        super().__init__()
        self.first, self.second = (_circular(width, width, KERNEL) for _ in range(2))
        self.normal, self.last = (nn.BatchNorm1d(width) for _ in range(2))

    def forward(self, signal: torch.Tensor) -> torch.Tensor:
        """Return as many steps."""
        inner = nn.functional.relu(self.normal(self.first(signal)))
        return nn.functional.relu(signal + self.last(self.second(inner)))


def _circular(before: int, after: int, kernel: int, stride: int = 1) -> nn.Conv1d:
    beside = kernel // 2
    return nn.Conv1d(before, after, kernel, stride, padding=beside, padding_mode="circular", bias=False)


@dataclass(frozen=True, slots=True)
class Told:
    """What the network says of records.

    Attributes
    ----------
    damage : (records,) tensor
        Log odds.
    kind : (records, kinds) tensor
        Logits of the kind, if there is damage.
    gear : (records, gears) tensor
        Logits of the gear, if one has it.
    size : (records, 3) tensor
        Quantiles of the logarithm of the damaged share of the worst flank, ascending.
    """

    damage: torch.Tensor
    kind: torch.Tensor
    gear: torch.Tensor
    size: torch.Tensor


class Limits(nn.Module):  # type: ignore[misc]
    """What was said of unseen gearboxes, alone and beside (rows 0 and 1): what answers are held against.

    Attributes
    ----------
    average_centre, average_spread, average_precision : (28,), (28,), (28, 28) float64
        Of the numbers of averages, see `diagnostics.training.likeness`.
    seen_centre, seen_precision : (2, 96), (2, 96, 96) float64
        Of what the heads rest on.
    farthest : (2, 3) float64
        Distances that are like training.
    sound, damaged : (2, 401) float64
        Log odds of damage of unseen records, quantiles from 0 to 1: of the sound state that looks worst, and of all
        damaged ones.
    """

    def __init__(self) -> None:
        super().__init__()
        numbers, seen = len(GEARS) * NUMBERS, 2 * TOLD
        for name, shape in (
            ("average_centre", (numbers,)),
            ("average_spread", (numbers,)),
            ("average_precision", (numbers, numbers)),
            ("seen_centre", (2, seen)),
            ("seen_precision", (2, seen, seen)),
            ("farthest", (2, 3)),
            ("sound", (2, LEVELS)),
            ("damaged", (2, LEVELS)),
        ):
            self.register_buffer(name, torch.zeros(shape, dtype=torch.float64))

    def distances(self, averages: np.ndarray, seen: np.ndarray, side: int) -> np.ndarray:
        """Return all distances of records, (records, 3), each of the channel that lies farthest.

        Parameters
        ----------
        averages : (records, channels, 28) float64
            See `average_numbers`.
        seen : (records, channels, 96) float64
            See `seen_numbers`.
        side : int
            0 alone, 1 beside a healthy record.
        """
        found = (
            distances(averages, self.average_centre, self.average_precision),
            farthest(averages, self.average_centre, self.average_spread),
            distances(seen, self.seen_centre[side], self.seen_precision[side]),
        )
        return np.stack([each.max(axis=1) for each in found], axis=1)

    def said(self, side: int, share: float) -> float:
        """Return the log odds that a share of unseen sound records stay below."""
        return float(np.quantile(self.sound[side].numpy(), share))


class GearboxNetwork(nn.Module):  # type: ignore[misc]
    """Rows (records, gears, 4, steps) of one channel, see `gear_rows`, to what is told of it.

    Parameters
    ----------
    kinds : sequence of str
        Kinds of damage that it can name.
    widths : sequence of int
        Channels of the stages.
    """

    def __init__(self, kinds: Sequence[str], widths: Sequence[int] = WIDTHS) -> None:
        super().__init__()
        self.kinds, self.widths = tuple(kinds), tuple(widths)
        layers: list[nn.Module] = []
        before = ROWS
        for stage, width in enumerate(widths):
            opening = _circular(before, width, KERNEL if stage else FIRST, 1 if stage else STRIDE)
            layers += [opening, nn.BatchNorm1d(width), nn.ReLU(), CircularResidual(width), nn.MaxPool1d(2)]
            before = width
        self.body = nn.Sequential(*layers[:-1])
        self.dropout = nn.Dropout(DROPPED)
        self.of_gear = nn.Linear(2 * before + 1 + ROWS - ALONE, TOLD)
        self.damage, self.kind = nn.Linear(2 * TOLD, 1), nn.Linear(2 * TOLD, len(self.kinds))
        self.gear, self.size = nn.Linear(TOLD, 1), nn.Linear(2 * TOLD, len(QUANTILES))
        self.register_buffer("size_centre", torch.tensor([0.0, 1.0]))
        self.register_buffer("size_widening", torch.zeros(2))
        self.limits = Limits()

    def forward(self, rows: torch.Tensor) -> Told:
        """Return what is told; a record whose rows of change are zero stands alone."""
        each, whole = self.seen(rows)
        size = self._quantiles(whole, stands_beside(rows))
        return Told(self.damage(whole)[:, 0], self.kind(whole), self.gear(each)[..., 0], size)

    def seen(self, rows: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Return what all heads rest on: numbers of gears (records, gears, 48), and of the gearbox (records, 96)."""
        records, gears = rows.shape[:2]
        flat = rows.flatten(0, 1)
        size = torch.sqrt((flat[:, ALONE:] ** 2).mean(dim=2))
        beside = (size > 0.0).any(dim=1, keepdim=True).to(rows.dtype)
        change = beside * torch.log(size + 0.01)  # over noise about zero where nothing has changed
        mapped = self.body(flat)
        pooled = torch.cat(
            [self.dropout(torch.cat([mapped.mean(dim=2), mapped.amax(dim=2)], dim=1)), change, beside], 1
        )
        each = nn.functional.relu(self.of_gear(pooled)).unflatten(0, (records, gears))
        return each, torch.cat([each.amax(dim=1), each.mean(dim=1)], dim=1)

    def _quantiles(self, whole: torch.Tensor, beside: torch.Tensor) -> torch.Tensor:
        middle, below, above = self.size(whole).T
        middle, widening = self.size_centre[0] + self.size_centre[1] * middle, self.size_widening[beside.long()]
        low = middle - self.size_centre[1] * nn.functional.softplus(below) - widening
        high = middle + self.size_centre[1] * nn.functional.softplus(above) + widening
        return torch.stack([low, middle, high], dim=1)


def stands_beside(rows: torch.Tensor) -> torch.Tensor:
    """Return which records (records,) bool stand beside a healthy one: their rows of change are not zero."""
    return (rows[:, :, ALONE:] != 0.0).flatten(1).any(dim=1)


@dataclass(frozen=True, slots=True)
class DamageTruth:
    """What is true of records.

    Attributes
    ----------
    damaged : (records,) float32
        1 with damage.
    kind, gear : (records,) int64
        Places among the kinds and the gears; `NOWHERE` where there is none.
    size : (records,) float32
        Logarithm of the damaged share of the worst flank; NaN where nothing has an outline.
    """

    damaged: np.ndarray
    kind: np.ndarray
    gear: np.ndarray
    size: np.ndarray

    def chosen(self, places: np.ndarray) -> DamageTruth:
        """Return some of the records."""
        return DamageTruth(self.damaged[places], self.kind[places], self.gear[places], self.size[places])


def told_loss(told: Told, truths: DamageTruth, damaged_share: float) -> torch.Tensor:
    """Return the loss of a batch; both sides of damage weigh the same.

    Parameters
    ----------
    told : Told
    truths : DamageTruth
        Of the same records.
    damaged_share : float
        Of all records to learn from.
    """
    damaged = torch.from_numpy(truths.damaged)
    weight = torch.where(damaged > 0.0, 0.5 / damaged_share, 0.5 / (1.0 - damaged_share))
    loss = WEIGHTS["damage"] * nn.functional.binary_cross_entropy_with_logits(told.damage, damaged, weight=weight)
    for name, said, place in (("kind", told.kind, truths.kind), ("gear", told.gear, truths.gear)):
        known = torch.from_numpy(place)
        if (place != NOWHERE).any():
            loss = loss + WEIGHTS[name] * nn.functional.cross_entropy(said, known, ignore_index=NOWHERE)
    sized = np.isfinite(truths.size)
    if sized.any():
        missed = torch.from_numpy(truths.size[sized]).unsqueeze(1) - told.size[torch.from_numpy(sized)]
        level = torch.tensor(QUANTILES)
        loss = loss + WEIGHTS["size"] * torch.maximum(level * missed, (level - 1.0) * missed).mean()
    return loss


def tell(network: GearboxNetwork, rows: np.ndarray, batch: int = BATCH) -> Told:
    """Return what the network says of records, as means over their channels.

    Parameters
    ----------
    network : GearboxNetwork
        In evaluation mode.
    rows : (records, channels, gears, 4, steps) float16
    batch : int
        Channels at a time.
    """
    parts = list(_asked(network, rows, batch))
    means = (
        torch.cat([getattr(part, name) for part in parts]).unflatten(0, rows.shape[:2]).mean(dim=1)
        for name in ("damage", "kind", "gear", "size")
    )
    return Told(*means)


def seen_numbers(network: GearboxNetwork, rows: np.ndarray) -> np.ndarray:
    """Return what the heads rest on, (records, channels, 96) float64; parameters as of `tell`."""
    parts = [whole for _, whole in _asked(network.seen, rows, BATCH)]
    return np.asarray(torch.cat(parts).unflatten(0, rows.shape[:2]).double().numpy())


def _asked(ask: Callable[[torch.Tensor], Any], rows: np.ndarray, batch: int) -> Iterator[Any]:
    flat = rows.reshape(-1, *rows.shape[2:])
    for start in range(0, len(flat), batch):
        with torch.no_grad(), in_one_thread():
            said = ask(torch.from_numpy(flat[start : start + batch].astype(np.float32)))
        yield said


def save_gearbox_network(network: GearboxNetwork, path: Path, facts: Mapping[str, Any]) -> None:
    """Write weights, facts on the training and those that give the network back, see `weights_file`."""
    save_weights(network, path, FORMAT, {**facts, "kinds": network.kinds, "widths": network.widths})


def load_gearbox_network(path: Path) -> tuple[GearboxNetwork, dict[str, Any]]:
    """Read a network written by `save_gearbox_network`, and its facts; nothing in the file is executed.

    Raises
    ------
    UsageError
        If the file is not one.
    """
    facts = read_facts(path, FORMAT)
    try:
        network = GearboxNetwork([str(kind) for kind in facts["kinds"]], [int(width) for width in facts["widths"]])
    except (KeyError, TypeError, ValueError, RuntimeError) as error:
        raise other_schema(path, error) from error
    load_weights(network, path)
    return network, facts
