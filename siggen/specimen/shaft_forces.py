"""Forces that come with the rotation of a specimen's shafts: unbalance and tones of bearings."""

from __future__ import annotations

from math import pi

from siggen.config import BearingTones, Config
from siggen.dynamics.drive.excitation import Source
from siggen.dynamics.drive.external_forces import (
    Harmonic,
    HarmonicForce,
    Unbalance,
    bearing_direction,
    shaft_directions,
    turning_sense,
)
from siggen.dynamics.drive.slow_variation import slow_variation
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.transient import TRANSIENT_CAP_S
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import constant
from siggen.planning.plan import PlannedRecord
from siggen.planning.specimen import OperatingPoint, Specimen
from siggen.seeding import Stage, named_generator, named_uniforms

WEAKEST_TONE = 0.2
"""Amplitudes of the tones lie between this share of `level` and all of it, uniform per specimen, tone and axis."""
CAGE_SLIP = (0.01, 0.02)
"""Share by which the cage lags, uniform per record (assumed)."""
JITTER_RAD = 0.5
"""Of the slow wandering of the phases, rms (assumed)."""
JITTER_CORNER_HZ = 1.0
RATED_SPEED_HZ = 50.0
"""Of the pinion shaft, to which a grade of balance belongs; the gear's by the ratio."""
MARGIN_S = 1.0


def force_sources(
    config: Config,
    specimen: Specimen,
    pair: GearPair,
    structure: Structure,
    point: OperatingPoint,
    record: PlannedRecord,
) -> tuple[Source, ...]:
    """Return unbalance and tones where a drawn `dynamics` section has them.

    Raises
    ------
    ValueError
        If the structure has no bearings.
    """
    orders = {"pinion_bearing": 1.0, "gear_bearing": pair.pinion.teeth / pair.gear.teeth}
    sources: list[Source] = []
    if constant(specimen.dynamics.unbalance.grade_mm_s) > 0.0:
        sources += [_unbalance(config, specimen, structure, place, order) for place, order in orders.items()]
    if constant(specimen.dynamics.bearing_tones.level) > 0.0:
        force_n = constant(specimen.dynamics.bearing_tones.level) * point.torque_nm / pair.pinion.base_radius_m
        for place, order in orders.items():
            sources += _tones(config, specimen, structure, record, place, order, force_n)
    return tuple(sources)


def _unbalance(config: Config, specimen: Specimen, structure: Structure, place: str, order: float) -> Unbalance:
    section = specimen.dynamics.unbalance
    uniform = named_uniforms(config.seed, Stage.SUPPORTS, specimen.specimen_id)
    mass_kg = structure.mass[(structure.coordinates.index("x_1" if order == 1.0 else "x_2"),) * 2]
    rated_rad_s = 2.0 * pi * RATED_SPEED_HZ * order
    return Unbalance(
        directions=shaft_directions(structure, place),
        moment_kg_m=float(mass_kg) * 1e-3 * constant(section.grade_mm_s) / rated_rad_s,
        order=order * turning_sense(structure, place),
        phase_rad=2.0 * pi * uniform(f"dynamics.unbalance.{place}.phase"),
    )


def _tones(
    config: Config,
    specimen: Specimen,
    structure: Structure,
    record: PlannedRecord,
    place: str,
    shaft_order: float,
    force_n: float,
) -> list[Source]:
    """Return the tones of one bearing along both axes; phases and slip are the record's, amplitudes the specimen's."""
    section, name = specimen.dynamics.bearing_tones, f"dynamics.bearing_tones.{place}"
    owner = (record.specimen_id, record.state_id, record.operating_point_id, record.repeat)
    share = named_uniforms(config.seed, Stage.BEARING_TONES, specimen.specimen_id)
    course = named_uniforms(config.seed, Stage.DRIVE, *owner)
    low, high = CAGE_SLIP
    orders = tone_orders(section, low + (high - low) * course(f"{name}.slip"))
    rng = named_generator(config.seed, Stage.DRIVE, *owner, name=f"{name}.jitter")
    wander = slow_variation(rng, JITTER_CORNER_HZ, -TRANSIENT_CAP_S - MARGIN_S, config.duration_s + MARGIN_S)
    return [
        HarmonicForce(
            bearing_direction(structure, place, axis),
            tuple(
                Harmonic(
                    force_n * (WEAKEST_TONE + (1.0 - WEAKEST_TONE) * share(f"{name}.{axis}.{tone}")),
                    shaft_order * order,
                    2.0 * pi * course(f"{name}.{axis}.{tone}.phase"),
                    JITTER_RAD,
                )
                for tone, order in orders.items()
            ),
            wander,
        )
        for axis in ("horizontal", "vertical")
    ]


def tone_orders(section: BearingTones, cage_slip: float) -> dict[str, float]:
    """Return the orders of the shaft with a cage that lags by a share of its speed (derived).

    Balls pass the outer race with the cage and spin with it; Z balls pass the inner race at the shaft's speed less the
    cage's: Z (1 - (1 - s) f_c) = f_i + s f_o.
    """
    outer, inner, ball, cage = section.orders
    return {
        "outer_race": outer * (1.0 - cage_slip),
        "inner_race": inner + cage_slip * outer,
        "ball": ball * (1.0 - cage_slip),
        "cage": cage * (1.0 - cage_slip),
    }
