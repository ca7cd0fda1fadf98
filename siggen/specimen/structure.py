"""The gearbox of a drawn specimen as the dynamics sees it: inertias, bearings, couplings and casing in SI."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from siggen.config import Config, Dynamics
from siggen.config import Coupling as CouplingSection
from siggen.config import Shaft as ShaftSection
from siggen.dynamics.bearings.loaded_bearing import LoadedBearing
from siggen.dynamics.drive.external_forces import shaft_direction
from siggen.dynamics.structure.drivetrain import TURNING, Drivetrain, Place, Way
from siggen.dynamics.structure.gear_stage import Coupling, GearStage, Shaft
from siggen.dynamics.structure.gear_stage import Rotor as RotorNumbers
from siggen.dynamics.structure.load_lock import locked_load
from siggen.dynamics.structure.makers import Housing, planetary_train, train
from siggen.dynamics.structure.structure import Structure, assembled
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import constant
from siggen.planning.specimen import Specimen
from siggen.specimen.gears import gear_pair
from siggen.specimen.housing import specimen_housing
from siggen.specimen.loaded_bearings import loaded_bearings, on_loaded_bearings
from siggen.specimen.planetary_housing import rigid_housing_of_set, set_in_housing
from siggen.specimen.planetary_numbers import planetary_numbers
from siggen.specimen.rotors import rotor_numbers
from siggen.specimen.specimen_housing import moving_with_gears
from siggen.specimen.staged_structure import casing_round_shafts, next_stages


def structure(config: Config, specimen: Specimen) -> Structure:
    """Return the structure of a drawn specimen; a gear without given mass is a steel disc with its bore.

    A planetary set stands on the ground: its frame turns in its housing (`planetary_housing`).
    """
    if specimen.planetary is not None:
        return assembled(planetary_train(planetary_numbers(specimen)))
    found = assembled(specimen_train(specimen, specimen_body(config, specimen)))
    if specimen_housing(config, specimen) is None:
        return found
    # Modes below some frequency are not what is seen of a housing: sensors take all of them (`instrument`).
    shafts = {name.replace("bearing", "shaft"): shaft_direction(found, name) for name in found.bearing_directions}
    return replace(found, motions=shafts)


def specimen_train(specimen: Specimen, housing: Housing | None) -> Drivetrain:
    """Return a drawn train of pairs in a housing, or on the ground."""
    stage = supported_stage(specimen)
    bending = _shafts(specimen.dynamics, stage, gear_pair(specimen.gears)) if housing and not specimen.stages else None
    return train(stage, next_stages(specimen), housing, bending, specimen.names)


def moved_along(specimen: Specimen) -> tuple[str, ...]:
    """Return the motions along the shafts that sensors on them see: of helical teeth on bearings on the ground."""
    grounded = specimen.dynamics.model == "8dof" and not specimen.stages and specimen.planetary is None
    helical = gear_pair(specimen.gears).base_helix_rad != 0.0
    return tuple(f"{shaft.bearing}/axial" for shaft in specimen.names.shafts) if grounded and helical else ()


def linear_train(config: Config, specimen: Specimen) -> Drivetrain:
    """Return the machine on which small forces act, with what carries its bearings; it is seen where that moves."""
    housing = specimen_body(config, specimen)
    return specimen_train(specimen, housing) if specimen.planetary is None else set_in_housing(specimen, housing)


def linear_structure(drivetrain: Drivetrain) -> Structure:
    """Return a machine whose load is held softly: otherwise nothing would keep the shafts from turning away."""
    return locked_load(assembled(drivetrain))


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
def specimen_body(config: Config, specimen: Specimen) -> Housing | None:
    """Return what carries the bearings of a specimen, sensors and entries on it included; None for the ground."""
    if specimen.dynamics.model != "casing":
        return None
    pair, modes = gear_pair(specimen.gears), specimen_housing(config, specimen)
    if modes is not None:
        return moving_with_gears(modes)
    if specimen.planetary is not None:
        return rigid_housing_of_set(specimen)
    housing = casing_round_shafts(specimen)
    if specimen.stages:
        return housing
    # Of a second mesh a rigid casing feels the moment alone: the force times the distance of both lines of action.
    arm_m = pair.pinion.base_radius_m + pair.gear.base_radius_m
    moment = Way(Place(housing.body.name), TURNING, arm_m)
    return replace(housing, entries={**housing.entries, "second_stage": moment})


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
