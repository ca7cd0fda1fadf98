"""Training takes the steps of AdamW, to the last bit, without the compiler that its class loads."""

from __future__ import annotations

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
