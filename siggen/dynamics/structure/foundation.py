"""Foundation: a gearbox whose bolts stand on a base that moves on its mounts, instead of on the ground.

Derived. The bolts press on the base as much as on the body: each support acts on its own stretch less what the base
moves it by (`Body.base`). The base moves by two translations and rocking about the middle between the shafts. Far above
its mounts a force F on the base moves it by F/(m ω²); with heavy, stiff mounts it is the ground.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.body import BASE, Body
from siggen.dynamics.structure.mesh_vectors import MeshVectors
from siggen.dynamics.structure.structure import Element, Structure, assemble


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


def on_base(structure: Structure, body: Body, base: Base) -> Structure:
    """Return the structure with a base under its bolts; its coordinates come behind the others.

    Parameters
    ----------
    structure : Structure that holds the supports of the body
    body : Body
    base : Base
    """
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
    moving, fixed = (
        assemble(coordinates, elements) for elements in ([_to_base(one, body) for one in body.supports], body.supports)
    )
    return replace(
        structure,
        coordinates=coordinates,
        mass=mass,
        stiffness=stiffness + of_mounts[0] + moving[0] - fixed[0],
        damping=damping + of_mounts[1] + moving[1] - fixed[1],
        meshes=tuple(_longer_mesh(mesh) for mesh in structure.meshes),
        torque_vector=_longer(structure.torque_vector),
        motions={name: _longer(row) for name, row in structure.motions.items()},
        bearing_forces={name: (_longer(k), _longer(c)) for name, (k, c) in structure.bearing_forces.items()},
        bearing_directions={name: _longer(row) for name, row in structure.bearing_directions.items()},
    )


def _to_base(support: Element, body: Body) -> Element:
    """Return a support between the body and a base: what it stretches by, less what the base moves the body by."""
    moved: dict[str, float] = {}
    for name, value in support.direction.items():
        for base, share in body.base[name].items():
            moved[base] = moved.get(base, 0.0) - value * share
    return replace(support, direction={**support.direction, **moved})


def _padded(matrix: FloatArray) -> FloatArray:
    return np.pad(matrix, (0, len(BASE)))


def _longer(row: FloatArray) -> FloatArray:
    return np.pad(row, (0, len(BASE)))


def _longer_mesh(mesh: MeshVectors) -> MeshVectors:
    tilt = None if mesh.tilt is None else _longer(mesh.tilt)
    sliding = np.pad(mesh.sliding, ((0, 0), (0, len(BASE))))
    return replace(mesh, vector=_longer(mesh.vector), sliding=sliding, tilt=tilt)
