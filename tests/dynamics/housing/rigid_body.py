"""Six natural frequencies of a rigid box on its bolts, from points of mass: another way than plates."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from siggen.drivetrain.box import SIDES, Box, plane_axes

POINTS = 200


def rigid_box_hz(box: Box, loose_share: float = 1.0) -> np.ndarray:
    """Natural frequencies (6,) of the box's mass on its bolts, of which the last one behind may be loose."""
    places, masses = mass_points(box)
    mass = sum(m * _jacobian(p).T @ _jacobian(p) for p, m in zip(places, masses, strict=True))
    stiffness = np.zeros((6, 6))
    for bolt in box.bolts:
        for z in (bolt.z_m, box.size_m[2] - bolt.z_m):
            jacobian = _jacobian(np.array([bolt.x_m, 0.0, z]))
            left = loose_share if bolt is box.bolts[-1] and z != bolt.z_m else 1.0
            stiffness += left * jacobian.T @ np.diag(bolt.stiffness_n_per_m) @ jacobian
    return np.sqrt(eigh(stiffness, mass, eigvals_only=True)) / (2.0 * np.pi)


def _jacobian(place: np.ndarray) -> np.ndarray:
    """Motion of a place per translation and rotation."""
    x, y, z = place
    return np.hstack([np.eye(3), np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])])


def mass_points(box: Box) -> tuple[np.ndarray, np.ndarray]:
    """Return places (n, 3) [m] and masses (n,) [kg] that stand for plates and bosses."""
    places, masses = [], []
    for plate, (normal, end) in SIDES.items():
        a, b = plane_axes(normal)
        u, v = np.meshgrid(*((np.arange(POINTS // 4) + 0.5) / (POINTS // 4) * box.size_m[axis] for axis in (a, b)))
        own = np.zeros((u.size, 3))
        own[:, a], own[:, b], own[:, normal] = u.ravel(), v.ravel(), end * box.size_m[normal]
        thickness = np.full(u.size, box.thickness.of(plate))
        for seat in box.seats.values() if normal == 2 else ():
            r = np.hypot(own[:, 0] - seat.x_m, own[:, 1] - seat.y_m)
            thickness = np.where(r < seat.boss_radius_m, seat.boss_thickness_m, thickness)
            thickness = np.where(r < seat.bore_radius_m, 0.0, thickness)
        places.append(own)
        masses.append(box.material.density_kg_m3 * thickness * box.area_m2(plate) / u.size)
    return np.concatenate(places), np.concatenate(masses)
