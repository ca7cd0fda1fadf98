"""A planetary set of 2 mm module that the tests of its dynamics share."""

from __future__ import annotations

from functools import cache
from math import radians

import numpy as np

from siggen.drivetrain.gear_stage import Coupling, PlanetaryBody, PlanetaryStage
from siggen.drivetrain.structure import Structure
from siggen.gears.gear_pair import GearPair, SpurGear
from siggen.gears.missing_material import MissingMaterial, MissingTables
from siggen.gears.planetary import InternalPair, PlanetarySet, ring_begins_pitches, ring_round
from siggen.mesh.mesh_force import mean_mesh_stiffness
from siggen.mesh.mesh_stiffness import StiffnessOptions
from siggen.mesh.mesh_tables import MeshTables, mesh_tables
from siggen.mesh.pair_law import MeshConstants, pair_law
from siggen.motion.pair_motion import PairMesh


@cache
def pairs(sun: int = 24, planet: int = 27, ring: int = 78) -> tuple[GearPair, InternalPair]:
    gears = [SpurGear(z, 2e-3, radians(20.0), 0.0, 1.0, 0.25, 8e-3) for z in (sun, planet)]
    pair = GearPair(*gears, 20e-3, 206e9, 0.3)
    return pair, ring_round(pair, ring)


def planetary_stage(planets: int = 3, sun: int = 24, planet: int = 27, ring: int = 78) -> PlanetaryStage:
    pair, inner = pairs(sun, planet, ring)
    slots = sun + ring
    return PlanetaryStage(
        sun_angle_rad=pair.working_pressure_angle_rad,
        ring_angle_rad=inner.working_pressure_angle_rad,
        centre_distance_m=pair.working_centre_distance_m,
        sun=PlanetaryBody(pair.pinion.base_radius_m, 0.3, 9e-5, 2e7, 400.0),
        planet=PlanetaryBody(pair.gear.base_radius_m, 0.36, 1.3e-4, 2e8, 300.0),
        ring=PlanetaryBody(inner.gear.base_radius_m, 3.0, 2e-2, 5e8, 4000.0, 5e6, 30.0),
        carrier=PlanetaryBody(pair.working_centre_distance_m, 2.0, 5e-3, 2e8, 1000.0),
        places_turns=tuple(round(i * slots / planets) / slots for i in range(planets)),
        motor_inertia_kg_m2=1e-2,
        load_inertia_kg_m2=0.2,
        input_coupling=Coupling(5e3, 2.0),
        output_coupling=Coupling(5e4, 20.0),
    )


def exact(tables: MeshTables, teeth: tuple[int, int]) -> MissingMaterial:
    gears = [MissingTables(np.zeros((1, 2)), np.zeros(z, dtype=np.int32), np.zeros(z)) for z in teeth]
    return MissingMaterial(tables.start_m, tables.end_m, *gears)


def meshes(structure: Structure, teeth: PlanetarySet) -> list[PairMesh]:
    """Return the laws of all meshes."""
    pair, inner = pairs(teeth.sun, teeth.planet, teeth.ring)
    options, lag, count = StiffnessOptions(), ring_begins_pitches(pair, inner), len(teeth.places)
    kinds = [
        (mesh_tables(pair, (), options), (teeth.sun, teeth.planet), teeth.sun_begins, 0.0, pair.line_of_action_m),
        (mesh_tables(inner, (), options), (teeth.planet, teeth.ring), teeth.ring_begins, lag, inner.line_of_action_m),
    ]
    found = []
    for number, vectors in enumerate(structure.meshes):
        tables, counts, begins, later, line = kinds[number // count]
        constants = MeshConstants(line, vectors.mass_kg, 100e-6)
        law = pair_law(tables, exact(tables, counts), constants, damping_ratio=0.07)
        phase = later + float(begins[number % count])
        found.append(PairMesh(law, mean_mesh_stiffness(tables), 20.0, begins_pitches=phase))
    return found
