"""Sampling: how many samples a record has, and how fast they follow."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Sampling:
    """Rate, duration as it was asked for, and number of samples of a record."""

    fs_hz: float
    duration_s: float
    samples: int
