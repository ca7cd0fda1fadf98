"""Training takes the steps of AdamW, to the last bit, without the compiler that its class loads, and goes on."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
import torch
from torch import nn

from diagnostics.training.loop import LoopSettings, fit_network, seeded

LOOP = LoopSettings(most=40, rate=3e-3, decay=1e-2)


def small() -> nn.Module:
    with seeded(7):
        return nn.Sequential(nn.Linear(5, 9), nn.BatchNorm1d(9), nn.ReLU(), nn.Linear(9, 1))


def test_the_weights_are_those_of_adamw_of_torch() -> None:
    with seeded(8):
        rows = torch.randn(32, 5)
    ours, theirs = small(), small()
    fit_network(ours, lambda _: [ours(rows).square().mean()], None, LOOP)
    optimiser = torch.optim.AdamW(theirs.parameters(), lr=LOOP.rate, weight_decay=LOOP.decay)
    for _ in range(LOOP.most):
        optimiser.zero_grad()
        theirs(rows).square().mean().backward()
        optimiser.step()
    for name, weight in theirs.state_dict().items():
        assert torch.equal(weight, ours.state_dict()[name]), name


class Stopped(Exception):
    """Whoever trains is ended."""


def with_dropout(place: Path | None, *, stop_in: int = 0) -> dict[str, torch.Tensor]:
    """Return the weights of a training whose batches draw, ended in a round if asked."""
    with seeded(9):
        rows, network = torch.randn(32, 5), nn.Sequential(nn.Linear(5, 9), nn.BatchNorm1d(9), nn.Dropout(0.5))

        def batches(done: int) -> Iterator[torch.Tensor]:
            yield network(rows).square().mean()
            if done == stop_in:
                raise Stopped
            yield (network(rows) - 1.0).abs().mean()

        loop = LoopSettings(most=7, rate=3e-3, decay=1e-2, falling=True)
        fit_network(network, batches, lambda: float(network(rows).square().mean()), loop, place=place)
    return network.state_dict()


def test_a_training_that_was_ended_twice_has_the_weights_of_one_that_was_not(tmp_path: Path) -> None:
    whole, place = with_dropout(None), tmp_path / "place.pt"
    for stop_in in (3, 6):
        with pytest.raises(Stopped):
            with_dropout(place, stop_in=stop_in)
    for again in (with_dropout(place), with_dropout(place)):  # the second has nothing left to do
        assert all(torch.equal(weight, again[name]) for name, weight in whole.items())
