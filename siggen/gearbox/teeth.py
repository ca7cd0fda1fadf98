"""Teeth: those of one mesh as they are drawn, with their errors, waves and damage by state."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, partial
from typing import TypeAlias, TypeVar

from siggen.config import Config, OperatingRange, RotorSection
from siggen.gearbox.flank_waves import SpecimenWaves, drawn_waves
from siggen.gearbox.mesh_damage import LoadsAtRest, MeshDamage, mesh_state
from siggen.gearbox.pair import mesh_options
from siggen.gearbox.tooth_errors import MadeWith, SpecimenErrors, drawn_errors
from siggen.gears.damage.part import Parts
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from siggen.keys.number import bounds, constant
from siggen.names import Side

Made = TypeVar("Made", SpecimenErrors, SpecimenWaves)
Errors: TypeAlias = Callable[[int], SpecimenErrors | None]
Waves: TypeAlias = Callable[[int], SpecimenWaves | None]


@dataclass(frozen=True, slots=True)
class Teeth:
    """Teeth of one mesh.

    Attributes
    ----------
    pair : its gears
    options : how they bend
    largest_force_n : up to which contacts are tabulated
    made : which errors they have; None for perfect gears
    redrawn : whether every state has errors and waves of its own; otherwise all have those of state 0
    errors, waves : state -> those of both gears; None for perfect gears
    damage : state, and what tells how the teeth share a force -> damage of that state
    """

    pair: GearPair
    options: StiffnessOptions
    largest_force_n: float
    made: MadeWith | None
    redrawn: bool
    errors: Errors = field(compare=False)
    waves: Waves = field(compare=False)
    damage: Callable[[int, LoadsAtRest], Parts] = field(compare=False)

    def drawn_for(self, state_id: int) -> int:
        """Return the state whose errors and waves a state has."""
        return state_id if self.redrawn else 0


Drawing: TypeAlias = Callable[[GearPair, Sequence[RotorSection], int, str, float], Teeth]
"""Pair, its rotors, seed of its draws, what damage calls the mesh, turns of its pinion -> teeth of one gearbox."""


def draw_teeth(
    config: Config,
    specimen_id: int,
    bending: StiffnessOptions,
    pair: GearPair,
    rotors: Sequence[RotorSection],
    seed: int,
    mesh: str,
    turning: float,
) -> Teeth:
    """Return the teeth of a mesh.

    Parameters
    ----------
    config : Config of the gearbox
    specimen_id : int
    bending : how teeth of the gearbox bend
    pair : its gears
    rotors : (2,) drawn, of pinion and gear, whose seats lie off their bearings
    seed : int, of its draws
    mesh : what the damage of states calls it
    turning : turns of its pinion per turn of the first one
    """
    section = config.manufacture
    seats_m, made = [1e-6 * constant(rotor.eccentricity_um) for rotor in rotors], None
    if section is not None:
        made = MadeWith(section.has_crowning, section.has_helix, section.flank_waves == "on")

    def errors(state: int) -> SpecimenErrors | None:
        owner = specimen_id, state
        return None if section is None else drawn_errors(section, seats_m, seed, owner, pair)

    def waves(state: int) -> SpecimenWaves | None:
        return None if made is None or not made.waves else drawn_waves(seed, (specimen_id, state), pair)

    return Teeth(
        pair,
        mesh_options(pair, bending),
        largest_force_n(config.operating_points, pair, turning),
        made,
        redrawn=section is not None and section.draw == "state",
        errors=cache(errors),
        waves=cache(waves),
        damage=MeshDamage(seed, specimen_id, pair, cache(partial(mesh_state, config, mesh))),
    )


def mesh_seed(seed: int, name: str) -> int:
    """Return the seed of the draws of a further mesh, by its name."""
    return int.from_bytes(hashlib.sha256(f"{seed} machine.meshes.{name}".encode()).digest()[:8]) >> 1


def sharing(own: Teeth, other: Teeth, side: Side) -> Teeth:
    """Return the teeth of a pair whose pinion or gear is that of another pair, with its damage there alone."""
    return replace(
        own,
        errors=cache(partial(_put_into, own.errors, other.errors, side)),
        waves=cache(partial(_put_into, own.waves, other.waves, side)),
        damage=lambda state, loads: tuple(one for one in other.damage(state, loads) if one.gear == side),
    )


def _put_into(
    own: Callable[[int], Made | None], other: Callable[[int], Made | None], side: Side, drawn_for: int
) -> Made | None:
    mine, theirs = own(drawn_for), other(drawn_for)
    return mine if mine is None or theirs is None else replace(mine, **{side: getattr(theirs, side)})


def on_one_body(own: Teeth, other: Teeth, later_rad: float) -> Teeth:
    """Return teeth whose pinion is the gear of another pair, with other flanks.

    Its axis is `later_rad` on in the phase of errors.
    """
    return replace(own, errors=cache(partial(_on_axis, own.errors, other.errors, later_rad)))


def _on_axis(own: Errors, other: Errors, later_rad: float, drawn_for: int) -> SpecimenErrors | None:
    mine, theirs = own(drawn_for), other(drawn_for)
    if mine is None or theirs is None:
        return mine
    axis, phase = theirs.gear.errors.eccentricity_m, theirs.gear.errors.phase_rad + later_rad
    errors = replace(mine.pinion.errors, eccentricity_m=axis, phase_rad=phase)
    return replace(mine, pinion=replace(mine.pinion, errors=errors))


def largest_force_n(points: Sequence[OperatingRange], pair: GearPair, turning: float = 1.0) -> float:
    """Return the force up to which contacts are tabulated [N]: three times the largest torque's, or the pair's own.

    Points are those of a first pinion; the pair's turns `turning` times as fast. The tables hold the same numbers up to
    any force, so that no operating point acts on the records of another.
    """
    torque = max(abs(1.0 / turning * limit) for point in points for limit in bounds(point.torque_nm))
    return max(3.0 * torque / pair.pinion.base_radius_m, pair.reference_force_n)
