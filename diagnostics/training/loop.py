"""One training loop for every network: losses of batches in, the weights of the best moment out."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import inf

import torch
from torch import nn
from torch.optim.adamw import adamw


@dataclass(frozen=True, slots=True)
class LoopSettings:
    """How long to train, and how fast.

    Attributes
    ----------
    most : int
        Rounds of batches at most.
    rate, decay : float
        Of AdamW.
    patience : int
        Rounds without a gain before training stops; 0: never.
    every : int
        Rounds from one look at the loss to the next.
    from_start : bool
        Whether the untrained network counts; then only a lower loss is a gain, else an equal one too.
    """

    most: int
    rate: float
    decay: float
    patience: int = 0
    every: int = 1
    from_start: bool = False


def fit_network(
    network: nn.Module,
    batches: Callable[[int], Iterable[torch.Tensor]],
    judged: Callable[[], float] | None,
    loop: LoopSettings,
    advance: Callable[[], None] | None = None,
) -> tuple[int, int, tuple[float, ...]]:
    """Train a network in place; return the round whose weights it has, the rounds run, and what `judged` said.

    Parameters
    ----------
    network : nn.Module
        In evaluation mode afterwards.
    batches : callable
        Number of a round, from 1; gives the loss of each of its batches.
    judged : callable, optional
        Loss by which the best moment is chosen; without it that is the last one.
    loop : LoopSettings
    advance : callable, optional
        Called after every round.
    """
    step = _adamw(list(network.parameters()), loop)
    kept, best, lowest, losses = _weights(network), 0, inf, list[float]()
    for done in range(loop.most + 1):
        if done:
            network.train()
            for loss in batches(done):
                network.zero_grad()
                loss.backward()
                step()
            if advance:
                advance()
        if done % loop.every or not (done or loop.from_start):
            continue
        network.eval()
        if judged is not None:
            with torch.no_grad():
                losses.append(judged())
        if judged is None or losses[-1] < lowest or (losses[-1] == lowest and not loop.from_start):
            kept, best, lowest = _weights(network), done, losses[-1] if losses else inf
        elif loop.patience and done - best >= loop.patience:
            break
    network.load_state_dict(kept)
    network.eval()
    return best, done, tuple(losses)


def _adamw(weights: list[nn.Parameter], loop: LoopSettings) -> Callable[[], None]:
    """Return a step of AdamW. The class `torch.optim.AdamW` takes the same, but loads a compiler first: 1 s of CPU."""
    means, squares = ([torch.zeros_like(weight) for weight in weights] for _ in range(2))
    counts = [torch.tensor(0.0) for _ in weights]
    law = {"lr": loop.rate, "weight_decay": loop.decay, "beta1": 0.9, "beta2": 0.999, "eps": 1e-8}

    def step() -> None:
        slopes = [weight.grad for weight in weights]
        with torch.no_grad():
            adamw(weights, slopes, means, squares, [], counts, amsgrad=False, maximize=False, **law)

    return step


def _weights(network: nn.Module) -> dict[str, torch.Tensor]:
    return {name: value.detach().clone() for name, value in network.state_dict().items()}


@contextmanager
def seeded(seed: int, device: str = "cpu") -> Iterator[None]:
    """Draw by a seed, and sum in one order whatever the number of cores; generators are given back as they were.

    Small layers gain nothing from more threads anyway.
    """
    devices = [torch.cuda.current_device()] if torch.device(device).type == "cuda" else []
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        with torch.random.fork_rng(devices=devices):
            torch.manual_seed(seed)
            yield
    finally:
        torch.set_num_threads(before)
