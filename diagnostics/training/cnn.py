"""A small network on synchronous averages: convolutions round the shaft, which has neither beginning nor end.

An average is periodic, so every convolution is padded with the other end of the revolution, and mean, spread and
largest value over the angle pool it: which tooth is damaged does not matter. Every row is divided by its level, and the
levels go to the last layer as logarithms. Source: derived; convolutional networks are standard literature.

On disk it is a safetensors file, which cannot execute anything; classes, channels, identity of the set and temperature
stand in its metadata.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

import numpy as np
import torch
from torch import nn

from diagnostics.base.seeding import Purpose, generator
from diagnostics.training.average_rows import ROWS, AveragedRecords, average_rows, moved
from diagnostics.training.loop import LoopSettings, fit_network, seeded
from diagnostics.training.splits import SpecimenSplit
from diagnostics.training.weights_file import load_weights, other_schema, read_facts, save_weights
from siggen.errors import UsageError

FORMAT = "siggen-diagnostics network on averages 1"

LAYERS = ((16, 31, 4), (24, 7, 1), (32, 5, 1))
"""Width, kernel and stride of the convolutions; all but the last are followed by a maximum over two steps."""

SMALLEST_LEVEL = 1e-12
"""Keeps the logarithm finite where a row is empty [m/s²]."""


@dataclass(frozen=True, slots=True)
class NetworkSettings:
    """How the network is trained.

    Attributes
    ----------
    most_epochs : int
        Epochs at most; exactly as many where there are no validation specimens.
    patience : int
        Epochs without a lower validation loss before training stops.
    batch : int
        Records per step.
    learning_rate, weight_decay : float
        Of AdamW.
    gain_db : float
        How far paths are changed for training, see `moved`; 0 leaves them.
    device : str
        `cpu` or `cuda`.
    """

    most_epochs: int = 80
    patience: int = 20
    batch: int = 32
    learning_rate: float = 2e-3
    weight_decay: float = 0.1
    gain_db: float = 2.0
    device: str = "cpu"


@dataclass(frozen=True, slots=True)
class TrainedNetwork:
    """The network at its best epoch, what it takes, and how it got there.

    Attributes
    ----------
    network : CircularNetwork
        In evaluation mode.
    classes, channels : tuple of str
        States in the order of the outputs; channels in the order of the rows, see `average_rows`.
    best_epoch, epochs : int
        Epoch whose weights were kept, and epochs run; 0 of one that was read.
    validation_loss : tuple of float
        Cross entropy by epoch; empty without validation specimens.
    note : str
        What was not as it should be, or empty.
    temperature : float
        Applied to the probabilities of a record, or to the mean over a recording's pieces; 1 leaves them.
    identity : str
        Identity of the set it was trained on.
    """

    network: CircularNetwork
    classes: tuple[str, ...]
    channels: tuple[str, ...]
    best_epoch: int = 0
    epochs: int = 0
    validation_loss: tuple[float, ...] = ()
    note: str = ""
    temperature: float = 1.0
    identity: str = ""


class CircularConvolution(nn.Module):  # type: ignore[misc]  # the type checker does not read torch
    """A convolution, normalised and rectified, over a signal whose ends meet."""

    def __init__(self, before: int, after: int, kernel: int, stride: int) -> None:
        super().__init__()
        self.beside = (kernel - 1) // 2
        self.convolution = nn.Conv1d(before, after, kernel, stride=stride, bias=False)
        self.normal = nn.BatchNorm1d(after)

    def forward(self, signal: torch.Tensor) -> torch.Tensor:
        """Return the mapped signal, shorter by the stride."""
        closed = torch.cat([signal[:, :, -self.beside :], signal, signal[:, :, : self.beside]], dim=2)
        return nn.functional.relu(self.normal(self.convolution(closed)))


class CircularNetwork(nn.Module):  # type: ignore[misc]
    """Rows (batch, rows, steps) of one revolution, see `average_rows`, to logits (batch, classes)."""

    def __init__(self, rows: int, classes: int) -> None:
        super().__init__()
        self.register_buffer("level_mean", torch.zeros(rows))
        self.register_buffer("level_scale", torch.ones(rows))
        layers: list[nn.Module] = []
        before = rows
        for width, kernel, stride in LAYERS:
            layers += [CircularConvolution(before, width, kernel, stride), nn.MaxPool1d(2)]
            before = width
        self.body = nn.Sequential(*layers[:-1])
        self.dropout = nn.Dropout(0.3)
        self.head = nn.Linear(3 * before + rows, classes)

    def forward(self, rows: torch.Tensor) -> torch.Tensor:
        """Return logits."""
        level = torch.sqrt((rows * rows).mean(dim=2)) + SMALLEST_LEVEL
        mapped = self.body(rows / level.unsqueeze(2))
        mean = mapped.mean(dim=2)
        spread = torch.sqrt(((mapped - mean.unsqueeze(2)) ** 2).mean(dim=2) + 1e-6)
        pooled = self.dropout(torch.cat([mean, spread, mapped.amax(dim=2)], dim=1))
        return self.head(torch.cat([pooled, (torch.log(level) - self.level_mean) / self.level_scale], dim=1))


def train_network(
    records: AveragedRecords,
    target: np.ndarray,
    split: SpecimenSplit,
    seed: int,
    settings: NetworkSettings | None = None,
    advance: Callable[[], None] | None = None,
) -> TrainedNetwork:
    """Train on training specimens, stop on validation specimens; the same seed gives the same weights on one machine.

    Parameters
    ----------
    records : AveragedRecords
        All records of the set, alone or beside their references.
    target : (records,) int
        Class of every record; the permutation control passes permuted ones.
    split : SpecimenSplit
        Whose specimens are which.
    seed : int
        Seeds weights, order and changed paths.
    settings : NetworkSettings, optional
        Default: `NetworkSettings()`.
    advance : callable, optional
        Called after every epoch.
    """
    chosen = settings or NetworkSettings()
    learn, validation = np.flatnonzero(split.train), np.flatnonzero(split.validation)
    with seeded(seed, chosen.device):
        network = CircularNetwork(records.rows, len(split.classes))
        _set_levels(network, records.chosen(learn))
        network.to(chosen.device)

        def batches(epoch: int) -> Iterator[torch.Tensor]:
            rng = generator(seed, Purpose.AVERAGES, epoch)
            order = rng.permutation(learn)
            for start in range(0, order.size, chosen.batch):
                batch = order[start : start + chosen.batch]
                if batch.size > 1 or order.size == 1:  # batch normalisation is undefined on a single record
                    rows = torch.from_numpy(average_rows(moved(records.chosen(batch), rng, chosen.gain_db)))
                    said, truth = network(rows.to(chosen.device)), torch.from_numpy(target[batch]).to(chosen.device)
                    yield nn.functional.cross_entropy(said, truth)

        seen = torch.from_numpy(average_rows(records.chosen(validation))) if validation.size else None
        truth = torch.from_numpy(target[validation])
        best, epochs, losses = fit_network(
            network,
            batches,
            None if seen is None else lambda: float(nn.functional.cross_entropy(_logits(network, seen), truth)),
            LoopSettings(chosen.most_epochs, chosen.learning_rate, chosen.weight_decay, chosen.patience),
            advance,
        )
    network.to("cpu")
    note = _training_note(losses, epochs, target[learn], target[validation] if validation.size else None)
    return TrainedNetwork(network, split.classes, records.channels, best, epochs, losses, note)


def _set_levels(network: CircularNetwork, train: AveragedRecords) -> None:
    """Set mean and spread of the log levels from training records alone."""
    levels = np.log(np.sqrt(np.square(average_rows(train), dtype=np.float64).mean(axis=2)) + SMALLEST_LEVEL)
    network.level_mean.copy_(torch.from_numpy(levels.mean(axis=0)))
    network.level_scale.copy_(torch.from_numpy(np.maximum(levels.std(axis=0), 1e-3)))


def _training_note(losses: Sequence[float], epochs: int, train: np.ndarray, validation: np.ndarray | None) -> str:
    """Return what was not as it should be, or nothing: no specimens to stop by, or a network that has not learned."""
    if validation is None:
        return f"no validation specimens: trained for {epochs} epochs without stopping"
    shares = np.bincount(train, minlength=int(validation.max()) + 1) / train.size
    guess = -float(np.log(np.maximum(shares, np.finfo(float).tiny))[validation].mean())
    best = min(losses, key=lambda loss: (not isfinite(loss), loss))
    if best < guess:
        return ""
    return (
        f"the 1-D network has not learned: its best validation loss is {best:.3g}, and guessing by how often each "
        f"class occurs gives {guess:.3g}; its scores mean nothing"
    )


def _logits(network: CircularNetwork, rows: torch.Tensor) -> torch.Tensor:
    with torch.no_grad():
        return network(rows.to(network.level_mean.device)).float().cpu()


def network_probability(network: CircularNetwork, records: AveragedRecords) -> np.ndarray:
    """Return the uncalibrated probability of every class, (records, classes) float64."""
    if not records.teeth.size:
        return np.empty((0, network.head.out_features))
    rows = torch.from_numpy(average_rows(records))
    return np.asarray(torch.softmax(_logits(network, rows).double(), dim=1).numpy())


def save_network(trained: TrainedNetwork, path: Path) -> None:
    """Write weights and facts, see `diagnostics.training.weights_file`."""
    facts = {name: getattr(trained, name) for name in ("classes", "channels", "identity", "temperature")}
    save_weights(trained.network, path, FORMAT, facts)


def load_network(path: Path) -> TrainedNetwork:
    """Read a network written by `save_network`; nothing in the file is executed.

    Raises
    ------
    UsageError
        If the file is not one.
    """
    facts = read_facts(path, FORMAT)
    try:
        classes, channels, temperature = tuple(facts["classes"]), tuple(facts["channels"]), float(facts["temperature"])
        network = CircularNetwork(ROWS * len(channels), len(classes))
        identity = str(facts["identity"])
    except (KeyError, TypeError, ValueError, RuntimeError) as error:
        raise other_schema(path, error) from error
    load_weights(network, path)
    if not (isfinite(temperature) and temperature > 0.0):
        raise UsageError(f"{path}: received temperature {temperature}; allowed: finite and above 0; train again")
    return TrainedNetwork(network, classes, channels, temperature=temperature, identity=identity)
