"""How like a record is to those that a network has learnt from, by what comes in and by what the network makes of it.

Two distances are of numbers of the averages themselves: how power is shared by shaft, meshes and what is left, by
orders, and by noise; of all together, and of the one that is farthest off. Foreign machines differ there, whatever the
network makes of them. The third is of what the network says of the gears before its heads: a record may have ordinary
averages, but in a way that was never learnt from. A record is like the others if all distances are. Each channel has
its own; the largest counts.

Source: Mahalanobis distance with a shrunk covariance (Ledoit and Wolf 2004); which numbers is derived.
"""

from __future__ import annotations

import numpy as np

from diagnostics.signal.innovations import SHAFT_ORDERS
from diagnostics.training.gear_rows import GearLines

HARMONICS = 4
"""Of the mesh, whose shares of the power of all of them are numbers."""
BANDS = (1.0, 2.0, 4.0, 8.0)
"""Where bands of orders end, in mesh orders; the last one is open."""
SMALLEST = 1e-12
"""A share below is this."""
NUMBERS = 2 + (HARMONICS - 1) + 2 * len(BANDS) + 1
"""Of a gear and channel."""


def average_numbers(records: GearLines) -> np.ndarray:
    """Return logarithms of shares of power, (records, channels, gears * 14) float64; no gain of a sensor is in them.

    Of each gear: shaft orders and what is left over the meshes, harmonics 2 to 4 over the first, bands of what is left
    over the first band, noise over what is left, and bands of the noise over its first.
    """
    found = [
        np.concatenate([_of_gear(lines[gear], noise[gear], int(teeth[gear])) for gear in range(teeth.size)])
        for record, teeth in enumerate(records.teeth)
        for lines, noise in zip(records.lines[record], records.noise[record], strict=True)
    ]
    return np.array(found).reshape(*records.lines.shape[:2], -1)


def _of_gear(lines: np.ndarray, noise: np.ndarray, teeth: int) -> np.ndarray:
    order = np.arange(lines.size)
    power, scatter = np.square(np.abs(lines.astype(np.complex128))), np.square(noise.astype(np.float64))
    mesh, shaft = (order % teeth == 0) & (order > 0), (order > 0) & (order <= SHAFT_ORDERS)
    rest = (order > SHAFT_ORDERS) & ~mesh
    harmonics = np.array([power[k * teeth] if k * teeth < lines.size else 0.0 for k in range(1, HARMONICS + 1)])
    place = np.digitize(order / teeth, BANDS)

    def bands(of: np.ndarray) -> np.ndarray:
        held = [of[rest & (place == band)] for band in range(len(BANDS) + 1)]
        return np.array([band.mean() if band.size else 0.0 for band in held])

    left, under = bands(power), bands(scatter)
    return np.concatenate(
        [
            _log(np.array([power[shaft].sum(), power[rest].sum()]), power[mesh].sum()),
            _log(harmonics[1:], harmonics[0]),
            _log(left[1:], left[0]),
            _log(scatter[rest].sum()[None], power[rest].sum()),
            _log(under[1:], under[0]),
        ]
    )


def _log(part: np.ndarray, whole: float) -> np.ndarray:
    return np.asarray(np.log(np.clip(part / max(float(whole), 1e-300), SMALLEST, 1.0 / SMALLEST)))


def fitted(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return centre (numbers,) and precision (numbers, numbers) of values (n, numbers)."""
    from sklearn.covariance import LedoitWolf

    spread = values.std(axis=0) + 1e-9
    covariance = LedoitWolf().fit((values - values.mean(axis=0)) / spread)
    precision = covariance.precision_ / np.outer(spread, spread)
    return values.mean(axis=0), precision


def distances(values: np.ndarray, centre: np.ndarray, precision: np.ndarray) -> np.ndarray:
    """Return how far values (..., numbers) are from the centre, (...), in standard deviations of a number."""
    off = values - centre
    return np.asarray(np.sqrt(np.einsum("...i,ij,...j->...", off, precision, off) / off.shape[-1]))


def farthest(values: np.ndarray, centre: np.ndarray, spread: np.ndarray) -> np.ndarray:
    """Return how far the number that lies farthest is from the centre, (...), in its standard deviations."""
    return np.asarray(np.abs((values - centre) / spread).max(axis=-1))


def mesh_over_noise(records: GearLines) -> np.ndarray:
    """Return the power of mesh lines over what noise gives there, (records,): 1 where there is no mesh.

    Of the channel in which it is largest, and of the gear in which it is smallest.
    """
    order = np.arange(records.lines.shape[-1])
    mesh = (order > 0) & (order % records.teeth[:, None, :, None] == 0)
    power, noise = (
        np.where(mesh, np.square(np.abs(part.astype(np.complex128))), 0.0).sum(axis=-1)
        for part in (records.lines, records.noise)
    )
    return np.asarray((power / np.maximum(noise, 1e-300)).max(axis=1).min(axis=-1))
