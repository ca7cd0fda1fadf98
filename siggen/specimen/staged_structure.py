"""Further meshes of a drawn specimen in SI, and the rigid casing round all of its shafts."""

from __future__ import annotations

from itertools import pairwise
from math import cos, radians, sin

from siggen.config import PlainRotor, RigidHousing, Stage
from siggen.dynamics.structure.gear_stage import PLACES, CommonShaft, NextStage, Point
from siggen.dynamics.structure.makers import Housing, rigid_housing
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import constant
from siggen.planning.specimen import Specimen
from siggen.specimen.gears import gear_pair
from siggen.specimen.rigid_casing import casing_numbers
from siggen.specimen.rotors import rotor_numbers

LEAST_SPAN = 0.5 / min(PLACES[0], PLACES[1] - PLACES[0])
"""Distance of the bearings of a common shaft over both faces, from which on neither gears nor bearings overlap."""


def casing_round_shafts(specimen: Specimen) -> Housing:
    """Return the rigid casing round all shafts. Its x is horizontal, its y vertical.

    Raises
    ------
    ValueError
        If the bolts leave it free to move.
    """
    assert isinstance(specimen.housing, RigidHousing)
    places = axis_places_m(specimen)
    across = [place[0] for place in places.values()]
    casing = casing_numbers(specimen.housing, max(across) - min(across), specimen.sensors)
    return rigid_housing(casing, places)


def axis_places_m(specimen: Specimen) -> dict[str, Point]:
    """Return where the bearings of every shaft stand, horizontally from the middle between the outermost ones [m].

    Horizontal runs from the first gear to its pinion; the height is that of the first pinion.
    """
    first, *behind = (shaft.bearing for shaft in specimen.names.shafts)
    place, found = (0.0, 0.0), {first: (0.0, 0.0)}
    for bearing, direction, pair in zip(behind, [0.0, *_directions(specimen)], _pairs(specimen), strict=True):
        centre_m = pair.working_centre_distance_m
        place = place[0] - centre_m * cos(direction), place[1] + centre_m * sin(direction)
        found[bearing] = place
    across = [x for x, _ in found.values()]
    middle = 0.5 * (max(across) + min(across))
    return {name: (x - middle, y) for name, (x, y) in found.items()}


def _pairs(specimen: Specimen) -> list[GearPair]:
    return [gear_pair(specimen.gears), *(gear_pair(stage.gears) for stage in specimen.stages)]


def _directions(specimen: Specimen) -> list[float]:
    return [radians(constant(stage.direction_deg)) for stage in specimen.stages]


def next_stages(specimen: Specimen) -> list[NextStage]:
    """Return the further meshes in SI; a shaft is as thick as the thinner bore of its two gears."""
    pairs = pairwise(_pairs(specimen))
    return [
        NextStage(
            working_pressure_angle_rad=pair.working_pressure_angle_rad,
            pinion=rotor_numbers(seat, pair.pinion, before.face_width_m if stage.idler else pair.face_width_m),
            gear=rotor_numbers(stage.gear, pair.gear, pair.face_width_m),
            shaft=None if stage.idler else _common_shaft(stage, before, pair),
            direction_rad=direction,
        )
        for stage, seat, direction, (before, pair) in zip(
            specimen.stages, _pinion_seats(specimen), _directions(specimen), pairs, strict=True
        )
    ]


def _pinion_seats(specimen: Specimen) -> list[PlainRotor]:
    """Return what says how heavy the pinion of each further mesh is: a disc, or the gear in front where it is that."""
    front = [specimen.dynamics.gear, *(stage.gear for stage in specimen.stages)]
    return [seat if stage.idler else PlainRotor() for stage, seat in zip(specimen.stages, front, strict=False)]


def _common_shaft(stage: Stage, before: GearPair, pair: GearPair) -> CommonShaft:
    span_m = 2.0 * (before.face_width_m + pair.face_width_m)
    return CommonShaft(
        span_m=span_m if isinstance(stage.span_mm, str | None) else 1e-3 * constant(stage.span_mm),
        diameter_m=2.0 * min(before.gear.bore_radius_m, pair.pinion.bore_radius_m),
        youngs_modulus_pa=pair.youngs_modulus_pa,
        poisson_ratio=pair.poisson_ratio,
    )
