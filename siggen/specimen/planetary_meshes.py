"""The 2N meshes of a drawn planetary set: the sun with each planet, then each planet with the ring.

A planet's flanks towards the sun are not those towards the ring, so damage of a planet is in one mesh: that of the
first planet with the sun. Damage of the sun is in all of its meshes, as its teeth come round. A pin that stands ahead
of its place by e along the tangent opens both meshes of its planet by e cos α (derived: as far as the planet's own
motion does, see `siggen.dynamics.structure.planetary`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import cos

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Config
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.internal_pair import InternalPair, ring_begins_pitches
from siggen.gears.geometry.missing_material import MissingMaterial, TipRelief, ToothTables
from siggen.gears.stiffness.internal_stiffness import internal_tables
from siggen.gears.stiffness.mesh_tables import TABLE_POINTS, MeshTables
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from siggen.planning.specimen import Specimen
from siggen.specimen.contact import tip_relief
from siggen.specimen.motion import MeshBehind, SpecimenMesh, TeethUnderTorque
from siggen.specimen.planetary_numbers import pin_errors_m, planetary_teeth, planets_in_ring


@dataclass(frozen=True, slots=True)
class Moved:
    """Teeth whose planet stands back from its mate by `late_m`; it drives the ring, and the sun drives it."""

    teeth: TeethUnderTorque
    late_m: float
    drives: bool

    def under(self, torque_nm: float) -> MissingMaterial:
        """Return the missing material in contact under a torque at the sun."""
        found = self.teeth.under(torque_nm)
        if self.drives:
            return replace(found, pinion=self._back(found.pinion))
        return replace(found, gear=self._back(found.gear))

    def _back(self, teeth: ToothTables) -> ToothTables:
        return replace(teeth, offset_m=teeth.offset_m + self.late_m)


@dataclass(frozen=True, slots=True)
class RingTeeth:
    """Teeth of a planet and its ring, relieved at both tips as those of the sun are; no corner of theirs carries."""

    pair: InternalPair
    relief: TipRelief

    def under(self, torque_nm: float) -> MissingMaterial:  # noqa: ARG002 - it is the same under any
        """Return the missing material along the path of contact: planets leave at their tips, the ring's enter."""
        start_m, end_m = self.pair.contact_start_m, self.pair.contact_end_m
        position_m = np.linspace(start_m, end_m, TABLE_POINTS)
        planet = self._relieved(end_m - position_m, self.pair.planet.teeth)
        ring = self._relieved(position_m - start_m, self.pair.ring.teeth)
        return MissingMaterial(start_m, end_m, planet, ring)

    def _relieved(self, to_tip_m: FloatArray, teeth: int) -> ToothTables:
        share = np.clip(1.0 - to_tip_m / self.relief.length_m, 0.0, None)
        profile = self.relief.amount_m * share**2
        return ToothTables(profile[np.newaxis], np.zeros(teeth, dtype=np.int32), np.zeros(teeth))


def with_planets(
    config: Config, specimen: Specimen, first: SpecimenMesh, other: SpecimenMesh, options: StiffnessOptions
) -> SpecimenMesh:
    """Return the mesh of the sun with its first planet, and behind it all others.

    `other` has the teeth of the sun, in their state, with those of a healthy planet.
    """
    pair, inner = planets_in_ring(specimen)
    teeth, errors = planetary_teeth(specimen), pin_errors_m(config, specimen)
    against = 1.0 - 1.0 / (1.0 + teeth.ring / teeth.sun)
    pairs = zip(_each(first, other, errors.size), errors, strict=True)
    suns = [_moved(one, error, pair, drives=False) for one, error in pairs]
    in_ring = _in_ring(first, RingTeeth(inner, tip_relief(specimen.dynamics, pair)), _ring_tables(pair, inner, options))
    rings = [_moved(in_ring, error, inner, drives=True) for error in errors]
    lag = ring_begins_pitches(pair, inner)
    behind = (
        *(MeshBehind(one, against, float(begins)) for one, begins in zip(suns[1:], teeth.sun_begins[1:], strict=True)),
        *(
            MeshBehind(one, against * teeth.sun / teeth.planet, lag + float(begins))
            for one, begins in zip(rings, teeth.ring_begins, strict=True)
        ),
    )
    return replace(suns[0], back=None, behind=behind, turning=against)


def _each(first: SpecimenMesh, other: SpecimenMesh, planets: int) -> Sequence[SpecimenMesh]:
    return [first, *(other for _ in range(planets - 1))]


def _moved(mesh: SpecimenMesh, error_m: float, pair: GearPair | InternalPair, *, drives: bool) -> SpecimenMesh:
    late_m = error_m * cos(pair.working_pressure_angle_rad)
    return mesh if late_m == 0.0 else replace(mesh, missing=Moved(mesh.missing, late_m, drives))


def _in_ring(first: SpecimenMesh, teeth: RingTeeth, tables: MeshTables) -> SpecimenMesh:
    """Return a planet in its ring, on the same structure; what is asked of the pair alone is that of sun and planet."""
    action_m = teeth.pair.line_of_action_m
    return SpecimenMesh(first.pair, first.structure, tables, teeth, sham=first.sham, line_of_action_m=action_m)


_ring_tables = lru_cache(maxsize=2)(internal_tables)  # states of a specimen share them
