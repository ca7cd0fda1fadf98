"""The network on gears as it learns, in PyTorch: `learnt` gives the `GearboxNetwork` that answers.

While it learns, healthy records are taken away at random, so that one set of weights answers alone and beside.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import nn

from diagnostics.training.gear_rows import ALONE, ROWS
from diagnostics.training.gearbox_network import FIRST, KERNEL, QUANTILES, SMALL, STRIDE, TOLD, GearboxNetwork, Told

DROPPED = 0.3
"""Share of what goes into the numbers of a gear that is dropped while learning."""
NOWHERE = -1
"""Gear or kind of a record without damage, or with damage in several gears."""
WEIGHTS = {"damage": 1.0, "kind": 0.3, "gear": 0.3, "size": 0.3}
"""Shares of the heads in the loss: damage is what all others rest on."""


class GearboxStage(nn.Module):  # type: ignore[misc]  # the type checker does not read torch
    """A convolution round the shaft, and two more that are added to what it gives."""

    def __init__(self, before: int, width: int, kernel: int, stride: int) -> None:
        super().__init__()
        self.opening, self.opened = _circular(before, width, kernel, stride), nn.BatchNorm1d(width)
        self.first, self.second = (_circular(width, width, KERNEL) for _ in range(2))
        self.normal, self.last = (nn.BatchNorm1d(width) for _ in range(2))

    def forward(self, signal: torch.Tensor) -> torch.Tensor:
        """Return (n, width, steps / stride)."""
        mapped = nn.functional.relu(self.opened(self.opening(signal)))
        inner = nn.functional.relu(self.normal(self.first(mapped)))
        return nn.functional.relu(mapped + self.last(self.second(inner)))


def _circular(before: int, after: int, kernel: int, stride: int = 1) -> nn.Conv1d:
    beside = kernel // 2
    return nn.Conv1d(before, after, kernel, stride, padding=beside, padding_mode="circular", bias=False)


class GearboxLearner(nn.Module):  # type: ignore[misc]
    """Rows (records, gears, 4, steps) of one channel, see `gear_rows`, to what is told of it.

    Parameters
    ----------
    kinds : sequence of str
        Kinds of damage that it can name.
    widths : sequence of int
        Channels of the stages.
    size_centre : (float, float)
        Centre and spread of the logarithm of sizes.
    """

    def __init__(self, kinds: Sequence[str], widths: Sequence[int], size_centre: tuple[float, float]) -> None:
        super().__init__()
        self.kinds, self.widths, self.size_centre = tuple(kinds), tuple(widths), size_centre
        before = (ROWS, *widths[:-1])
        self.stages = nn.ModuleList(
            GearboxStage(before[stage], width, KERNEL if stage else FIRST, 1 if stage else STRIDE)
            for stage, width in enumerate(widths)
        )
        self.dropout = nn.Dropout(DROPPED)
        self.of_gear = nn.Linear(2 * widths[-1] + 1 + ROWS - ALONE, TOLD)
        self.damage, self.kind = nn.Linear(2 * TOLD, 1), nn.Linear(2 * TOLD, len(self.kinds))
        self.gear, self.size = nn.Linear(TOLD, 1), nn.Linear(2 * TOLD, len(QUANTILES))

    def forward(self, rows: torch.Tensor) -> Told:
        """Return what is told; a record whose rows of change are zero stands alone."""
        records, gears = rows.shape[:2]
        mapped = rows.flatten(0, 1)
        size = torch.sqrt((mapped[:, ALONE:] ** 2).mean(dim=2))
        beside = (size > 0.0).any(dim=1, keepdim=True).to(rows.dtype)
        for stage, layer in enumerate(self.stages):
            mapped = layer(nn.functional.max_pool1d(mapped, 2) if stage else mapped)
        pooled = self.dropout(torch.cat([mapped.mean(dim=2), mapped.amax(dim=2)], dim=1))
        each = self.of_gear(torch.cat([pooled, beside * torch.log(size + SMALL), beside], dim=1))
        each = nn.functional.relu(each).unflatten(0, (records, gears))
        whole = torch.cat([each.amax(dim=1), each.mean(dim=1)], dim=1)
        middle, below, above = self.size(whole).T
        (centre, spread), softplus = self.size_centre, nn.functional.softplus
        middle = centre + spread * middle
        size = torch.stack([middle - spread * softplus(below), middle, middle + spread * softplus(above)], dim=1)
        return Told(self.damage(whole)[:, 0], self.kind(whole), self.gear(each)[..., 0], size)


def learnt(learner: GearboxLearner) -> GearboxNetwork:
    """Return the network that answers, without limits: normalisations of batches go into the kernels before them."""
    weights = {"size_centre": np.array(learner.size_centre, dtype=np.float32)}
    with torch.no_grad():
        for stage, layer in enumerate(learner.stages):
            for name, normal in (("opening", layer.opened), ("first", layer.normal), ("second", layer.last)):
                scale = normal.weight / torch.sqrt(normal.running_var + normal.eps)
                kernels = getattr(layer, name).weight * scale[:, None, None]
                weights[f"stages.{stage}.{name}.weight"] = kernels.numpy().copy()
                weights[f"stages.{stage}.{name}.bias"] = (normal.bias - normal.running_mean * scale).numpy().copy()
        for name in ("of_gear", "damage", "kind", "gear", "size"):
            for part in ("weight", "bias"):
                weights[f"{name}.{part}"] = getattr(getattr(learner, name), part).numpy().copy()
    return GearboxNetwork(learner.kinds, learner.widths, weights)


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
