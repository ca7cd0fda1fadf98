"""Shafts so soft that an end of the face meets the other flank already under the steady torque.

Derived: springs k at the distances l from the gear's middle (`tilting_shaft`), a force F in that middle, towards the
bearings, and no moment give, per axis, the tilt F S_1/(S_0 S_2 - S_1²) with S_j = Σ k l^j. The flanks' tilt is the sum
over axes and gears, each times the squared share of the line of action along the axis; bounds of the numbers enter gear
by gear. The axial force of helical teeth, tan β_b F at the pitch point, is a moment M about the vertical axis of each
gear: it tilts the horizontal one by M S_0/(S_0 S_2 - S_1²) more, of which the flanks see the difference of both gears.
Half the face times the tilt is how far an end is behind: beyond approach and backlash together it meets the other
flank, of which the contact across the face knows nothing. Refused is what tilts too far in half of the gearboxes of a
set; where fewer do, plan says so. How far a motion swings about that is known only when it is simulated: it then ends
as `outside_model`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from itertools import product
from math import cos, sin, tan
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.drivetrain.bearings import loaded_bearing
from siggen.drivetrain.gear_stage import Bearing, Shaft, cantilever_compliance_m_per_n
from siggen.errors import Problem
from siggen.gearbox.possible import PossibleGearbox
from siggen.gears.gear_pair import GearPair
from siggen.keys.drawing import Uniforms, corners
from siggen.keys.number import MIDDLE
from siggen.mesh.contact_table import approach_under_m
from siggen.names import SHAFT_OF, Side
from siggen.record.structure import BEARINGS, on_loaded_bearing, shaft_load_n

PLACES = (0.125, 0.375, 0.625, 0.875)
"""Equally likely places of a gear on its shaft."""
OF_BEARINGS = (".stiffness_n_per_m.", ".geometry.", ".sizing.series")
"""What the stiffness of bearings follows from."""
LOAD_RESERVE = 3.0
"""Of the force up to which contacts are tabulated over that of the largest torque."""


def tilt_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield the shaft that tilts most where the steady torque alone tilts half of all gearboxes too far."""
    if gearbox.config.dynamics.shafts is None:
        return
    torque_nm = gearbox.largest_torque_nm
    for pair in gearbox.meshes[0].flanks:
        if not np.isfinite(LOAD_RESERVE * torque_nm / pair.pinion.base_radius_m):
            allowed = "allowed: torques whose force on the teeth, three times over, is a finite number"
            yield Problem("operating_points", f"a torque of {torque_nm:g} N m", allowed)
            return
        tilts = flank_tilts(gearbox, pair)
        # half of the gearboxes tilt no farther than the one at all bounds
        if tilts.largest_rad > tilts.limit_rad and tilts.median_rad() > tilts.limit_rad:
            yield _problem(gearbox, pair, tilts)
            return


class FlankTilts(NamedTuple):
    """Tilts of a pair's flanks under the largest steady torque, and at which an end meets the other flank."""

    limit_rad: float
    largest_rad: float
    """Largest size of the sum over both gears, over the ends of all numbers."""
    over_places_rad: dict[str, Callable[..., FloatArray]]
    """Pinion, gear -> its tilts (4,) at equally likely places on its shaft, of another diameter [m] if it is given."""

    def median_rad(self, **diameter_m: float) -> float:
        """Return the size that half of the gearboxes exceed, each place of one gear with each of the other."""
        pinion, gear = (tilts(diameter_m.get(side)) for side, tilts in self.over_places_rad.items())
        return float(np.median(np.abs(np.add.outer(pinion, gear))))


def flank_tilts(gearbox: PossibleGearbox, pair: GearPair) -> FlankTilts:
    """Return the tilts of a pair under the largest torque of all operating points."""
    torque_nm = gearbox.largest_torque_nm
    force_n = torque_nm / pair.pinion.base_radius_m
    approach_m = approach_under_m(pair, gearbox.bending, force_n) if force_n > 0.0 else 0.0
    ends = []
    for side in Side:
        shafts = corners(gearbox.shaft(side, pair))
        bearings = corners(partial(_bearing, gearbox, side, pair), *OF_BEARINGS)
        tilts = [static_tilt_rad(*one, pair, side, torque_nm) for one in product(shafts, bearings)]
        ends.append((min(tilts), max(tilts)))
    low, high = (sum(each) for each in zip(*ends, strict=True))
    return FlankTilts(
        2.0 * (gearbox.law(lambda _: MIDDLE).backlash_m + approach_m) / pair.face_width_m,
        max(-low, high),
        {side: partial(_over_places_rad, gearbox, pair, side) for side in Side},
    )


def _bearing(gearbox: PossibleGearbox, side: Side, pair: GearPair, uniform: Uniforms) -> Bearing:
    """Return the bearings of a shaft, under the largest torque where they follow the load."""
    rotor, ball = gearbox.rotor(side, pair, uniform), gearbox.ball(side, uniform)
    if ball is None:
        return rotor.bearing
    load_n = shaft_load_n(pair, side, gearbox.largest_torque_nm, rotor.mass_kg, housed=True)
    return on_loaded_bearing(rotor, loaded_bearing(ball, load_n / BEARINGS)).bearing


def _over_places_rad(
    gearbox: PossibleGearbox, pair: GearPair, side: Side, diameter_m: float | None = None
) -> FloatArray:
    """Return tilts (4,) [rad] of one gear at equally likely places on its shaft, all other numbers in their middle."""
    drawn, bearing, found = gearbox.shaft(side, pair), _bearing(gearbox, side, pair, lambda _: MIDDLE), []
    for place in PLACES:
        shaft = drawn(lambda name, at=place: at if name.endswith("position") else MIDDLE)  # type: ignore[misc]
        shaft = shaft if diameter_m is None else replace(shaft, diameter_m=diameter_m)
        found.append(static_tilt_rad(shaft, bearing, pair, side, gearbox.largest_torque_nm))
    return np.array(found)


def static_tilt_rad(shaft: Shaft, bearing: Bearing, pair: GearPair, side: Side, torque_nm: float) -> float:
    """Return the tilt [rad] of the flanks by one gear of a pair, on its shaft in its bearings, under a motor torque."""
    along, across = cos(pair.working_pressure_angle_rad), sin(pair.working_pressure_angle_rad)
    # the moment about the vertical axis per force along the line of action
    radius_m = pair.member(side).base_radius_m / along
    lever_m = tan(pair.base_helix_rad) * radius_m * (1.0 if side == Side.DRIVEN else -1.0)
    per_n = along**2 * _tilt_per_n(shaft, bearing.stiffness_y_n_per_m, 0.0)
    per_n += across**2 * _tilt_per_n(shaft, bearing.stiffness_x_n_per_m, lever_m / across)
    force_n = (1.0 + tan(pair.base_helix_rad) ** 2) * torque_nm / pair.pinion.base_radius_m  # as slices feel it
    return force_n * per_n


def _tilt_per_n(beam: Shaft, bearing_n_per_m: float, lever_m: float) -> float:
    """Return the tilt per force [rad/N] at the middle of the gear, with a moment at a lever, on both bearings."""
    levers = [*beam.levers_m.values()]
    springs = [1.0 / (2.0 / bearing_n_per_m + cantilever_compliance_m_per_n(beam, abs(lever))) for lever in levers]
    zeroth, first, second = (
        sum(spring * lever**power for spring, lever in zip(springs, levers, strict=True)) for power in (0, 1, 2)
    )
    return (first + lever_m * zeroth) / (zeroth * second - first**2)


def _problem(gearbox: PossibleGearbox, pair: GearPair, tilts: FlankTilts) -> Problem:
    """Return what is wrong with the worse shaft, and the least diameter that would do beside the other one as it is."""
    limit, side = tilts.limit_rad, max(Side, key=lambda one: float(np.median(np.abs(tilts.over_places_rad[one]()))))
    own_path, bearing = gearbox.config.names.own_path, f"dynamics.{side}.bearing.stiffness_n_per_m"
    path = f"dynamics.shafts.{SHAFT_OF[side]}.diameter_mm"
    thin_m = min(shaft.diameter_m for shaft in corners(gearbox.shaft(side, pair)))
    thick_m = 2.0 * pair.member(side).root_radius_m
    given, key = gearbox.given(path), "" if gearbox.given(path) == path else f"{own_path(path)} "
    received = (
        f"{key}{gearbox.written(path)}, with which the flanks tilt by {1e6 * tilts.median_rad():.0f} urad under "
        f"{gearbox.largest_torque_nm:g} N m, with {own_path(bearing)} {gearbox.written(bearing)}"
    )
    allowed = f"allowed: a tilt of at most {1e6 * limit:.0f} urad, where an end of the face meets the other flank"
    if tilts.median_rad(**{side: thick_m}) > limit:
        advice = "no diameter below that of the root does; move gear_position nearer to 0.5, or take stiffer bearings"
        return Problem(given, received, f"{allowed}; {advice}")
    for _ in range(40):
        middle_m = 0.5 * (thin_m + thick_m)
        enough = tilts.median_rad(**{side: middle_m}) <= limit
        thin_m, thick_m = (thin_m, middle_m) if enough else (middle_m, thick_m)
    advice = f"{key}from {np.ceil(1e4 * thick_m) / 10.0:.1f} mm on, or a gear_position nearer to 0.5"
    return Problem(given, received, f"{allowed}: {advice}")
