"""What carries sun, carrier and ring of a planetary set, and the set on it as small forces see it.

Teeth push as on the ground, and what the bodies then press with acts on seats of the whole linear machine (derived:
with the forces F_0 on seats that are held, a linear machine moves beyond its motion with held seats as F_0 on the free
seats moves it). So housing and bodies answer each other, bolts included; what the housing's motion does to the mesh
stiffness and to contact alone is left out. The carrier's turning is slow beside both, and planets that stand evenly
make the machine alike in all directions: it is the same at every angle of the frame. Those that do not stand evenly
count as if they did.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from siggen.dynamics.structure.drivetrain import Drivetrain
from siggen.dynamics.structure.makers import CENTRAL, GROUND, Housing, planetary_train, rigid_housing
from siggen.dynamics.structure.structure import matrices
from siggen.gearbox.housing import CASING_GYRATION, Block
from siggen.gearbox.planetary import ring_outer_radius_m
from siggen.gearbox.specimen import Specimen
from siggen.gears.geometry.internal_pair import InternalPair

AXIS = (0.0, 0.0)
"""Of all bodies: the middle of the housing."""


def set_in_housing(specimen: Specimen, housing: Housing | None) -> Drivetrain:
    """Return a set with evenly spread planets in a housing, or on the ground."""
    assert specimen.planets is not None
    stage = specimen.planets.stage
    count = len(stage.places_turns)
    return planetary_train(replace(stage, places_turns=tuple(i / count for i in range(count))), housing)


def rigid_housing_of_set(block: Block, ring: InternalPair) -> Housing:
    """Return a block on bolts round a set, whose axis lies in its middle.

    Raises
    ------
    ValueError
        If the bolts leave it free to move.
    """
    casing = replace(block.casing(ring_outer_radius_m(ring) / CASING_GYRATION), pinion_place_m=AXIS)
    return rigid_housing(casing, dict.fromkeys(CENTRAL, AXIS))


def slowest_decay_per_s(housing: Housing) -> float:
    """Return the smallest decay rate of a rigid body on its supports [1/s]."""
    mass, damping, stiffness = matrices(Drivetrain((housing.body, GROUND), housing.bolts))
    inverse = np.diag(1.0 / np.diag(mass))
    still, unit = np.zeros_like(stiffness), np.eye(len(mass))
    state = np.block([[still, unit], [-inverse @ stiffness, -inverse @ damping]])
    return float((-np.linalg.eigvals(state).real).min())
