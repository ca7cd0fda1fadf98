"""A residual network that asks every gear of a gearbox alike, with and without a healthy record of the same gearbox.

Turns of all gears go through the same convolutions round the shaft; largest value and mean over the angle pool them,
then largest value and mean over the gears. So teeth and number of gears do not matter, nor which tooth is damaged. Four
heads: whether there is damage, which kind it is, which gear has it, and its size with an interval.

This is the network that answers. It needs no PyTorch: whoever only asks it need not install, or load, 2 GB.
`diagnostics.training.gearbox_learner` is the one that learns.

Source: residual networks (He et al. 2016), quantiles by the pinball loss (Koenker and Bassett 1978), their interval
widened on gearboxes left out (Romano et al. 2019); the rest derived.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.base.single_thread import single_blas_thread
from diagnostics.training.gear_rows import ALONE, ROWS
from diagnostics.training.likeness import NUMBERS, distances, farthest
from diagnostics.training.weights_file import load_arrays, other_schema, read_facts, save_arrays

FORMAT = "siggen-diagnostics network on gears 3"

WIDTHS = (24, 32, 48)
"""Channels of the stages; a maximum over two steps stands between them."""
FIRST, KERNEL, STRIDE = 15, 5, 2
"""Steps of the first kernel and of all others, and the stride of the first."""
TOLD = 48
"""Numbers that tell of a gear."""
QUANTILES = (0.05, 0.5, 0.95)
"""Of the size: an interval of 90 %."""
LEVELS = 401
"""Quantiles that are kept of what was said of unseen records."""
GEARS = ("pinion", "gear")
"""Whose averages a record has, in order of power."""
SAID = 0.99
"""Share of unseen sound records of which damage is not said."""
BATCH = 32
"""Channels of records that are asked at a time: some 30 MB."""
SMALL = 0.01
"""Added to the size of a change before its logarithm: over its noise it is about 1 where nothing has changed."""


@dataclass(frozen=True, slots=True)
class Told:
    """What the network says of records; tensors while it learns.

    Attributes
    ----------
    damage : (records,)
        Log odds.
    kind : (records, kinds)
        Logits of the kind, if there is damage.
    gear : (records, gears)
        Logits of the gear, if one has it.
    size : (records, 3)
        Quantiles of the logarithm of the damaged share of the worst flank, ascending.
    """

    damage: Any
    kind: Any
    gear: Any
    size: Any


@dataclass(slots=True)
class Limits:
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

    average_centre: np.ndarray
    average_spread: np.ndarray
    average_precision: np.ndarray
    seen_centre: np.ndarray
    seen_precision: np.ndarray
    farthest: np.ndarray
    sound: np.ndarray
    damaged: np.ndarray

    @classmethod
    def unset(cls) -> Limits:
        """Return zeros."""
        numbers, seen = len(GEARS) * NUMBERS, 2 * TOLD
        shapes = (
            (numbers,), (numbers,), (numbers, numbers), (2, seen), (2, seen, seen), (2, 3), (2, LEVELS), (2, LEVELS),
        )  # fmt: skip
        return cls(*map(np.zeros, shapes))

    def distances(self, averages: np.ndarray, seen: np.ndarray, side: int) -> np.ndarray:
        """Return all distances of records, (records, 3), each of the channel that lies farthest.

        Parameters
        ----------
        averages : (records, channels, 28) float64
            See `average_numbers`.
        seen : (records, channels, 96) float64
            See `GearboxNetwork.seen`.
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
        return float(np.quantile(self.sound[side], share))


class GearboxNetwork:
    """Rows (records, channels, gears, 4, steps) float16, see `gear_rows`, to what is told of records.

    Parameters
    ----------
    kinds : sequence of str
        Kinds of damage that it can name.
    widths : sequence of int
        Channels of the stages.
    weights : mapping of str to float32 arrays
        Kernels of `stages.N.opening`, `.first`, `.second`, into which the normalisation of a batch has gone, and of
        `of_gear`, `damage`, `kind`, `gear`, `size`: each with `.weight` and `.bias`. `size_centre` has centre and
        spread of the logarithm of sizes.

    Attributes
    ----------
    size_widening : (2,) float32
        By which intervals are widened at either end, alone and beside.
    limits : Limits
    """

    def __init__(self, kinds: Sequence[str], widths: Sequence[int], weights: Mapping[str, np.ndarray]) -> None:
        self.kinds, self.widths, self.weights = tuple(kinds), tuple(widths), dict(weights)
        self.size_widening, self.limits = np.zeros(2, dtype=np.float32), Limits.unset()

    def tell(self, rows: np.ndarray) -> Told:
        """Return what is told, means over channels; a channel whose rows of change are zero stands alone."""
        each, whole, beside = self._asked(rows)
        said = self._dense("damage", whole)[..., 0], self._dense("kind", whole), self._dense("gear", each)[..., 0]
        return Told(*(part.mean(axis=1) for part in (*said, self._quantiles(whole, beside))))

    def seen(self, rows: np.ndarray) -> np.ndarray:
        """Return what all heads rest on, (records, channels, 96) float64."""
        return self._asked(rows)[1].astype(np.float64)

    def _asked(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return numbers of gears (records, channels, gears, 48) and of gearboxes (..., 96), and what stands beside."""
        flat = rows.reshape(-1, *rows.shape[2:])
        with single_blas_thread():
            parts = [self._pooled(flat[start : start + BATCH]) for start in range(0, len(flat), BATCH)]
        each, beside = (np.concatenate(part) for part in zip(*parts, strict=True))
        each = each.reshape(*rows.shape[:3], TOLD)
        return each, np.concatenate([each.max(axis=2), each.mean(axis=2)], axis=2), beside.reshape(rows.shape[:2])

    def _pooled(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the numbers of gears (n, gears, 48) of channels (n, gears, 4, steps), and which (n,) stand beside."""
        flat = rows.reshape(-1, *rows.shape[2:]).astype(np.float32)
        size = np.sqrt(np.square(flat[:, ALONE:]).mean(axis=2))
        beside = (size > 0.0).any(axis=1, keepdims=True).astype(np.float32)
        mapped = flat
        for stage in range(len(self.widths)):
            name = f"stages.{stage}"
            mapped = _halved(mapped) if stage else mapped
            mapped = np.maximum(self._circular(f"{name}.opening", mapped, 1 if stage else STRIDE), 0.0)
            inner = np.maximum(self._circular(f"{name}.first", mapped), 0.0)
            mapped = np.maximum(mapped + self._circular(f"{name}.second", inner), 0.0)
        pooled = np.concatenate(
            [mapped.mean(axis=2), mapped.max(axis=2), beside * np.log(size + np.float32(SMALL)), beside], axis=1
        )
        each = np.maximum(self._dense("of_gear", pooled), 0.0)
        return each.reshape(*rows.shape[:2], TOLD), (rows[:, :, ALONE:] != 0.0).any(axis=(1, 2, 3))

    def _circular(self, name: str, signal: np.ndarray, stride: int = 1) -> np.ndarray:
        """Return the convolution of signals (n, before, steps) whose ends meet, (n, after, steps / stride)."""
        kernels = self.weights[f"{name}.weight"]
        after, before, steps = kernels.shape
        ends = steps // 2
        round_shaft = np.concatenate([signal[..., -ends:], signal, signal[..., :ends]], axis=2)
        windows = np.lib.stride_tricks.sliding_window_view(round_shaft, steps, axis=2)[:, :, ::stride]
        columns = windows.transpose(0, 1, 3, 2).reshape(len(signal), before * steps, -1)
        return np.asarray(kernels.reshape(after, -1) @ columns + self.weights[f"{name}.bias"][:, None])

    def _dense(self, name: str, values: np.ndarray) -> np.ndarray:
        return np.asarray(values @ self.weights[f"{name}.weight"].T + self.weights[f"{name}.bias"])

    def _quantiles(self, whole: np.ndarray, beside: np.ndarray) -> np.ndarray:
        centre, spread = self.weights["size_centre"]
        middle, below, above = np.moveaxis(self._dense("size", whole), -1, 0)
        middle, widening = centre + spread * middle, self.size_widening[beside.astype(np.int64)]
        low, high = middle - spread * np.logaddexp(0.0, below), middle + spread * np.logaddexp(0.0, above)
        return np.stack([low - widening, middle, high + widening], axis=-1)


def _halved(signal: np.ndarray) -> np.ndarray:
    """Return the larger of every two steps."""
    return np.asarray(np.maximum(signal[..., ::2], signal[..., 1::2]))


def shapes(kinds: int, widths: Sequence[int]) -> dict[str, tuple[int, ...]]:
    """Return the shapes of all weights of a network."""
    found: dict[str, tuple[int, ...]] = {"size_centre": (2,)}

    def layer(name: str, *shape: int) -> None:
        found.update({f"{name}.weight": shape, f"{name}.bias": shape[:1]})

    before = ROWS
    for stage, width in enumerate(widths):
        layer(f"stages.{stage}.opening", width, before, KERNEL if stage else FIRST)
        layer(f"stages.{stage}.first", width, width, KERNEL)
        layer(f"stages.{stage}.second", width, width, KERNEL)
        before = width
    layer("of_gear", TOLD, 2 * before + 1 + ROWS - ALONE)
    layer("damage", 1, 2 * TOLD)
    layer("kind", kinds, 2 * TOLD)
    layer("gear", 1, TOLD)
    layer("size", len(QUANTILES), 2 * TOLD)
    return found


def save_gearbox_network(network: GearboxNetwork, path: Path, facts: Mapping[str, Any]) -> None:
    """Write weights, limits, facts on the training and those that give the network back, see `weights_file`."""
    limits = {f"limits.{one.name}": getattr(network.limits, one.name) for one in fields(Limits)}
    arrays = {**network.weights, "size_widening": network.size_widening, **limits}
    save_arrays(arrays, path, FORMAT, {**facts, "kinds": network.kinds, "widths": network.widths})


def load_gearbox_network(path: Path) -> tuple[GearboxNetwork, dict[str, Any]]:
    """Read a network written by `save_gearbox_network`, and its facts; nothing in the file is executed.

    Raises
    ------
    UsageError
        If the file is not one.
    """
    facts, arrays = read_facts(path, FORMAT), load_arrays(path)
    try:
        kinds, widths = [str(kind) for kind in facts["kinds"]], [int(width) for width in facts["widths"]]
        limits = Limits(*(arrays.pop(f"limits.{one.name}") for one in fields(Limits)))
        widening = arrays.pop("size_widening")
        held, wanted = {name: array.shape for name, array in arrays.items()}, shapes(len(kinds), widths)
        held |= {one.name: getattr(limits, one.name).shape for one in fields(Limits)} | {"widening": widening.shape}
        wanted |= {one.name: getattr(Limits.unset(), one.name).shape for one in fields(Limits)} | {"widening": (2,)}
        if held != wanted:
            names = sorted(name for name in held | wanted if held.get(name) != wanted.get(name))
            raise ValueError(f"shape of {names[0]}")
    except (KeyError, TypeError, ValueError) as error:
        raise other_schema(path, error) from error
    network = GearboxNetwork(kinds, widths, arrays)
    network.limits, network.size_widening = limits, widening
    return network, facts
