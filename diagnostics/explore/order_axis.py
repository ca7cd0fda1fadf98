"""One axis of pinion orders for all records of a page, so that spectra can be subtracted point by point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.signal.order_domain import SAMPLES_PER_TOOTH

MESH_HARMONICS = 8.5
FLOOR_M_S2 = 1e-9


@dataclass(frozen=True, slots=True)
class OrderAxis:
    """Points at orders 0, step, 2 step ...; each stands for the orders nearest to it."""

    step: float
    points: int

    def largest(self, amplitude: np.ndarray, revolutions: int) -> np.ndarray:
        """Return the largest amplitude about every point (points,); the nearest one where none lies there.

        Parameters
        ----------
        amplitude : (bins,) float64
            At orders 0, 1/revolutions ...; NaN beyond its end.
        revolutions : int
        """
        place = np.round(np.arange(amplitude.size) / (revolutions * self.step)).astype(np.int64)
        found = np.full(self.points, -np.inf)
        inside = place < self.points
        np.maximum.at(found, place[inside], amplitude[inside])
        empty = np.flatnonzero(np.isneginf(found))
        nearest = np.round(empty * self.step * revolutions).astype(np.int64)
        found[empty] = np.where(nearest < amplitude.size, amplitude[np.minimum(nearest, amplitude.size - 1)], np.nan)
        return found


def order_axis(highest_order: float, revolutions: int, points: int) -> OrderAxis:
    """Return the axis up to an order: as fine as the longest record resolves, or as the points allow."""
    step = max(1.0 / max(revolutions, 1), highest_order / max(points - 1, 1))
    return OrderAxis(step, int(highest_order / step) + 1)


def highest_order(teeth: int, fs_hz: float, slowest_hz: float) -> float:
    """Return the last pinion order shown: 8.5 mesh harmonics, or the end of the band of the slowest record."""
    return min(MESH_HARMONICS * teeth, SAMPLES_PER_TOOTH * teeth / 2, fs_hz / 2.0 / slowest_hz)


def decibels(amplitude: np.ndarray) -> np.ndarray:
    """Return levels over 1 m/s^2; what is below 1e-9 m/s^2 counts as that."""
    return np.asarray(20.0 * np.log10(np.maximum(amplitude, FLOOR_M_S2)))
