"""From drawn sections to the rotors, shafts, couplings and bearings of a train in SI."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from siggen.config import CouplingSection, Dynamics, RotorSection, ShaftSection, Stage
from siggen.dynamics.bearings.ball_bearing import BallBearing
from siggen.dynamics.structure.gear_stage import Bearing, CommonShaft, Coupling, GearStage, NextStage, Rotor, Shaft
from siggen.dynamics.structure.steel_disc import disc_inertia_kg_m2, disc_mass_kg
from siggen.gearbox.specimen import ToothMesh
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.keys.number import constant, each_of
from siggen.names import Side


def gear_stage(dynamics: Dynamics, pair: GearPair) -> GearStage:
    """Return motor, gears and load of a drawn section; a gear without given mass is a steel disc with its bore."""
    return GearStage(
        working_pressure_angle_rad=pair.working_pressure_angle_rad,
        pinion=rotor_numbers(dynamics.pinion, pair.pinion, pair.face_width_m),
        gear=rotor_numbers(dynamics.gear, pair.gear, pair.face_width_m),
        motor_inertia_kg_m2=constant(dynamics.motor_inertia_kg_m2),
        load_inertia_kg_m2=constant(dynamics.load_inertia_kg_m2),
        input_coupling=coupling_numbers(dynamics.input_coupling),
        output_coupling=coupling_numbers(dynamics.output_coupling),
        base_helix_rad=pair.base_helix_rad,
    )


def rotor_numbers(section: RotorSection, gear: SpurGear, face_width_m: float) -> Rotor:
    """Return a gear with both bearings of its shaft."""
    mass, inertia, bearing = section.mass_kg, section.inertia_kg_m2, section.bearing
    stiffness_x, stiffness_y = map(constant, each_of(bearing.stiffness_n_per_m, 2))
    time_s = None if bearing.damping_time_s is None else constant(bearing.damping_time_s)
    if time_s is not None:
        damping_x, damping_y = time_s * stiffness_x, time_s * stiffness_y
    else:
        damping_x, damping_y = map(constant, each_of(bearing.damping_n_s_per_m, 2))
    return Rotor(
        base_radius_m=gear.base_radius_m,
        mass_kg=disc_mass_kg(gear, face_width_m) if mass is None else constant(mass),
        inertia_kg_m2=disc_inertia_kg_m2(gear, face_width_m) if inertia is None else constant(inertia),
        bearing=Bearing(
            stiffness_x,
            stiffness_y,
            damping_x,
            damping_y,
            stiffness_z_n_per_m=constant(bearing.axial_stiffness_n_per_m),
            damping_time_s=time_s,
        ),
    )


def coupling_numbers(section: CouplingSection) -> Coupling:
    """Return a torsional shaft with its coupling."""
    return Coupling(constant(section.stiffness_nm_per_rad), constant(section.damping_nm_s_per_rad))


def ball_bearings(dynamics: Dynamics) -> tuple[tuple[Side, BallBearing], ...]:
    """Return each of both bearings of the shafts, pinion and gear, whose stiffness follows the load."""
    sections = {Side.DRIVER: dynamics.pinion.bearing.geometry, Side.DRIVEN: dynamics.gear.bearing.geometry}
    return tuple((side, section.bearing()) for side, section in sections.items() if section is not None)


def bending_shafts(dynamics: Dynamics, stage: GearStage, pair: GearPair) -> tuple[Shaft, Shaft] | None:
    """Return the shafts that bend, each with the moment of inertia of its gear about a diameter: J/2 + m b²/12."""
    if dynamics.shafts is None:
        return None
    pairs = ((dynamics.shafts.driver, stage.pinion), (dynamics.shafts.driven, stage.gear))
    pinion, gear = (shaft_numbers(section, rotor, pair) for section, rotor in pairs)
    return pinion, gear


def shaft_numbers(section: ShaftSection, rotor: Rotor, pair: GearPair) -> Shaft:
    """Return a shaft that bends, with its gear."""
    return Shaft(
        span_m=1e-3 * constant(section.bearing_span_mm),
        gear_share=constant(section.gear_position),
        diameter_m=1e-3 * constant(section.diameter_mm),
        youngs_modulus_pa=pair.youngs_modulus_pa,
        poisson_ratio=pair.poisson_ratio,
        tilt_inertia_kg_m2=0.5 * rotor.inertia_kg_m2 + rotor.mass_kg * pair.face_width_m**2 / 12.0,
    )


def next_stages(dynamics: Dynamics, stages: Sequence[Stage], meshes: Sequence[ToothMesh]) -> Iterator[NextStage]:
    """Yield the further meshes; a shaft is as thick as the thinner bore of its two gears."""
    # a pinion is a disc, or the gear in front where it is that
    front = [dynamics.gear, *(stage.gear for stage in stages)]
    for stage, seat, (before, mesh) in zip(stages, front, pairwise(meshes), strict=False):
        pair, width_m = mesh.pair, (before if mesh.idler else mesh).pair.face_width_m
        yield NextStage(
            working_pressure_angle_rad=pair.working_pressure_angle_rad,
            pinion=rotor_numbers(seat if mesh.idler else RotorSection(), pair.pinion, width_m),
            gear=rotor_numbers(stage.gear, pair.gear, pair.face_width_m),
            shaft=None if mesh.idler else _common_shaft(stage, before.pair, pair),
            direction_rad=mesh.direction_rad,
        )


def _common_shaft(stage: Stage, before: GearPair, pair: GearPair) -> CommonShaft:
    span_m = 2.0 * (before.face_width_m + pair.face_width_m)
    return CommonShaft(
        span_m=span_m if isinstance(stage.span_mm, str | None) else 1e-3 * constant(stage.span_mm),
        diameter_m=2.0 * min(before.gear.bore_radius_m, pair.pinion.bore_radius_m),
        youngs_modulus_pa=pair.youngs_modulus_pa,
        poisson_ratio=pair.poisson_ratio,
    )
