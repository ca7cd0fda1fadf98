"""A sentence where fitted paths are far from what a housing of the rig's mass can be: a unit is wrong, or a torque."""

from __future__ import annotations

from typing import Any

import numpy as np

BAND_HZ = (300.0, 5000.0)
USUAL_DB = 10.0
"""Of paths over 1/mass: 16 simulated machines of 10 to 50 kg had 0 to 24 dB, since housings ring."""
MOST_DB = 30.0


def path_level_doubt(mass_kg: Any, grid_hz: np.ndarray, accelerance: np.ndarray) -> str:
    """Return what is implausible in the level of paths, or an empty text.

    Parameters
    ----------
    mass_kg : float or mapping
        Of the housing, as in a configuration.
    grid_hz : (k,) float64
    accelerance : (paths, k) complex128
        m/s² per N.
    """
    low, high = _limits(mass_kg)
    inside = (grid_hz >= BAND_HZ[0]) & (grid_hz <= BAND_HZ[1])
    found_db = float(np.median(20.0 * np.log10(np.abs(accelerance[:, inside]))))
    level_db = found_db + 10.0 * np.log10(low * high) - USUAL_DB
    if abs(level_db) < MOST_DB:
        return ""
    mass = f"{low:g} kg" if low == high else f"{low:g} to {high:g} kg"
    return (
        f"doubtful: for the rig's forces the recordings are about {abs(level_db):.0f} dB too "
        f"{'high' if level_db > 0.0 else 'low'} at a housing of {mass}; are --unit and --sensitivity those of the "
        "files, and torque and module those of the machine?"
    )


def _limits(number: Any) -> tuple[float, float]:
    """Return the bounds of a number of a configuration, which may be drawn."""
    if not isinstance(number, dict):
        return float(number), float(number)
    values = number.get("values") or [number[name] for name in ("low", "high") if number.get(name) is not None]
    values = values or [number["mean"]]
    return float(min(values)), float(max(values))
