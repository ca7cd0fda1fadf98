"""The layers of the circular network: band energies over the angle, then their mean, largest value and contrast."""

from __future__ import annotations

import torch
from torch import nn

CHANNELS, KERNEL, SECOND_KERNEL, STRIDE = 16, 15, 9, 4
SMALL = 1e-3
"""Energy below which nothing is told apart, for waves of unit rms."""


class PooledNetwork(nn.Module):  # type: ignore[misc]  # the type checker does not read torch
    """One number from one revolution, the same wherever the revolution starts (up to the stride)."""

    def __init__(self) -> None:
        super().__init__()
        self.first = nn.Conv1d(1, CHANNELS, KERNEL, padding=KERNEL // 2, padding_mode="circular")
        self.norm = nn.BatchNorm1d(CHANNELS)
        padding = SECOND_KERNEL // 2
        self.second = nn.Conv1d(CHANNELS, CHANNELS, SECOND_KERNEL, padding=padding, padding_mode="circular")
        self.last = nn.Linear(3 * CHANNELS, 1)

    def forward(self, wave: torch.Tensor) -> torch.Tensor:
        """Return the log odds of damage of waves (n, 1, steps), (n,)."""
        # squares before the mean over four steps: the energy of a band over the angle
        energy = nn.functional.avg_pool1d(self.norm(self.first(wave)).square(), STRIDE)
        answer = torch.relu(self.second(torch.log(energy + SMALL)))
        contrast = torch.log(energy.amax(-1) + SMALL) - torch.log(energy.mean(-1) + SMALL)
        return self.last(torch.cat([answer.mean(-1), answer.amax(-1), contrast], dim=1))[:, 0]
