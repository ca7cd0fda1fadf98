"""The housing of one specimen that gives way: from its geometry, or from modes that its user gave."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from math import pi

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.housing.modes import TableModes, table_motion
from siggen.dynamics.housing.motion import WallMotion
from siggen.dynamics.structure.makers import SEATS_OF_SET
from siggen.gearbox.housing import Block, Plates
from siggen.gearbox.mode_table import BASE, DRIVE, ModeTable, seats_of
from siggen.gearbox.specimen import Specimen
from siggen.specimen.planetary_housing import rigid_housing_of_set, slowest_decay_per_s
from siggen.specimen.plate_housing import damped_modes, plate_housing
from siggen.specimen.specimen_housing import BoltMotions, SpecimenHousing, modes_settle_s, second_stage, settle_s


def specimen_housing(specimen: Specimen) -> SpecimenHousing | None:
    """Return the housing of a specimen; the same for all of its states and records; None for one without modes."""
    match specimen.housing:
        case Plates() as plates:
            return plate_housing(plates, specimen.pair, [shaft.bearing for shaft in specimen.names.shafts])
        case ModeTable() as table:
            return _modal_housing(table, specimen)
    return None


def housing_settle_s(specimen: Specimen) -> float:
    """Return the time over which the modes settle [s], which every record asks for; 0 without any."""
    match specimen.housing:
        case Plates() as plates:
            _, modes, ratio = damped_modes(plates)
            return modes_settle_s(modes.frequency_hz, ratio)
        case ModeTable() as table:
            return modes_settle_s(table.frequency_hz, table.damping_ratio)
        case Block() as block if specimen.planets is not None:  # others move with the gears
            return settle_s(slowest_decay_per_s(rigid_housing_of_set(block, specimen.planets.ring)))
    return 0.0


def _modal_housing(table: ModeTable, specimen: Specimen) -> SpecimenHousing:
    places = {place: table_motion(shape) for place, shape in table.shapes.items()}
    names = SEATS_OF_SET if specimen.planets is not None else seats_of(specimen.names)
    seats = {place: places[place] for place in names}
    still = table_motion(np.zeros_like(table.frequency_hz))
    drive = {place: places.get(place, still) for place in DRIVE}
    stage = still  # a planetary set has no second one
    if specimen.planets is None:
        bearings = [shaft.bearing for shaft in specimen.names.shafts[:2]]
        stage = second_stage(seats, bearings, specimen.pair.working_pressure_angle_rad)
    return SpecimenHousing(
        modes=TableModes(table.frequency_hz),
        damping_ratio=table.damping_ratio,
        seats=seats,
        motions=_seen(places, {seat.split("/")[0] for seat in seats}),
        entries={"second_stage": stage, **drive},
        bolts=lambda: _followed(table.frequency_hz, table.base),
    )


def _seen(places: Mapping[str, WallMotion], held: Collection[str]) -> dict[str, WallMotion]:
    """Return the motions of a table's places as sensors call them: at what is `held`, or on the casing by their name.

    A sensor on the casing may bear the name of a ring, too.
    """
    found = {p if p.split("/")[0] in held else f"casing_{p}": motion for p, motion in places.items()}
    return found | ({f"casing_{p}": motion for p, motion in places.items()} if "ring" in held else {})


def _followed(frequency_hz: FloatArray, base: Mapping[str, FloatArray]) -> BoltMotions:
    """Return what a base takes along, as bolts of 1 N/m that do just that.

    Derived. A body on bolts follows its base at rest by g_r = φ_rᵀ K_b t/ω_r² = φ_rᵀ M t, since K moves no force where
    the body goes with the base: these are the participation factors. Rocking is that of a bolt 1 m below the middle
    less that of one in it.
    """
    if len(base) < len(BASE):
        return ()
    horizontal, vertical, rocking = (base[name] * (2.0 * pi * frequency_hz) ** 2 for name in BASE)
    return (
        ((0.0, 0.0), "horizontal", 1.0, table_motion(horizontal - rocking)),
        ((0.0, 0.0), "vertical", 1.0, table_motion(vertical)),
        ((0.0, -1.0), "horizontal", 1.0, table_motion(rocking)),
    )
