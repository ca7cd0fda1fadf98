"""Teeth: those of one mesh as they are drawn, with their errors, waves and damage by state."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, partial
from math import pi
from typing import TypeAlias, TypeVar

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Config, Dynamics, Friction, Manufacture, OperatingRange, Pair, RotorSection, Stiffness, Wheel
from siggen.damage.part import Parts
from siggen.gearbox.flank_waves import SpecimenWaves, drawn_waves
from siggen.gearbox.mesh_damage import LoadsAtRest, MeshDamage, mesh_state
from siggen.gears.errors import (
    Draws,
    FlankDeviations,
    GearErrors,
    Helix,
    deviations,
    drawn_helix,
    error_shapes,
    gear_errors,
    off_axis,
    straight_helix,
    with_errors,
)
from siggen.gears.face_shares import FaceShares
from siggen.gears.gear_pair import STEEL_PA, STEEL_POISSON, GearPair, SpurGear
from siggen.gears.missing_material import MissingMaterial
from siggen.gears.planetary import InternalPair
from siggen.gears.spur_gear import transverse_gear
from siggen.gears.tolerances import FlankTolerances, flank_tolerances
from siggen.keys.distributions import Uniform
from siggen.keys.drawing import draw
from siggen.keys.number import MIDDLE, at, bounds, constant
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_law import DampingLaw, FlankFriction, ToothLaw
from siggen.names import Side
from siggen.seeding import Stream, named_generator

# From drawn sections (mm, degrees) to gear pairs in SI, and how their teeth bend.


def gear_pair(gears: Pair) -> GearPair:
    """Return the gear pair of a drawn section `gears`.

    Raises
    ------
    TypeError
        If a number of the section is still a distribution.
    """
    distance_mm = gears.centre_distance_mm
    return GearPair(
        pinion=_spur_gear(gears, gears.pinion),
        gear=_spur_gear(gears, gears.gear),
        face_width_m=constant(gears.face_width_mm) / 1e3,
        youngs_modulus_pa=STEEL_PA,
        poisson_ratio=STEEL_POISSON,
        centre_distance_m=None if distance_mm is None else constant(distance_mm) / 1e3,
        helix_rad=math.radians(constant(gears.helix_deg)),
    )


def _spur_gear(gears: Pair, wheel: Wheel) -> SpurGear:
    normal = SpurGear(
        teeth=wheel.teeth,
        module_m=constant(gears.module_mm) / 1e3,
        pressure_angle_rad=math.radians(constant(gears.pressure_angle_deg)),
        profile_shift=constant(wheel.profile_shift),
        addendum_coefficient=1.0,
        clearance_coefficient=0.25,
        bore_radius_m=constant(wheel.bore_radius_mm) / 1e3,
    )
    return transverse_gear(normal, math.radians(constant(gears.helix_deg)))


def stiffness_options(stiffness: Stiffness) -> StiffnessOptions:
    """Return the options of the stiffness model that a section `stiffness` names."""
    # the plain sum of pairs belongs to models of the literature
    return StiffnessOptions(stiffness.beam, coupling="body" if stiffness.beam == "calibrated" else "none")


def mesh_options(pair: GearPair, options: StiffnessOptions) -> StiffnessOptions:
    """Return the options of one pair of a gearbox: in a ring neighbours do not act on each other."""
    return replace(options, coupling="none") if isinstance(pair, InternalPair) else options


# Manufacturing errors of a mesh as they are drawn: both gears, their helices, and how their shafts stand.

RUNOUT_SHARE = Uniform(low=0.3, high=0.8)
"""Runout over what class and tolerance share allow; the first harmonic of the pitch deviations (assumed)."""
PROFILE_WAVES = Uniform(low=2.5, high=3.5)
"""Cycles of the profile's form over the flank, for each tooth (assumed)."""
HELIX_WAVES = Uniform(low=0.7, high=2.0)
"""Cycles of the helix form over the face (assumed)."""


@dataclass(frozen=True, slots=True)
class MadeGear:
    """One gear as it was made: its class and tolerances, how much of them it uses, its errors, what a machine finds.

    `helix`: crowning, slope and form across the face, alike on all teeth.
    """

    accuracy_class: int
    tolerance_share: float
    tolerances: FlankTolerances
    errors: GearErrors
    found: FlankDeviations
    helix: Helix


@dataclass(frozen=True, slots=True)
class MadeWith:
    """Whether gears of a set have crownings, slopes and forms of helices, and waves beside their other errors."""

    crowned: bool
    helices: bool
    waves: bool


@dataclass(frozen=True, slots=True)
class SpecimenErrors:
    """Both gears, and how far their flanks are apart at the far end of the face when they touch at the near one [m].

    `shafts_m` is the part of that distance that no helix slope of `MadeGear.helix` has.
    """

    pinion: MadeGear
    gear: MadeGear
    shafts_m: float

    @property
    def lead_misalignment_m(self) -> float:
        """Distance at the far end that shafts and helix slopes make together [m]; its sign is the end."""
        return self.shafts_m + self.pinion.helix.slope_m + self.gear.helix.slope_m

    @property
    def even(self) -> bool:
        """Whether nothing is missing anywhere across the face."""
        return self.shafts_m == 0.0 and self.pinion.helix.straight and self.gear.helix.straight

    def lead_m(self, slices: int) -> FloatArray:
        """Return what is missing in the middle of every slice of the face (slices,) [m]: F_β (w/L - 1/2) and helices.

        Crowning counts from the middle of the face, everything else from its mean.
        """
        place = (np.arange(slices) + 0.5) / slices
        lead = self.shafts_m * (place - 0.5)
        for helix in (made.helix for made in (self.pinion, self.gear) if not made.helix.straight):
            lead = lead + helix.missing_m(place)
        return lead


def drawn_errors(
    section: Manufacture, seats_m: Sequence[float], seed: int, owner: tuple[int, int], pair: GearPair
) -> SpecimenErrors:
    """Return the errors of pinion and gear of a mesh whose draws have this seed and owner, gearbox and state.

    Every draw has a name, so neither other keys nor the other gear shift it.

    Parameters
    ----------
    section : Manufacture
    seats_m : (2,) how far the seats of pinion and gear lie off their bearings [m]
    seed : int
    owner : gearbox, and the state for which the errors are drawn
    pair : GearPair

    Raises
    ------
    ValueError
        If a gear lies outside the range of ISO 1328-1.
    """

    def draws(name: str) -> np.random.Generator:
        return named_generator(seed, Stream.MANUFACTURE, *owner, name=f"manufacture.{name}")

    pinion, gear = (_made(section, pair, side, seat, draws) for side, seat in zip(Side, seats_m, strict=True))
    shafts_m = _shafts_m(section, (pinion, gear), draws)
    return SpecimenErrors(pinion, gear, shafts_m)


def erroneous_teeth(
    missing: MissingMaterial, pair: GearPair, errors: SpecimenErrors | None, shares: FaceShares | None
) -> MissingMaterial:
    """Return the missing material of the same teeth with their errors; `shares` of helical teeth alone."""
    return missing if errors is None else with_errors(missing, pair, errors.pinion.errors, errors.gear.errors, shares)


def lead_of(errors: SpecimenErrors | None) -> Callable[[int], FloatArray] | None:
    """Return what gives the missing material of the slices of the face; None where nothing is missing across it."""
    return None if errors is None or errors.even else errors.lead_m


def _made(section: Manufacture, pair: GearPair, side: Side, seat_m: float, draws: Draws) -> MadeGear:
    def uniform(name: str) -> float:
        return float(draws(f"{side}.{name}").random())

    number = section.accuracy_class if side == Side.DRIVER else section.gear_class
    accuracy_class, share = round(at(number, uniform("accuracy_class"))), at(section.tolerance_share, uniform("share"))
    tolerances = flank_tolerances(pair.member(side), pair.face_width_m, accuracy_class, pair.helix_rad)
    of_teeth = draws(f"{side}.waves").random(pair.member(side).teeth)
    waves = np.array([PROFILE_WAVES.at(float(u)) for u in of_teeth])
    shapes = error_shapes(waves, lambda name: draws(f"{side}.{name}"))
    errors = gear_errors(pair, side, shapes, tolerances.times(share), RUNOUT_SHARE.at(uniform("runout_share")))
    errors = off_axis(errors, seat_m, 2.0 * pi * uniform("eccentricity_angle"))
    helix = _helix(section, side, tolerances.times(share), uniform)
    return MadeGear(accuracy_class, share, tolerances, errors, deviations(pair, side, errors), helix)


def _helix(section: Manufacture, side: Side, limits: FlankTolerances, uniform: Callable[[str], float]) -> Helix:
    """Return a helix; its slope has the draw that `lead_misalignment_um: iso_1328` takes it from."""
    number = section.crowning_um if side == Side.DRIVER else section.crowning_of_gear
    crowning = 1e-6 * at(number, uniform("crowning_um"))
    if not section.has_helix:
        return straight_helix(crowning)
    waves, phase = HELIX_WAVES.at(uniform("helix_waves")), 2.0 * pi * uniform("helix_form")
    return drawn_helix(crowning, 2.0 * uniform("helix") - 1.0, waves, phase, limits)


def _shafts_m(section: Manufacture, gears: tuple[MadeGear, MadeGear], draws: Draws) -> float:
    """Return the drawn misalignment with its sign, as likely the one as the other."""
    if section.lead_misalignment_um == "iso_1328":
        ends = (2.0 * float(draws(f"{side}.helix").random()) - 1.0 for side in Side)
        slopes = (made.tolerance_share * made.tolerances.helix_slope_m for made in gears)
        return sum(end * slope for end, slope in zip(ends, slopes, strict=True))
    size = 1e-6 * at(section.lead_misalignment_um, float(draws("lead_misalignment_um").random()))  # type: ignore[arg-type]
    # The zero makes 0.0 of -0.0.
    return (size if draws("lead_end").random() < 0.5 else -size) + 0.0


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


# From a drawn section `dynamics` to the law of the meshes in SI.


def tooth_law(dynamics: Dynamics) -> ToothLaw:
    """Return how the teeth of a drawn section push and rub."""
    mesh, ratio = dynamics.mesh, constant(dynamics.mesh_damping_ratio)
    shares = mesh.structure_damping_ratio, mesh.film_damping_ratio, mesh.asperity_damping_ratio
    return ToothLaw(
        kind=mesh.law,
        method=dynamics.method,
        steps_per_sample=dynamics.steps_per_sample,
        tolerance=dynamics.integration_tolerance,
        damping_ratio=ratio,
        damping=ratio if mesh.damping == "constant" else DampingLaw(*map(constant, shares)),
        backlash_m=1e-6 * constant(dynamics.backlash_um),
        relief_m=1e-6 * constant(mesh.tip_relief_um),
        relief_pitches=constant(mesh.tip_relief_pitches),
        edge_radius_m=1e-3 * constant(mesh.pit_edge_radius_mm),
        section_loss=mesh.damage == "all",
        tilts=dynamics.shafts is not None,
        friction=_flank_friction(dynamics.friction, dynamics.rubbing),
    )


def typical_tooth_law() -> ToothLaw:
    """Return how teeth push and rub where a file says nothing of it, at the middle of what is drawn."""
    return tooth_law(draw(Dynamics(), lambda _: MIDDLE, "dynamics"))


TYPICAL_OIL_C = 50.0
"""Where no file gives it, until a gearbox stands at an operating point."""


def _flank_friction(section: Friction, model: str) -> FlankFriction:
    return FlankFriction(
        model=model,
        coefficient=constant(section.coefficient),
        oil=str(section.oil),
        oil_temperature_c=constant(TYPICAL_OIL_C if section.oil_temperature_c is None else section.oil_temperature_c),
        roughness_m=1e-6 * constant(section.roughness_um),
        pit_roughness_m=1e-6 * constant(section.pit_roughness_um),
        boundary_friction=constant(section.boundary_friction),
    )
