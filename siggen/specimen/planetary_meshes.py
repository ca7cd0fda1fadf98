"""The 2N meshes of a drawn planetary set in motion: the sun with each planet, then each planet with the ring.

A pin that stands ahead of its place by e along the tangent opens both meshes of its planet by e cos α (derived: as far
as the planet's own motion does, see `siggen.dynamics.structure.planetary`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import cos

from siggen.gearbox.specimen import PlanetaryGears
from siggen.gears.geometry.internal_pair import ring_begins_pitches
from siggen.gears.geometry.missing_material import MissingMaterial, MissingTables
from siggen.specimen.motion import MeshBehind, SpecimenMesh, TeethUnderTorque


@dataclass(frozen=True, slots=True)
class LateTeeth:
    """Teeth whose planet stands back from its mate by `late_m`; it drives the ring, and the sun drives it."""

    teeth: TeethUnderTorque
    late_m: float
    drives: bool

    def under(self, torque_nm: float) -> MissingMaterial:
        """Return the missing material in contact under a torque at the gear in front of the pair."""
        found = self.teeth.under(torque_nm)
        if self.drives:
            return replace(found, pinion=self._back(found.pinion))
        return replace(found, gear=self._back(found.gear))

    def _back(self, teeth: MissingTables) -> MissingTables:
        return replace(teeth, offset_m=teeth.offset_m + self.late_m)


def with_planets(planets: PlanetaryGears, meshes: Sequence[SpecimenMesh]) -> SpecimenMesh:
    """Return the mesh of the sun with its first planet, and behind it all others, as their pins stand."""
    pair, inner, teeth, errors = planets.pair, planets.ring, planets.teeth, planets.pin_errors_m
    count, against = len(errors), 1.0 - 1.0 / (1.0 + teeth.ring / teeth.sun)
    moved = [_moved(one, errors[i % count], drives=i >= count) for i, one in enumerate(meshes)]
    lag, share = ring_begins_pitches(pair, inner), teeth.planet / teeth.sun
    behind = (
        *(
            MeshBehind(one, against, float(begins), 1.0 / count)
            for one, begins in zip(moved[1:count], teeth.sun_begins[1:], strict=True)
        ),
        *(
            MeshBehind(one, against / share, lag + float(begins), share / count)
            for one, begins in zip(moved[count:], teeth.ring_begins, strict=True)
        ),
    )
    return replace(moved[0], back=None, behind=behind, turning=against, torque_share=1.0 / count)


def _moved(mesh: SpecimenMesh, error_m: float, *, drives: bool) -> SpecimenMesh:
    late_m = error_m * cos(mesh.pair.working_pressure_angle_rad)
    return mesh if late_m == 0.0 else replace(mesh, missing=LateTeeth(mesh.missing, late_m, drives))
