"""Fit of the notch term N to finite elements: the constants of `siggen.mesh.contact_edges`."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
from scipy.optimize import least_squares

from siggen.mesh.contact_edges import NOTCH_POWER, QUARTER_PLANE
from tests.reference.contact.notched_half_plane import notched_edge_sink
from tests.reference.contact.plane_contact import edge_sink

RADIUS_M, POISSON = 6.676e-3, 0.3
"""Teeth 18/47 of module 3 mm at the pitch point."""
KAPPA = 4.0 * (1.0 - POISSON**2) / (pi * 206e9)
LINE_LOADS = (30e3, 60e3, 100e3)
NAMES = ("NOTCH_SCALE", "NOTCH_ON_LAND", "NOTCH_SHALLOW", "NOTCH_SHALLOW_LINEAR")
DEPTHS_M = (0.03e-3, 0.05e-3, 0.1e-3, 0.2e-3, 0.4e-3)
AHEAD = (2.0, 1.75, 1.5, 1.25, 1.0, 0.75, 0.5, 0.25, 0.0, -0.5, -1.0, -2.0, -3.7, -6.0, -11.0, -16.0)
SHALLOW, SHALLOW_WEIGHT = 0.5, 0.4
"""Notches shallower than half a Hertz width matter little: they count less."""
SMALL = 0.15
"""N below which errors count absolutely."""
LAND_M = 0.26e-3


def half_width(line_load_n_per_m: float) -> float:
    """Return Hertz's half width [m]."""
    return sqrt(2.0 * RADIUS_M * KAPPA * line_load_n_per_m)


def fitted() -> dict[str, float]:
    """Return the constants by name."""
    depth, ahead, notch = _samples()
    weight = np.where(depth < SHALLOW, SHALLOW_WEIGHT, 1.0) / np.maximum(notch, SMALL)
    answer = least_squares(lambda x: weight * (_notch(x, depth, ahead) - notch), (0.3, 0.2, 0.2, 0.4))
    return dict(zip(NAMES, answer.x.tolist(), strict=True))


def _samples() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return D/a, d/a and N of finite elements."""
    rows = []
    for depth in DEPTHS_M:
        for line in LINE_LOADS:
            width, load = half_width(line), KAPPA * line
            for ahead in AHEAD:
                if (ahead + 1.05) * width <= LAND_M:
                    cut = notched_edge_sink(ahead * width, depth, RADIUS_M, load)
                    rows.append((depth / width, ahead, (cut - edge_sink(ahead * width, RADIUS_M, load)) / load))
    depth, ahead, notch = np.array(rows).T
    return depth, ahead, notch


def _notch(constants: np.ndarray, depth: np.ndarray, ahead: np.ndarray) -> np.ndarray:
    """Return N in the form of `edge_law`, for whole arrays."""
    scale, land, shallow, linear = constants
    c = np.where(ahead < 0.0, 1.0 / (np.sqrt(ahead**2 + 3.0) - ahead), (ahead + np.sqrt(ahead**2 + 3.0)) / 3.0)
    z = depth / np.where(ahead < 1.0, (2.0 * c + c**4) / 3.0, ahead)
    w = c**4
    power = (scale * (1.0 + land * w / (1.0 + w / 6.0)) * z) ** NOTCH_POWER
    power = power * z**2 / (shallow * w + linear * z * w + z**2)
    return QUARTER_PLANE / NOTCH_POWER * np.log1p(power)
