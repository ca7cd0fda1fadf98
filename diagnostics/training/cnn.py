"""A small network on synchronous averages: convolutions round the shaft, which has neither beginning nor end.

An average is periodic, so every convolution is padded with the other end of the revolution, and mean, spread and
largest value over the angle pool it: which tooth is damaged does not matter. Every row is divided by its level, and the
levels go to the last layer as logarithms. Source: derived; convolutional networks are standard literature.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from math import isfinite

import numpy as np
import torch
from torch import nn

from diagnostics.base.seeding import Purpose, generator
from diagnostics.statistics.calibration import calibrated
from diagnostics.statistics.evaluation import Predictions
from diagnostics.training.average_rows import AveragedRecords, average_rows, moved
from diagnostics.training.splits import SpecimenSplit

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
    """The network at its best epoch, and how it got there.

    Attributes
    ----------
    network : CircularNetwork
        In evaluation mode.
    classes : tuple of str
        States in the order of the outputs.
    best_epoch, epochs : int
        Epoch whose weights were kept, and epochs run.
    validation_loss : tuple of float
        Cross entropy by epoch; empty without validation specimens.
    note : str
        What was not as it should be, or empty.
    temperature : float
        Applied to the probabilities of a record; 1 leaves them.
    """

    network: CircularNetwork
    classes: tuple[str, ...]
    best_epoch: int
    epochs: int
    validation_loss: tuple[float, ...]
    note: str
    temperature: float = 1.0


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
    with torch.random.fork_rng(devices=seeded_devices(chosen.device)), one_thread():
        torch.manual_seed(seed)
        network = CircularNetwork(records.rows, len(split.classes))
        _set_levels(network, records.chosen(np.flatnonzero(split.train)))
        network.to(chosen.device)
        return _fit(network, records, target, split, seed, chosen, advance)


def seeded_devices(device: str) -> list[int]:
    """Return the devices whose generators are seeded here and given back as they were, besides the CPU's."""
    return [torch.cuda.current_device()] if torch.device(device).type == "cuda" else []


@contextmanager
def one_thread() -> Iterator[None]:
    """Sum in one order whatever the number of cores; small layers gain nothing from more threads anyway."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def _set_levels(network: CircularNetwork, train: AveragedRecords) -> None:
    """Set mean and spread of the log levels from training records alone."""
    levels = np.log(np.sqrt(np.square(average_rows(train), dtype=np.float64).mean(axis=2)) + SMALLEST_LEVEL)
    network.level_mean.copy_(torch.from_numpy(levels.mean(axis=0)))
    network.level_scale.copy_(torch.from_numpy(np.maximum(levels.std(axis=0), 1e-3)))


def _fit(
    network: CircularNetwork,
    records: AveragedRecords,
    target: np.ndarray,
    split: SpecimenSplit,
    seed: int,
    settings: NetworkSettings,
    advance: Callable[[], None] | None,
) -> TrainedNetwork:
    optimiser = torch.optim.AdamW(network.parameters(), lr=settings.learning_rate, weight_decay=settings.weight_decay)
    train, validation = np.flatnonzero(split.train), np.flatnonzero(split.validation)
    judged = torch.from_numpy(average_rows(records.chosen(validation))) if validation.size else None
    losses: list[float] = []
    best_epoch, best_weights = 0, _weights(network)
    for epoch in range(1, settings.most_epochs + 1):
        _run_epoch(network, optimiser, records, target, train, generator(seed, Purpose.AVERAGES, epoch), settings)
        if advance:
            advance()
        if judged is not None:
            truth = torch.from_numpy(target[validation])
            losses.append(float(nn.functional.cross_entropy(_logits(network, judged), truth)))
        if judged is None or losses[-1] <= min(losses):
            best_epoch, best_weights = epoch, _weights(network)
        elif epoch - best_epoch >= settings.patience:
            break
    network.load_state_dict(best_weights)
    network.to("cpu").eval()
    note = _training_note(losses, epoch, target[train], target[validation] if validation.size else None)
    return TrainedNetwork(network, split.classes, best_epoch, epoch, tuple(losses), note)


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


def _run_epoch(
    network: CircularNetwork,
    optimiser: torch.optim.Optimizer,
    records: AveragedRecords,
    target: np.ndarray,
    train: np.ndarray,
    rng: np.random.Generator,
    settings: NetworkSettings,
) -> None:
    network.train()
    order = rng.permutation(train)
    for start in range(0, order.size, settings.batch):
        batch = order[start : start + settings.batch]
        if batch.size < 2 and order.size > 1:  # batch normalisation is undefined on a single record
            continue
        rows = average_rows(moved(records.chosen(batch), rng, settings.gain_db))
        optimiser.zero_grad()
        logits = network(torch.from_numpy(rows).to(settings.device))
        nn.functional.cross_entropy(logits, torch.from_numpy(target[batch]).to(settings.device)).backward()
        optimiser.step()


def _weights(network: CircularNetwork) -> dict[str, torch.Tensor]:
    return {name: value.detach().clone() for name, value in network.state_dict().items()}


def _logits(network: CircularNetwork, rows: torch.Tensor) -> torch.Tensor:
    network.eval()
    with torch.no_grad():
        return network(rows.to(network.level_mean.device)).float().cpu()


def network_probability(network: CircularNetwork, records: AveragedRecords) -> np.ndarray:
    """Return the uncalibrated probability of every class, (records, classes) float64."""
    if not records.teeth.size:
        return np.empty((0, network.head.out_features))
    rows = torch.from_numpy(average_rows(records))
    return np.asarray(torch.softmax(_logits(network, rows).double(), dim=1).numpy())


def network_predictions(
    trained: TrainedNetwork, records: AveragedRecords, chosen: np.ndarray, target: np.ndarray, specimen: np.ndarray
) -> Predictions:
    """Return the probabilities of some records at the network's temperature.

    Parameters
    ----------
    trained : TrainedNetwork
        The network to judge.
    records : AveragedRecords
        All records of the set.
    chosen : (k,) int
        Positions of the records to predict.
    target, specimen : (records,) int
        True state and specimen of every record of the set.
    """
    probability = network_probability(trained.network, records.chosen(chosen))
    return calibrated(Predictions(trained.classes, target[chosen], probability, specimen[chosen]), trained.temperature)
