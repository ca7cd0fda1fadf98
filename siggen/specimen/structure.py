"""The gearbox of a drawn specimen as the dynamics sees it: inertias, bearings, couplings and casing in SI."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from siggen.config import Config, Dynamics, RigidHousing
from siggen.config import Coupling as CouplingSection
from siggen.config import Shaft as ShaftSection
from siggen.dynamics.bearings.loaded_bearing import LoadedBearing
from siggen.dynamics.drive.external_forces import shaft_direction
from siggen.dynamics.structure.axial_motion import axial_bearings
from siggen.dynamics.structure.body import Body, modal_body
from siggen.dynamics.structure.casing_structure import carried_structure, casing_body
from siggen.dynamics.structure.gear_stage import Coupling, GearStage
from siggen.dynamics.structure.gear_stage import Rotor as RotorNumbers
from siggen.dynamics.structure.load_lock import locked_load
from siggen.dynamics.structure.planetary import planetary_structure
from siggen.dynamics.structure.structure import Structure, eight_dof, vector
from siggen.dynamics.structure.tilting_shaft import Shaft
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import constant
from siggen.planning.specimen import Specimen
from siggen.specimen.gears import gear_pair
from siggen.specimen.housing import specimen_housing
from siggen.specimen.loaded_bearings import loaded_bearings, on_loaded_bearings
from siggen.specimen.planetary_housing import rigid_housing_of_set, set_in_housing
from siggen.specimen.planetary_numbers import planetary_numbers
from siggen.specimen.rigid_casing import casing_numbers
from siggen.specimen.rotors import rotor_numbers
from siggen.specimen.specimen_housing import coupled_modes
from siggen.specimen.staged_structure import staged_casing, staged_structure


def structure(config: Config, specimen: Specimen) -> Structure:
    """Return the structure of a drawn specimen; a gear without given mass is a steel disc with its bore.

    A planetary set stands on the ground: its frame turns in its housing (`planetary_housing`).
    """
    dynamics, pair, stage = specimen.dynamics, gear_pair(specimen.gears), supported_stage(specimen)
    if specimen.planetary is not None:
        return planetary_structure(planetary_numbers(specimen))
    body = specimen_body(config, specimen) if dynamics.model == "casing" else None
    if specimen.stages:
        found = staged_structure(stage, specimen, body)
    elif body is None:
        return eight_dof(stage)
    else:
        found = carried_structure(stage, body, _shafts(dynamics, stage, pair))
    if specimen_housing(config, specimen) is None:
        return found
    # Modes below some frequency are not what is seen of a housing: sensors take all of them (`instrument`).
    shafts = {name.replace("bearing", "shaft"): shaft_direction(found, name) for name in found.bearing_directions}
    return replace(found, motions=shafts)


def moved_along(specimen: Specimen) -> tuple[str, ...]:
    """Return the motions along the shafts that sensors on them see: of helical teeth on bearings on the ground."""
    grounded = specimen.dynamics.model == "8dof" and not specimen.stages and specimen.planetary is None
    return tuple(axial_bearings(gear_stage(specimen.dynamics, gear_pair(specimen.gears)))) if grounded else ()


def linear_structure(config: Config, specimen: Specimen) -> tuple[Structure, Body | None]:
    """Return the structure on which small forces act, and what carries its bearings; it moves as its body does.

    The load is held softly: otherwise nothing would keep the shafts from turning away.
    """
    housed = specimen.dynamics.model == "casing"
    body = specimen_body(config, specimen) if housed else None
    assembled = structure(config, specimen) if specimen.planetary is None else set_in_housing(specimen, body)
    assembled = locked_load(assembled)
    if body is None:
        return assembled, None
    motions = {name: vector(assembled.coordinates, row) for name, row in body.motions.items()}
    return replace(assembled, motions=motions), body


def supported_stage(specimen: Specimen) -> GearStage:
    """Return the stage of a drawn specimen on its bearings, those that follow the load under that of its point."""
    stage = gear_stage(specimen.dynamics, gear_pair(specimen.gears))
    return on_loaded_bearings(stage, specimen_bearings(specimen))


def specimen_bearings(specimen: Specimen) -> dict[str, LoadedBearing]:
    """Return one of both bearings of each shaft whose stiffness follows the load."""
    if specimen.bearing_point is None:
        return {}
    pair, torque_nm = gear_pair(specimen.gears), specimen.bearing_point.torque_nm
    return loaded_bearings(specimen.dynamics, gear_stage(specimen.dynamics, pair), pair, torque_nm)


@lru_cache(maxsize=4)  # structure and background of a gearbox ask for it
def specimen_body(config: Config, specimen: Specimen) -> Body:
    """Return the body that carries the bearings of a specimen, sensors and entries on it included."""
    pair, housing = gear_pair(specimen.gears), specimen_housing(config, specimen)
    if housing is not None:
        upright = specimen.stages or specimen.planetary is not None  # coordinates of others follow their line of action
        return modal_body(coupled_modes(housing), 0.0 if upright else pair.working_pressure_angle_rad)
    if specimen.planetary is not None:
        return rigid_housing_of_set(specimen)
    if specimen.stages:
        return staged_casing(specimen)
    assert isinstance(specimen.housing, RigidHousing)
    casing = casing_numbers(specimen.housing, pair.working_centre_distance_m, specimen.sensors)
    body = casing_body(gear_stage(specimen.dynamics, pair), casing)
    # Of a second mesh a rigid casing feels the moment alone: the force times the distance of both lines of action.
    arm_m = pair.pinion.base_radius_m + pair.gear.base_radius_m
    return replace(body, entries={**body.entries, "second_stage": {"phi_c": arm_m}})


def gear_stage(dynamics: Dynamics, pair: GearPair) -> GearStage:
    """Return motor, gears and load of a drawn `dynamics` section in SI."""
    return GearStage(
        working_pressure_angle_rad=pair.working_pressure_angle_rad,
        pinion=rotor_numbers(dynamics.pinion, pair.pinion, pair.face_width_m),
        gear=rotor_numbers(dynamics.gear, pair.gear, pair.face_width_m),
        motor_inertia_kg_m2=constant(dynamics.motor_inertia_kg_m2),
        load_inertia_kg_m2=constant(dynamics.load_inertia_kg_m2),
        input_coupling=_coupling(dynamics.input_coupling),
        output_coupling=_coupling(dynamics.output_coupling),
        base_helix_rad=pair.base_helix_rad,
    )


def _shafts(dynamics: Dynamics, stage: GearStage, pair: GearPair) -> tuple[Shaft, Shaft] | None:
    """Return the shafts that bend, each with the moment of inertia of its gear about a diameter: J/2 + m b²/12."""
    if dynamics.shafts is None:
        return None
    pairs = ((dynamics.shafts.pinion, stage.pinion), (dynamics.shafts.gear, stage.gear))
    pinion, gear = (_shaft(section, rotor, pair) for section, rotor in pairs)
    return pinion, gear


def _shaft(section: ShaftSection, rotor: RotorNumbers, pair: GearPair) -> Shaft:
    return Shaft(
        span_m=1e-3 * constant(section.bearing_span_mm),
        gear_share=constant(section.gear_position),
        diameter_m=1e-3 * constant(section.diameter_mm),
        youngs_modulus_pa=pair.youngs_modulus_pa,
        poisson_ratio=pair.poisson_ratio,
        tilt_inertia_kg_m2=0.5 * rotor.inertia_kg_m2 + rotor.mass_kg * pair.face_width_m**2 / 12.0,
    )


def _coupling(section: CouplingSection) -> Coupling:
    return Coupling(constant(section.stiffness_nm_per_rad), constant(section.damping_nm_s_per_rad))
