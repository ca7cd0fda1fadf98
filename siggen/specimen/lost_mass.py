"""Unbalance of shafts whose gears have lost metal: chipped and missing teeth.

Derived. The first moments of what the teeth of a gear have lost add up as vectors; what is left is out of balance the
other way. With e from the centre to where the line of action touches the base circle, pair n stands at s in the line
of action, and the centre line of its driving tooth at s/R_b - α_b from e in the sense of its rotation, α_b the
half angle of the tooth on the base circle; that of the driven tooth at α_b - s/R_b, with s from its own end.
"""

from __future__ import annotations

from cmath import exp, phase
from math import pi
from typing import NamedTuple

from siggen.dynamics.drive.external_forces import (
    Unbalance,
    bearing_places,
    gear_directions,
    turning_sense,
)
from siggen.dynamics.structure.structure import Structure
from siggen.gears.damage.lost_mass import LostMetals, lost_moment_kg_m, without_metal
from siggen.gears.damage.part import Parts
from siggen.gears.geometry.gear_pair import GearPair
from siggen.names import Side


class MeshPlace(NamedTuple):
    """Number of a mesh, the turns of its pinion per turn of the first one, and `MeshBehind.turned_pitches`."""

    number: int = 0
    turning: float = 1.0
    turned_pitches: float = 0.0


FIRST = MeshPlace()


def lost_mass_sources(
    pair: GearPair, structure: Structure, parts: Parts, place: MeshPlace = FIRST
) -> tuple[Unbalance, ...]:
    """Return the unbalance of each gear of a mesh that has lost metal, by all of its teeth together.

    In a model of rotations alone no shaft can shake, so there is none.
    """
    lost = without_metal(parts) if structure.bearing_directions else ()
    by_gear = {side: tuple(one for one in lost if one.gear == side) for side in Side}
    return tuple(_unbalance(pair, structure, side, own, place) for side, own in by_gear.items() if own)


def tooth_angle_rad(pair: GearPair, side: Side, tooth: int) -> float:
    """Return where a tooth's centre line is while the pinion's angle is 0, from e in the sense of rotation [rad]."""
    gear = pair.member(side)
    behind = 2.0 * pi * tooth / gear.teeth
    if side == Side.DRIVER:
        return pair.contact_start_m / gear.base_radius_m - gear.base_half_angle_rad - behind
    own_end = pair.line_of_action_m - pair.contact_start_m
    return gear.base_half_angle_rad - own_end / gear.base_radius_m - behind


def _unbalance(pair: GearPair, structure: Structure, side: Side, lost: LostMetals, at: MeshPlace) -> Unbalance:
    gear, driven = pair.member(side), int(side == Side.DRIVEN)
    mesh = structure.drivetrain.meshes[at.number]
    directions = gear_directions(structure, (mesh.driven if driven else mesh.driver).body)
    sense = turning_sense(structure, bearing_places(structure)[at.number + driven])
    begins_rad = 2.0 * pi * at.turned_pitches / gear.teeth
    moment = -sum(
        lost_moment_kg_m(gear, one, pair.face_width_m)
        * exp(1j * sense * (tooth_angle_rad(pair, side, one.tooth) + begins_rad))
        for one in lost
    )
    # A gear that moves along -e slides its flank forwards over its mate's.
    horizontal, vertical = -(directions @ structure.meshes[at.number].sliding[0])
    order = sense * at.turning * pair.pinion.teeth / gear.teeth
    return Unbalance(directions, abs(moment), order, phase(moment) + phase(complex(horizontal, vertical)))
