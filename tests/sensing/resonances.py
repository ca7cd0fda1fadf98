"""Accelerance of a few resonances, written out: what a measured path looks like."""

from __future__ import annotations

import numpy as np


def accelerance(
    frequency_hz: np.ndarray, natural_hz: tuple[float, ...], residues_per_kg: tuple[float, ...], ratio: float = 0.02
) -> np.ndarray:
    """Return Σ R (f/f_r)²/((f/f_r)² - 1 - 2 i ζ f/f_r) (k,) [m/s² per N]."""
    x = frequency_hz / np.array(natural_hz)[:, None]
    return np.array(residues_per_kg) @ (x**2 / (x**2 - 1.0 - 2j * ratio * x))
