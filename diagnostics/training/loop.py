"""One training loop for every network: losses of batches in, the weights of the best moment out.

Training goes on from a file, to the bit as if it had never stopped: the file holds weights, means of AdamW, generator
and what was kept.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from math import cos, inf, pi
from pathlib import Path
from pickle import UnpicklingError
from typing import Any

import torch
from torch import nn
from torch.optim.adamw import adamw

from siggen.errors import UsageError
from siggen.file_writing import write_file


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
    falling : bool
        Whether the rate falls over all rounds, by half a cosine: the last steps then settle between batches.
    """

    most: int
    rate: float
    decay: float
    patience: int = 0
    every: int = 1
    from_start: bool = False
    falling: bool = False


def fit_network(
    network: nn.Module,
    batches: Callable[[int], Iterable[torch.Tensor]],
    judged: Callable[[], float] | None,
    loop: LoopSettings,
    advance: Callable[[], None] | None = None,
    place: Path | None = None,
) -> tuple[int, int, tuple[float, ...]]:
    """Train a network in place; return the round whose weights it has, the rounds run, and what `judged` said.

    Where `batches` draws from torch's generator, draw in `seeded`: a place holds that generator.

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
    place : Path, optional
        File that is written after every round, and from which training goes on.
    """
    step = _AdamW(list(network.parameters()), loop)
    kept, best, lowest, losses, passed = _weights(network), 0, inf, list[float](), -1
    if place is not None and place.exists():
        try:
            held = torch.load(place, weights_only=True)  # plain tensors and numbers: nothing is executed
            network.load_state_dict(held["weights"])
        except (OSError, RuntimeError, ValueError, KeyError, TypeError, EOFError, UnpicklingError) as error:
            raise UsageError(
                f"{place}: holds no place of this training; delete it to begin the passes again"
            ) from error
        step.load(held["steps"])
        torch.set_rng_state(held["generator"])
        kept, best, lowest, losses, passed = (held[name] for name in ("kept", "best", "lowest", "losses", "passed"))
    done = passed
    for done in range(passed + 1, loop.most + 1):
        if done:
            network.train()
            for loss in batches(done):
                network.zero_grad()
                loss.backward()
                step(loop.rate * (0.5 + 0.5 * cos(pi * (done - 1) / loop.most) if loop.falling else 1.0))
            if advance:
                advance()
        if not done % loop.every and (done or loop.from_start):
            network.eval()
            if judged is not None:
                with torch.no_grad():
                    losses.append(judged())
            if judged is None or losses[-1] < lowest or (losses[-1] == lowest and not loop.from_start):
                kept, best, lowest = _weights(network), done, losses[-1] if losses else inf
            elif loop.patience and done - best >= loop.patience:
                break
        if place is not None:
            moment = {"weights": _weights(network), "steps": step.held(), "generator": torch.get_rng_state()}
            _write(place, moment | {"kept": kept, "best": best, "lowest": lowest, "losses": losses, "passed": done})
    network.load_state_dict(kept)
    network.eval()
    return best, done, tuple(losses)


class _AdamW:
    """Steps of AdamW. The class `torch.optim.AdamW` takes the same, but loads a compiler first: 1 s of CPU."""

    def __init__(self, weights: list[nn.Parameter], loop: LoopSettings) -> None:
        self.weights = weights
        self.means, self.squares = ([torch.zeros_like(weight) for weight in weights] for _ in range(2))
        self.counts = [torch.tensor(0.0) for _ in weights]
        self.law = {"weight_decay": loop.decay, "beta1": 0.9, "beta2": 0.999, "eps": 1e-8}

    def __call__(self, rate: float) -> None:
        """Take a step."""
        slopes = [weight.grad for weight in self.weights]
        with torch.no_grad():
            moments = self.means, self.squares
            adamw(self.weights, slopes, *moments, [], self.counts, amsgrad=False, maximize=False, lr=rate, **self.law)

    def held(self) -> list[list[torch.Tensor]]:
        """Return what a step depends on besides the weights."""
        return [self.means, self.squares, self.counts]

    def load(self, held: list[list[torch.Tensor]]) -> None:
        """Go on from what another held."""
        self.means, self.squares, self.counts = held


def _write(place: Path, held: dict[str, Any]) -> None:
    content = BytesIO()
    torch.save(held, content)
    write_file(place, content.getvalue())


def _weights(network: nn.Module) -> dict[str, torch.Tensor]:
    return {name: value.detach().clone() for name, value in network.state_dict().items()}


@contextmanager
def in_one_thread() -> Iterator[None]:
    """Sum in one order whatever the number of cores; small layers gain nothing from more threads anyway."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)


@contextmanager
def seeded(seed: int, device: str = "cpu") -> Iterator[None]:
    """Draw by a seed, and in one thread; generators are given back as they were."""
    devices = [torch.cuda.current_device()] if torch.device(device).type == "cuda" else []
    with in_one_thread(), torch.random.fork_rng(devices=devices):
        torch.manual_seed(seed)
        yield
