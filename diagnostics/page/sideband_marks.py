"""Where spectra are marked around a mesh line: sidebands of the shafts, as offsets in orders of the first gear."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from diagnostics.page.style import GEAR_COLOUR, PINION_COLOUR
from diagnostics.records.gear_train import GearMesh, Planets

PASSING = "passing planets"
MARKS = (("v", PINION_COLOUR), ("|", GEAR_COLOUR), ("^", "#6a1b6e"))
"""Marker and colour of the first, the second and the third kind of sidebands."""
ABOVE = 1.9
"""Marks stand so many times as high as their lines."""


def order_words(mesh: GearMesh) -> str:
    """Return what the orders of a mesh's spectra count."""
    return f"{mesh.names.gears[0]} orders" if mesh.planets is None else f"orders of {_against_carrier(mesh)}"


def turn_words(mesh: GearMesh) -> str:
    """Return what passes between two pulses."""
    return f"{mesh.names.gears[0]} revolution" if mesh.planets is None else f"turn of {_against_carrier(mesh)}"


def _against_carrier(mesh: GearMesh) -> str:
    return f"the {mesh.names.gears[0]} against the carrier"


def sideband_places(mesh: GearMesh, harmonic: int, count: int) -> dict[str, np.ndarray]:
    """Return the sidebands 1 ... count on both sides of a mesh harmonic by what has them, as offsets in orders.

    Of a planetary set: lines of healthy planets, and those that a tooth of the sun or of one planet adds, through the
    path's mean and the orders of the carrier that are next to it.
    """
    steps = np.array([k for k in range(-count, count + 1) if k], dtype=np.float64)
    if mesh.planets is None:
        driver, driven = mesh.names.gears
        return {driver: steps, driven: steps * (mesh.teeth[0] / mesh.teeth[1])}
    return _of_planets(mesh.names.gears, mesh.planets, harmonic, steps)


def _of_planets(gears: tuple[str, ...], planets: Planets, harmonic: int, steps: np.ndarray) -> dict[str, np.ndarray]:
    sun, planet, ring = planets.teeth
    step, carrier = planets.passing, sun / ring
    own = harmonic * sun + steps
    through = own - np.round(own / step) * step  # the order of the path that equal planets leave
    nearest = np.round(harmonic * ring / step) * step - harmonic * ring
    paths = np.arange(-(len(planets.places) // 2), len(planets.places) // 2 + 1)
    one = (steps[:, None] * (ring / planet) + paths).ravel()
    passing = nearest + step * np.concatenate([[0.0], steps])
    return {gears[0]: steps + through * carrier, PASSING: passing * carrier, gears[1]: one * carrier}


def draw_marks(
    axis: Any, spectrum: tuple[np.ndarray, np.ndarray], places: Mapping[str, np.ndarray], reach: float
) -> None:
    """Mark the lines of a spectrum (offsets and amplitudes) within so many orders of their places."""
    offset, amplitude = spectrum
    for (marker, colour), lines in zip(MARKS, places.values(), strict=False):
        height = np.array([amplitude[np.abs(offset - line) <= reach].max(initial=1e-30) for line in lines])
        axis.plot(lines, ABOVE * height, linestyle="none", marker=marker, markersize=4.5, color=colour)


def mark_handles(mesh: GearMesh) -> list[Any]:
    """Return what a legend shows of the marks."""
    from matplotlib.lines import Line2D

    names = sideband_places(mesh, 1, 1)
    return [
        Line2D(
            [], [], linestyle="none", marker=marker, markersize=4.5 if marker != "|" else 6, color=colour,
            label=name if name == PASSING else f"{name} sidebands",
        )
        for (marker, colour), name in zip(MARKS, names, strict=False)
    ]  # fmt: skip
