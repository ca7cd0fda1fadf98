"""MeshVectors: how one mesh of a structure pushes on its coordinates, and what it sees of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray


class Flanks(NamedTuple):
    """Flanks that a mesh has its vectors for: those that carry its torque.

    `side`: 1 for drive flanks, -1 for back flanks; `ahead_pitches`: by how many base pitches a pair of them is farther
    on its path than drive flanks are on theirs.
    """

    side: float = 1.0
    ahead_pitches: float = 0.0


DRIVE_FLANKS = Flanks()


@dataclass(frozen=True, slots=True)
class MeshVectors:
    """One mesh over the n coordinates of a structure.

    Attributes
    ----------
    vector : (n,) p, approach along the line of action = pᵀ q; a positive mesh force acts as -p
    sliding : (2, n) r_0, r_1: sliding speed of the flanks at s along the line of action = (r_0 + s r_1)ᵀ q̇ plus that of
        the rigid rotation; a friction force F acts as -(r_0 + s r_1) F
    mass_kg : J_1 J_2 / (J_1 R_b2² + J_2 R_b1²) of its two gears
    turning : coordinates of the rotations of its driving and of its driven gear
    tilt : (n,) t, tilt of the driving gear's flanks against the driven one's in the plane of action = tᵀ q; None where
        gears stay parallel. A moment of the mesh across the face acts as -t
    centre_line : (2,) unit vector from gear to gear in x and y
    flanks : Flanks
    name : what its quantities are called by; empty for the only mesh
    """

    vector: FloatArray
    sliding: FloatArray
    mass_kg: float
    turning: tuple[str, str] = ("theta_1", "theta_2")
    tilt: FloatArray | None = None
    centre_line: tuple[float, float] = (1.0, 0.0)
    flanks: Flanks = DRIVE_FLANKS
    name: str = ""

    def of_turning(self, coordinates: Sequence[str]) -> tuple[float, float]:
        """Return the entries of p at the rotations of its driving and of its driven gear."""
        driving, driven = (float(self.vector[coordinates.index(name)]) for name in self.turning)
        return driving, driven


def friction_tilt(coordinates: Sequence[str], mesh: MeshVectors) -> FloatArray:
    """Return t_x (n,): a friction force F at the distance ζ from the middle of the face acts as -t_x ζ F too.

    Tilts move the flanks there as shifts do, per distance.
    """
    across = dict(zip(coordinates, mesh.sliding[0].tolist(), strict=True))
    result = np.array([across.get(name.removeprefix("phi_"), 0.0) * name.startswith("phi_") for name in coordinates])
    result.setflags(write=False)
    return result
