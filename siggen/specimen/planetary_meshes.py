"""The 2N meshes of a drawn planetary set: the sun with each planet, then each planet with the ring.

Each is a pair of its own, with teeth made for it; the sun and the ring are one and the same in all of theirs. A
planet's flanks towards the sun are not those towards the ring, so damage of a planet is in one mesh: that of the first
planet with the sun. Damage of sun and ring is in all of their meshes, as its teeth come round. A pin that stands ahead
of its place by e along the tangent opens both meshes of its planet by e cos α (derived: as far as the planet's own
motion does, see `siggen.dynamics.structure.planetary`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import cos, pi

from siggen.config import Config
from siggen.gearbox.specimen import PlanetaryGears
from siggen.gears.geometry.internal_pair import ring_begins_pitches
from siggen.gears.geometry.missing_material import MissingMaterial, ToothTables
from siggen.planning.stages import planet_config, ring_config
from siggen.specimen.made_gears import MadeGears, SameBody, Shared
from siggen.specimen.motion import MeshBehind, SpecimenMesh, TeethUnderTorque


@dataclass(frozen=True, slots=True)
class Moved:
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

    def _back(self, teeth: ToothTables) -> ToothTables:
        return replace(teeth, offset_m=teeth.offset_m + self.late_m)


def made_meshes(first: MadeGears, config: Config) -> list[MadeGears]:
    """Return what makes the teeth of all meshes, in their order; `first` those of the sun with the first planet.

    Parameters
    ----------
    first : MadeGears
    config : Config
        Of the gearbox, with all of its damage.
    """
    specimen, ring = first.specimen, ring_config(config)
    planets = specimen.planets
    assert planets is not None
    later = _axes_later_rad(planets)
    suns = [first]
    for i in range(1, len(later)):
        suns.append(MadeGears(planet_config(first.config, i), specimen, planets.pair, Shared(first, "pinion")))
    rings = [MadeGears(ring, specimen, planets.ring, None, SameBody(first, later[0]))]
    for i in range(1, len(later)):
        body = SameBody(suns[i], later[i])
        rings.append(MadeGears(planet_config(ring, i), specimen, planets.ring, Shared(rings[0], "gear"), body))
    return [*suns, *rings]


def _axes_later_rad(planets: PlanetaryGears) -> list[float]:
    """Return by how much the phase of a planet's eccentricity is later in its mesh with the ring than with the sun.

    Derived: moved by e at the angle β from the radius outwards, a planet stands back from the sun by e sin(β + α_s),
    from the ring by e sin(β - α_r); both phases count its turning, opposite to β, from where that mesh has turned none.
    """
    pair, inner, teeth = planets.pair, planets.ring, planets.teeth
    angles = pair.working_pressure_angle_rad + inner.working_pressure_angle_rad
    lag, both = ring_begins_pitches(pair, inner), zip(teeth.sun_begins, teeth.ring_begins, strict=True)
    return [angles - 2.0 * pi * (lag + float(ring - sun)) / teeth.planet for sun, ring in both]


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
    return mesh if late_m == 0.0 else replace(mesh, missing=Moved(mesh.missing, late_m, drives))
