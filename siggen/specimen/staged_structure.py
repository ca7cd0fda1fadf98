"""The rigid casing round all shafts of a drawn specimen."""

from __future__ import annotations

from math import cos, sin

from siggen.dynamics.structure.gear_stage import PLACES, Point
from siggen.dynamics.structure.makers import Housing, rigid_housing
from siggen.gearbox.housing import Block
from siggen.gearbox.specimen import Specimen

LEAST_SPAN = 0.5 / min(PLACES[0], PLACES[1] - PLACES[0])
"""Distance of the bearings of a common shaft over both faces, from which on neither gears nor bearings overlap."""


def casing_round_shafts(specimen: Specimen) -> Housing:
    """Return the rigid casing round all shafts. Its x is horizontal, its y vertical.

    Raises
    ------
    ValueError
        If the bolts leave it free to move.
    """
    assert isinstance(specimen.housing, Block)
    places = axis_places_m(specimen)
    across = [place[0] for place in places.values()]
    return rigid_housing(specimen.housing.casing(max(across) - min(across)), places)


def axis_places_m(specimen: Specimen) -> dict[str, Point]:
    """Return where the bearings of every shaft stand, horizontally from the middle between the outermost ones [m].

    Horizontal runs from the first gear to its pinion; the height is that of the first pinion.
    """
    first, *behind = (shaft.bearing for shaft in specimen.names.shafts)
    place, found = (0.0, 0.0), {first: (0.0, 0.0)}
    for bearing, mesh in zip(behind, specimen.meshes, strict=True):
        centre_m = mesh.pair.working_centre_distance_m
        place = place[0] - centre_m * cos(mesh.direction_rad), place[1] + centre_m * sin(mesh.direction_rad)
        found[bearing] = place
    across = [x for x, _ in found.values()]
    middle = 0.5 * (max(across) + min(across))
    return {name: (x - middle, y) for name, (x, y) in found.items()}
