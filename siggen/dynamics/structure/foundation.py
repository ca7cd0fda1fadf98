"""Foundation: a gearbox whose bolts stand on a base that moves on its mounts, instead of on the ground.

Derived. The bolts press on the base as much as on the casing: with K_b their stiffness in the casing's coordinates, the
base's block gains K_b + K_m, the coupling -K_b. The base moves like the casing: two translations and rocking about the
same point. Far above its mounts a force F on the base moves it by F/(m ω²); with heavy, stiff mounts it is the ground.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.structure import Element, Structure, assemble

BASE = ("x_b", "y_b", "phi_b")
CASING = ("x_c", "y_c", "phi_c")


@dataclass(frozen=True, slots=True)
class Base:
    """A rigid base; `natural_hz` along x, along y and in rocking are those of the base alone on its mounts."""

    mass_kg: float
    inertia_kg_m2: float
    natural_hz: tuple[float, float, float]
    damping_ratio: float

    @property
    def slowest_decay_per_s(self) -> float:
        """Decay rate of the base alone; what it carries makes it slower by the root of the masses' ratio at most."""
        return 2.0 * np.pi * min(self.natural_hz) * self.damping_ratio


def on_base(structure: Structure, bolts: Sequence[Element], base: Base) -> Structure:
    """Return the structure with a base under its bolts; its coordinates come behind the others.

    Parameters
    ----------
    structure : Structure with a casing
    bolts : elements between casing and ground that the structure holds already, on the casing's coordinates
    base : Base

    Raises
    ------
    ValueError
        If the structure has no casing.
    """
    if not set(CASING) <= set(structure.coordinates):
        raise ValueError(
            f"base: received a structure of {', '.join(structure.coordinates)}; allowed: one with a casing"
        )
    coordinates = (*structure.coordinates, *BASE)
    mass = np.diag([*np.diag(structure.mass), base.mass_kg, base.mass_kg, base.inertia_kg_m2])
    stiffness, damping = (_padded(matrix) for matrix in (structure.stiffness, structure.damping))
    inertias = (base.mass_kg, base.mass_kg, base.inertia_kg_m2)
    omegas = [2.0 * np.pi * natural_hz for natural_hz in base.natural_hz]
    mounts = [
        Element({name: 1.0}, inertia * omega**2, 2.0 * base.damping_ratio * inertia * omega)
        for name, inertia, omega in zip(BASE, inertias, omegas, strict=True)
    ]
    of_mounts = assemble(coordinates, mounts)
    # (v_c - v_b)(v_c - v_b)ᵀ less the v_c v_cᵀ that is there already
    moving, fixed = assemble(coordinates, [_to_base(bolt) for bolt in bolts]), assemble(coordinates, bolts)
    return replace(
        structure,
        coordinates=coordinates,
        mass=mass,
        stiffness=stiffness + of_mounts[0] + moving[0] - fixed[0],
        damping=damping + of_mounts[1] + moving[1] - fixed[1],
        mesh_vector=_longer(structure.mesh_vector),
        sliding_vectors=np.pad(structure.sliding_vectors, ((0, 0), (0, len(BASE)))),
        torque_vector=_longer(structure.torque_vector),
        motions={name: _longer(row) for name, row in structure.motions.items()},
        bearing_forces={name: (_longer(k), _longer(c)) for name, (k, c) in structure.bearing_forces.items()},
    )


def _to_base(bolt: Element) -> Element:
    on_base_side = {BASE[CASING.index(name)]: -value for name, value in bolt.direction.items()}
    return replace(bolt, direction={**bolt.direction, **on_base_side})


def _padded(matrix: FloatArray) -> FloatArray:
    return np.pad(matrix, (0, len(BASE)))


def _longer(row: FloatArray) -> FloatArray:
    return np.pad(row, (0, len(BASE)))
