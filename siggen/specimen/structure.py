"""The gearbox of a drawn specimen as the dynamics sees it: inertias, bearings, couplings and casing in SI."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import pi, radians

from siggen.config import Config, Dynamics, PlainRotor, RigidHousing, Stage
from siggen.config import Coupling as CouplingSection
from siggen.config import Shaft as ShaftSection
from siggen.dynamics.bearings.loaded_bearing import LoadedBearing
from siggen.dynamics.drive.external_forces import shaft_direction
from siggen.dynamics.structure.body import Body, Bolts, Casing, Point, modal_body
from siggen.dynamics.structure.casing_structure import carried_structure, casing_body, torsional
from siggen.dynamics.structure.drivetrain import CommonShaft, NextStage, drivetrain
from siggen.dynamics.structure.load_lock import locked_load
from siggen.dynamics.structure.structure import (
    Bearing,
    Coupling,
    SpurStage,
    Structure,
    eight_dof,
    six_dof,
    vector,
)
from siggen.dynamics.structure.structure import Rotor as RotorNumbers
from siggen.dynamics.structure.tilting_shaft import Shaft
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.keys.number import Number, constant
from siggen.planning.specimen import Specimen
from siggen.rig.rig_numbers import STEEL_DENSITY_KG_M3
from siggen.sensors.sensor import Sensor
from siggen.specimen.gears import gear_pair
from siggen.specimen.housing import specimen_housing
from siggen.specimen.loaded_bearings import loaded_bearings, on_loaded_bearings
from siggen.specimen.specimen_housing import coupled_modes

CASING_GYRATION = 1.15
"""Radius of gyration of a casing over its centre distance: a box of even wall round the gears (derived)."""
ASSEMBLIES = {"8dof": eight_dof, "6dof": six_dof, "torsional": torsional}


def structure(config: Config, specimen: Specimen) -> Structure:
    """Return the structure of a drawn specimen; a gear without given mass is a steel disc with its bore."""
    dynamics, pair, stage = specimen.dynamics, gear_pair(specimen.gears), supported_stage(specimen)
    if specimen.stages:
        return drivetrain(stage, _next_stages(specimen))
    if dynamics.model != "casing":
        return ASSEMBLIES[dynamics.model](stage)
    found = carried_structure(stage, specimen_body(config, specimen), _shafts(dynamics, stage, pair))
    if specimen_housing(config, specimen) is None:
        return found
    # Modes below some frequency are not what is seen of a housing: sensors take all of them (`instrument`).
    shafts = {name.replace("bearing", "shaft"): shaft_direction(found, name) for name in found.bearing_directions}
    return replace(found, motions=shafts)


def _next_stages(specimen: Specimen) -> list[NextStage]:
    """Return the further meshes in SI; a shaft is as thick as the thinner bore of its two gears."""
    pairs = [gear_pair(specimen.gears), *(gear_pair(stage.gears) for stage in specimen.stages)]
    return [
        NextStage(
            name=stage.name,
            working_pressure_angle_rad=pair.working_pressure_angle_rad,
            pinion=_rotor(PlainRotor(), pair.pinion, pair.face_width_m),
            gear=_rotor(stage.gear, pair.gear, pair.face_width_m),
            shaft=_common_shaft(stage, before, pair),
            direction_rad=radians(constant(stage.direction_deg)),
        )
        for stage, before, pair in zip(specimen.stages, pairs, pairs[1:], strict=False)
    ]


def _common_shaft(stage: Stage, before: GearPair, pair: GearPair) -> CommonShaft:
    span_m = 2.0 * (before.face_width_m + pair.face_width_m)
    return CommonShaft(
        span_m=span_m if stage.span_mm is None else 1e-3 * constant(stage.span_mm),
        diameter_m=2.0 * min(before.gear.bore_radius_m, pair.pinion.bore_radius_m),
        youngs_modulus_pa=pair.youngs_modulus_pa,
        poisson_ratio=pair.poisson_ratio,
    )


def linear_structure(config: Config, specimen: Specimen) -> tuple[Structure, Body | None]:
    """Return the structure on which small forces act, and what carries its bearings; it moves as its body does.

    The load is held softly: otherwise nothing would keep the shafts from turning away.
    """
    assembled = locked_load(structure(config, specimen))
    if specimen.dynamics.model != "casing":
        return assembled, None
    body = specimen_body(config, specimen)
    motions = {name: vector(assembled.coordinates, row) for name, row in body.motions.items()}
    return replace(assembled, motions=motions), body


def supported_stage(specimen: Specimen) -> SpurStage:
    """Return the stage of a drawn specimen on its bearings, those that follow the load under that of its point."""
    stage = spur_stage(specimen.dynamics, gear_pair(specimen.gears))
    return on_loaded_bearings(stage, specimen_bearings(specimen))


def specimen_bearings(specimen: Specimen) -> dict[str, LoadedBearing]:
    """Return one of both bearings of each shaft whose stiffness follows the load."""
    if specimen.bearing_point is None:
        return {}
    pair, torque_nm = gear_pair(specimen.gears), specimen.bearing_point.torque_nm
    return loaded_bearings(specimen.dynamics, spur_stage(specimen.dynamics, pair), pair, torque_nm)


def specimen_body(config: Config, specimen: Specimen) -> Body:
    """Return the body that carries the bearings of a specimen, sensors and entries on it included."""
    pair = gear_pair(specimen.gears)
    housing = specimen_housing(config, specimen)
    if housing is not None:
        return modal_body(coupled_modes(housing), pair.working_pressure_angle_rad)
    assert isinstance(specimen.housing, RigidHousing)
    body = casing_body(spur_stage(specimen.dynamics, pair), casing_numbers(specimen.housing, pair, specimen.sensors))
    # Of a second mesh a rigid casing feels the moment alone: the force times the distance of both lines of action.
    arm_m = pair.pinion.base_radius_m + pair.gear.base_radius_m
    return replace(body, entries={**body.entries, "second_stage": {"phi_c": arm_m}})


def spur_stage(dynamics: Dynamics, pair: GearPair) -> SpurStage:
    """Return motor, gears and load of a drawn `dynamics` section in SI."""
    return SpurStage(
        working_pressure_angle_rad=pair.working_pressure_angle_rad,
        pinion=_rotor(dynamics.pinion, pair.pinion, pair.face_width_m),
        gear=_rotor(dynamics.gear, pair.gear, pair.face_width_m),
        motor_inertia_kg_m2=constant(dynamics.motor_inertia_kg_m2),
        load_inertia_kg_m2=constant(dynamics.load_inertia_kg_m2),
        input_coupling=_coupling(dynamics.input_coupling),
        output_coupling=_coupling(dynamics.output_coupling),
    )


def disc_mass_kg(gear: SpurGear, face_width_m: float) -> float:
    """Return the mass [kg] of a steel disc of the gear's pitch circle with its bore."""
    return STEEL_DENSITY_KG_M3 * pi * (gear.pitch_radius_m**2 - gear.bore_radius_m**2) * face_width_m


def disc_inertia_kg_m2(gear: SpurGear, face_width_m: float) -> float:
    """Return the moment of inertia [kg m^2] of the same disc about its axis."""
    return 0.5 * disc_mass_kg(gear, face_width_m) * (gear.pitch_radius_m**2 + gear.bore_radius_m**2)


def _rotor(section: PlainRotor, gear: SpurGear, face_width_m: float) -> RotorNumbers:
    mass, inertia = section.mass_kg, section.inertia_kg_m2
    return RotorNumbers(
        base_radius_m=gear.base_radius_m,
        mass_kg=disc_mass_kg(gear, face_width_m) if mass is None else constant(mass),
        inertia_kg_m2=disc_inertia_kg_m2(gear, face_width_m) if inertia is None else constant(inertia),
        bearing=Bearing(
            stiffness_x_n_per_m=constant(section.bearing_stiffness_x_n_per_m),
            stiffness_y_n_per_m=constant(section.bearing_stiffness_y_n_per_m),
            damping_x_n_s_per_m=constant(section.bearing_damping_x_n_s_per_m),
            damping_y_n_s_per_m=constant(section.bearing_damping_y_n_s_per_m),
        ),
    )


def _shafts(dynamics: Dynamics, stage: SpurStage, pair: GearPair) -> tuple[Shaft, Shaft] | None:
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


def casing_numbers(section: RigidHousing, pair: GearPair, sensors: Sequence[Sensor]) -> Casing:
    """Return a drawn casing in SI."""
    bolts, inertia = section.bolts, section.inertia_kg_m2
    mass, gyration_m = constant(section.mass_kg), CASING_GYRATION * pair.working_centre_distance_m
    return Casing(
        mass_kg=mass,
        inertia_kg_m2=mass * gyration_m**2 if inertia is None else constant(inertia),
        bolts=Bolts(
            shear_stiffness_n_per_m=constant(bolts.shear_stiffness_n_per_m),
            axial_stiffness_n_per_m=constant(bolts.axial_stiffness_n_per_m),
            damping_ratio=constant(bolts.damping_ratio),
            places_m=tuple(_metres(place) for place in bolts.positions_mm),
            loose_share=constant(section.loose_foot_share),
        ),
        pinion_place_m=(0.5 * pair.working_centre_distance_m, 0.0),
        sensor_places_m={s.name: _sensor_metres(s.place_on_casing_mm) for s in sensors if s.place_on_casing_mm},
    )


def _sensor_metres(position_mm: tuple[Number, ...]) -> Point:
    horizontal, vertical = (constant(number) for number in position_mm)
    return _metres((horizontal, vertical))


def _metres(position_mm: tuple[float, float]) -> Point:
    return 1e-3 * position_mm[0], 1e-3 * position_mm[1]
