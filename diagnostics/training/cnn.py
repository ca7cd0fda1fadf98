"""A small 1-D network with a wide first layer on windows of several revolutions, after WDCNN (Zhang et al. 2017).

Differences from the source: order-resampled windows of whole revolutions instead of 2048 raw samples; mean and spread
of the last layer over the window instead of a dense layer on positions, since a window may start at any angle and
modulation shows as spread; every channel enters twice, as it is and without its mean over the mesh periods of the
window, which would hide anything a hundred times smaller; the levels of both are divided out and handed to the last
layer as numbers of their own.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import isfinite

import numpy as np
import torch
from torch import nn

from diagnostics.base.seeding import Purpose, generator
from diagnostics.loader.augmentation import Augmentation, augmented
from diagnostics.loader.windows import OrderRecords, drawn_windows, record_windows
from diagnostics.statistics.calibration import calibrated
from diagnostics.statistics.evaluation import Predictions
from diagnostics.training.splits import SpecimenSplit

FIRST_KERNEL, FIRST_STRIDE = 64, 8
WIDTHS = (16, 32, 64, 64)
JUDGING_BATCH = 256
SMALLEST_VARIANCE = 1e-6
"""Keeps the slope of a square root finite; relative to signals of unit variance."""


@dataclass(frozen=True, slots=True)
class TrainingSettings:
    """How the network is trained.

    Attributes
    ----------
    most_epochs : int
        Epochs at most; exactly as many where there are no validation specimens.
    patience : int
        Epochs without a lower validation loss before training stops.
    windows_per_epoch : int
        Windows drawn in an epoch, rounded up to the same number, three or more, from every training record.
    batch : int
        Windows per step.
    learning_rate, weight_decay : float
        Of AdamW.
    augmentation : Augmentation or None
        Random paths and noise on training windows; None shows them as they are.
    device : str
        `cpu` or `cuda`.
    """

    most_epochs: int = 100
    patience: int = 25
    windows_per_epoch: int = 512
    batch: int = 32
    learning_rate: float = 2e-3
    weight_decay: float = 0.1
    augmentation: Augmentation | None = field(default_factory=Augmentation)
    device: str = "cpu"


@dataclass(frozen=True, slots=True)
class TrainedNetwork:
    """The network at its best epoch, and how it got there.

    Attributes
    ----------
    network : WideKernelNetwork
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
        Applied to the mean probabilities of a record; 1 leaves them.
    """

    network: WideKernelNetwork
    classes: tuple[str, ...]
    best_epoch: int
    epochs: int
    validation_loss: tuple[float, ...]
    note: str
    temperature: float = 1.0


class WideKernelNetwork(nn.Module):  # type: ignore[misc]  # the type checker does not read torch
    """Windows (batch, channels, samples) in m/s^2, `samples_per_tooth` to a mesh period, to logits (batch, classes)."""

    def __init__(self, channels: int, classes: int, samples_per_tooth: int) -> None:
        super().__init__()
        self.samples_per_tooth = samples_per_tooth
        self.register_buffer("mean", torch.zeros(channels, 1))
        self.register_buffer("scale", torch.ones(channels, 1))
        padding = (FIRST_KERNEL - FIRST_STRIDE) // 2
        layers: list[nn.Module] = _block(2 * channels, WIDTHS[0], FIRST_KERNEL, FIRST_STRIDE, padding)
        for before, after in itertools.pairwise(WIDTHS):
            layers += _block(before, after, kernel=3, stride=1, padding=1)
        self.body = nn.Sequential(*layers)
        self.dropout = nn.Dropout(0.2)
        self.head = nn.Linear(2 * WIDTHS[-1] + 2 * channels, classes)

    def forward(self, windows: torch.Tensor) -> torch.Tensor:
        """Return logits."""
        scaled = (windows - self.mean) / self.scale
        periods = scaled.unflatten(2, (-1, self.samples_per_tooth))
        varying = (periods - periods.mean(dim=2, keepdim=True)).flatten(2)
        both = torch.cat([scaled, varying], dim=1)
        level = torch.sqrt((both * both).mean(dim=2, keepdim=True) + SMALLEST_VARIANCE)
        mapped = self.body(both / level)
        mean = mapped.mean(dim=2, keepdim=True)
        spread = torch.sqrt(((mapped - mean) ** 2).mean(dim=2) + SMALLEST_VARIANCE)
        pooled = self.dropout(torch.cat([mean.squeeze(2), spread], dim=1))
        return self.head(torch.cat([pooled, torch.log(level.squeeze(2))], dim=1))


def _block(before: int, after: int, kernel: int, stride: int, padding: int) -> list[nn.Module]:
    convolution = nn.Conv1d(before, after, kernel, stride=stride, padding=padding, bias=False)
    return [convolution, nn.BatchNorm1d(after), nn.ReLU(), nn.MaxPool1d(2)]


def train_network(
    records: OrderRecords,
    target: np.ndarray,
    split: SpecimenSplit,
    seed: int,
    settings: TrainingSettings | None = None,
    advance: Callable[[], None] | None = None,
) -> TrainedNetwork:
    """Train on training specimens, stop on validation specimens; the same seed gives the same weights on one machine.

    Parameters
    ----------
    records : OrderRecords
        All records of the set.
    target : (records,) int
        State of every record; the permutation control passes permuted ones.
    split : SpecimenSplit
        Whose specimens are which.
    seed : int
        Seeds weights, order and window starts.
    settings : TrainingSettings, optional
        Default: `TrainingSettings()`.
    advance : callable, optional
        Called after every epoch.
    """
    chosen = settings or TrainingSettings()
    with torch.random.fork_rng(devices=seeded_devices(chosen.device)), one_thread():
        torch.manual_seed(seed)
        network = WideKernelNetwork(len(records.channels), len(split.classes), records.settings.samples_per_tooth)
        _normalise(network, records, np.flatnonzero(split.train))
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


def _normalise(network: WideKernelNetwork, records: OrderRecords, train: np.ndarray) -> None:
    """Set mean and scale of every channel from training records alone."""
    joined = np.concatenate([records.signals[position] for position in train], axis=1).astype(np.float64)
    network.mean.copy_(torch.from_numpy(joined.mean(axis=1, keepdims=True)))
    spread = joined.std(axis=1, keepdims=True)
    network.scale.copy_(torch.from_numpy(np.where(spread > 0.0, spread, 1.0)))


def _fit(
    network: WideKernelNetwork,
    records: OrderRecords,
    target: np.ndarray,
    split: SpecimenSplit,
    seed: int,
    settings: TrainingSettings,
    advance: Callable[[], None] | None,
) -> TrainedNetwork:
    optimiser = torch.optim.AdamW(network.parameters(), lr=settings.learning_rate, weight_decay=settings.weight_decay)
    train, validation = np.flatnonzero(split.train), np.flatnonzero(split.validation)
    judged = _judged_windows(records, target, validation) if validation.size else None
    losses: list[float] = []
    best_epoch, best_weights = 0, _weights(network)
    for epoch in range(1, settings.most_epochs + 1):
        _run_epoch(network, optimiser, records, target, train, generator(seed, Purpose.WINDOWS, epoch), settings)
        if advance:
            advance()
        if judged is None:
            best_epoch, best_weights = epoch, _weights(network)
            continue
        losses.append(_loss(network, *judged))
        if losses[-1] <= min(losses):
            best_epoch, best_weights = epoch, _weights(network)
        elif epoch - best_epoch >= settings.patience:
            break
    network.load_state_dict(best_weights)
    network.to("cpu").eval()  # judged and saved there, whatever it was trained on
    note = training_note("1-D network", losses, epoch, target[train], judged[1].numpy() if judged else None)
    return TrainedNetwork(network, split.classes, best_epoch, epoch, tuple(losses), note)


def training_note(
    name: str, losses: Sequence[float], epochs: int, train: np.ndarray, validation: np.ndarray | None
) -> str:
    """Return what was not as it should be, or nothing: no specimens to stop by, or a network that has not learned.

    Parameters
    ----------
    name : str
        Of the network.
    losses : sequence of float
        Cross entropy on validation specimens by epoch.
    epochs : int
        Epochs run.
    train, validation : (k,) int
        Classes of what was trained on and of what `losses` are means over; None without validation specimens.
    """
    if validation is None:
        return f"no validation specimens: trained for {epochs} epochs without stopping"
    shares = np.bincount(train, minlength=int(validation.max()) + 1) / train.size
    guess = -float(np.log(np.maximum(shares, np.finfo(float).tiny))[validation].mean())
    best = min(losses, key=lambda loss: (not isfinite(loss), loss))
    if best < guess:
        return ""
    return (
        f"the {name} has not learned: its best validation loss is {best:.3g}, and guessing by how often each class "
        f"occurs gives {guess:.3g}; its scores mean nothing"
    )


def _run_epoch(
    network: WideKernelNetwork,
    optimiser: torch.optim.Optimizer,
    records: OrderRecords,
    target: np.ndarray,
    train: np.ndarray,
    rng: np.random.Generator,
    settings: TrainingSettings,
) -> None:
    network.train()
    per_record = max(3, -(-settings.windows_per_epoch // train.size))
    windows = drawn_windows(records, train, per_record, rng)
    if settings.augmentation:
        windows = augmented(windows, settings.augmentation, rng)
    labels = np.repeat(target[train], per_record)
    order = rng.permutation(labels.size)
    for start in range(0, labels.size, settings.batch):
        batch = order[start : start + settings.batch]
        if batch.size < 2 and labels.size > 1:  # batch normalisation is undefined on a single window
            continue
        optimiser.zero_grad()
        logits = network(torch.from_numpy(windows[batch]).to(settings.device))
        truth = torch.from_numpy(labels[batch]).to(settings.device)
        nn.functional.cross_entropy(logits, truth).backward()
        optimiser.step()


def _weights(network: WideKernelNetwork) -> dict[str, torch.Tensor]:
    return {name: value.detach().clone() for name, value in network.state_dict().items()}


def _judged_windows(records: OrderRecords, target: np.ndarray, chosen: np.ndarray) -> tuple[torch.Tensor, torch.Tensor]:
    windows = [record_windows(records, position) for position in chosen]
    labels = np.concatenate(
        [np.full(len(found), target[position]) for found, position in zip(windows, chosen, strict=True)]
    )
    return torch.from_numpy(np.concatenate(windows)), torch.from_numpy(labels)


def _loss(network: WideKernelNetwork, windows: torch.Tensor, labels: torch.Tensor) -> float:
    return float(nn.functional.cross_entropy(_logits(network, windows), labels))


def _logits(network: WideKernelNetwork, windows: torch.Tensor) -> torch.Tensor:
    network.eval()
    with torch.no_grad():
        device = network.mean.device
        return torch.cat([network(part.to(device)).cpu() for part in windows.split(JUDGING_BATCH)])


def network_predictions(
    trained: TrainedNetwork, records: OrderRecords, chosen: np.ndarray, target: np.ndarray, specimen: np.ndarray
) -> Predictions:
    """Return one vote per record: the mean of its windows' class probabilities, at the network's temperature.

    Parameters
    ----------
    trained : TrainedNetwork
        The network to judge.
    records : OrderRecords
        All records of the set.
    chosen : (k,) int
        Positions of the records to predict.
    target, specimen : (records,) int
        True state and specimen of every record of the set.
    """
    votes = []
    for position in chosen:
        logits = _logits(trained.network, torch.from_numpy(record_windows(records, position)))
        votes.append(torch.softmax(logits.double(), dim=1).mean(dim=0).numpy())
    probability = np.stack(votes) if votes else np.empty((0, len(trained.classes)))
    return calibrated(Predictions(trained.classes, target[chosen], probability, specimen[chosen]), trained.temperature)
