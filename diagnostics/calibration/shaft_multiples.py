"""ShaftMultiples: how far each multiple of a shaft's order stands out of what errors of the teeth make there.

Every tooth differs, so a gear has lines at all multiples of its shaft. Two things are known of them: they change
slowly from one to the next beside the mesh lines, and what errors of z teeth do returns with every z multiples. So
the excess of a multiple is its level over the median of those around it, less the median excess of all multiples as
far from a mesh line. Source: derived.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnostics.calibration.order_record import LEAST_SHARE, LINE_BINS, OrderRecord, line_places

BESIDE_MESH = 2
"""Multiples this near to a mesh line are its sidebands, which eccentric gears have as well: nothing is read there."""
AROUND = 12
OFF_BINS = 0.5
"""A line further from the multiple than this turns with something else."""
FEWEST_BINS = 3.0 * LINE_BINS
"""Between two multiples: their lines are five bins wide."""
FEWEST_ALIKE = 3


@dataclass(frozen=True, slots=True)
class ShaftMultiples:
    """Multiples 1, 2, ... of a shaft in one channel.

    Attributes
    ----------
    level_db : (recordings, k) float64
        Energy of the line [dB re 1 unit²]; where none stands out, a fifth of what its bins hold.
    usual_db : (k,) float64
        Mean over recordings that errors of the teeth lead to expect.
    excess_db : (k,) float64
        Mean level over the expected one; NaN beside mesh lines.
    """

    level_db: np.ndarray
    usual_db: np.ndarray
    excess_db: np.ndarray


def shaft_multiples(records: Sequence[OrderRecord], step: float, teeth: int, period: int) -> ShaftMultiples | None:
    """Return the multiples of a shaft; None where recordings are too short to tell them apart.

    Parameters
    ----------
    records : sequence of OrderRecord
        Of one channel.
    step : float
        Order of the shaft.
    teeth : int
        On the shaft.
    period : int
        Every which multiple is one of the other shaft too, and holds the errors of both.
    """
    if step * min(record.revolutions for record in records) < FEWEST_BINS:
        return None
    count = int(min((record.power.size - 4 * LINE_BINS) / record.revolutions for record in records) / step) - 1
    number = np.arange(1, count + 1)
    level = np.array([_levels_db(record, number * step) for record in records])
    mean = level.mean(axis=0)
    mesh = np.abs(number - np.round(number / teeth) * teeth) <= BESIDE_MESH
    usual = _around(mean, number, mesh, period)
    above = np.where(mesh, np.nan, mean - usual)
    usual = usual + _returning(above, number, teeth)
    return ShaftMultiples(level, usual, np.where(mesh, np.nan, mean - usual))


def _levels_db(record: OrderRecord, orders: np.ndarray) -> np.ndarray:
    """Return the levels of lines at these orders (k,); a line beside counts as none."""
    centre = np.round(orders * record.revolutions).astype(int)
    near = centre[:, None] + np.arange(-LINE_BINS, LINE_BINS + 1)
    total, floor = record.power[near].sum(axis=1), record.floor[near].sum(axis=1)
    place = line_places(record.power, near[np.arange(near.shape[0]), record.power[near].argmax(axis=1)])
    least = LEAST_SHARE * np.minimum(total, floor)
    energy = np.where(np.abs(place - orders * record.revolutions) < OFF_BINS, total - floor, 0.0)
    return np.asarray(10.0 * np.log10(np.maximum(np.maximum(energy, least), 1e-30)))


def _around(level_db: np.ndarray, number: np.ndarray, mesh: np.ndarray, period: int) -> np.ndarray:
    """Return the median of the nearest multiples of the same kind (k,), without those at mesh lines and beside it."""
    found = np.full(number.size, math.inf)
    both = number % period == 0
    for k in range(number.size):
        alike = np.flatnonzero((both == both[k]) & ~mesh & (np.abs(number - number[k]) > 1))
        if alike.size >= FEWEST_ALIKE:
            nearest = np.argsort(np.abs(alike - k), kind="stable")[:AROUND]
            found[k] = np.median(level_db[alike[nearest]])
    return found


def _returning(above_db: np.ndarray, number: np.ndarray, teeth: int) -> np.ndarray:
    """Return what all multiples as far from a mesh line have in common (k,) [dB], 0 at least."""
    found = np.zeros(number.size)
    for rest in range(teeth):
        alike = number % teeth == rest
        known = above_db[alike][np.isfinite(above_db[alike])]
        if known.size >= FEWEST_ALIKE:
            found[alike] = max(0.0, float(np.median(known)))
    return found
