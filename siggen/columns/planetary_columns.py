"""Columns of planetary sets: those of a pair under the names of sun and planets, and those of ring and carrier."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.columns.manufacture_columns import manufacture_columns
from siggen.keys.column import HERTZ, Column, Role, in_role, list_of

if TYPE_CHECKING:
    from siggen.config import Config

RENAMED = {
    "faulty_gear": ("faulty_gear", "gear with damage: none, sun, planet, ring, both (sun and planet) or several"),
    "faulty_teeth_pinion": ("faulty_teeth_sun", "indices of the sun's damaged teeth"),
    "faulty_teeth_gear": ("faulty_teeth_planet", "indices of the first planet's damaged teeth"),
    "teeth_pinion": ("teeth_sun", "number of teeth of the sun"),
    "teeth_gear": ("teeth_planet", "number of teeth of each planet"),
    "speed_hz": ("speed_hz", "nominal speed of the input (sun) shaft"),
    "pinion_shaft_hz": ("sun_shaft_hz", "rotation frequency of the sun's shaft"),
    "gear_shaft_hz": ("planet_hz", "rotation frequency of the planets about their pins, against the carrier"),
    "bearing_velocity_gear_um_s": (
        "bearing_velocity_carrier_um_s", "waviness of the carrier's bearings, 1800 to 10000 Hz at 30 turns/s",
    ),
    "coupling_force_gear_n": (
        "coupling_force_carrier_n", "once per turn, of the misaligned coupling on the carrier's shaft",
    ),
    "start_angle_rad": (
        "start_angle_rad",
        "angle of the sun at the first sample; that of the carrier by their ratio",
    ),
}  # fmt: skip
"""Column of a pair -> its name and its meaning in a planetary set."""
EACH = "_each_planet"
ADDED = in_role(
    Role.CONDITION,
    Column("faulty_teeth_ring", list_of(pa.int32()), "", "indices of the ring's damaged teeth", Role.TARGET),
    Column("teeth_ring", pa.int32(), "", "number of teeth of the ring"),
    Column("planet_positions_deg", list_of(pa.float64()), "deg", "where the planets stand on the carrier"),
    Column("carrier_hz", pa.float64(), HERTZ, "rotation frequency of the carrier"),
    Column(
        "pin_errors_um", list_of(pa.float64()), "um", "how far each planet's pin is ahead of its place", Role.PROVENANCE
    ),
    section="planetary",
)


def of_planets(config: Config, columns: Iterable[Column]) -> tuple[Column, ...]:
    """Return the columns of a set; of gearboxes that are pairs as they are."""
    if config.planetary is None:
        return tuple(columns)
    errors = manufacture_of_others(config)
    return (*in_words_of_set(config, columns), *ADDED, *(column for column, _ in errors))


def in_words_of_set(config: Config, columns: Iterable[Column]) -> tuple[Column, ...]:
    """Return columns of a pair as a planetary set has them; of gearboxes that are pairs as they are."""
    return tuple(columns) if config.planetary is None else tuple(_renamed(column) for column in columns)


def manufacture_of_others(config: Config) -> Iterator[tuple[Column, str]]:
    """Yield the columns of errors of the ring and of all planets, each with the column of a pair's gear for it.

    Those of planets are lists, of the flanks towards the sun.
    """
    for column in manufacture_columns(config):
        if "_gear" in column.name:
            meaning = column.meaning.replace("gear", "ring")
            yield replace(column, name=column.name.replace("_gear", "_ring"), meaning=meaning), column.name
    for column in manufacture_columns(config):
        if "_gear" in column.name and not pa.types.is_list(column.type):
            name, meaning = column.name.replace("_gear", EACH), column.meaning.replace("the gear", "each planet")
            yield replace(column, name=name, meaning=meaning, type=list_of(column.type)), column.name


def renamed(name: str) -> str:
    """Return the name of a pair's column in a planetary set."""
    return RENAMED[name][0] if name in RENAMED else name.replace("_pinion", "_sun").replace("_gear", "_planet")


def _renamed(column: Column) -> Column:
    name = renamed(column.name)
    if column.name in RENAMED:
        return replace(column, name=name, meaning=RENAMED[column.name][1])
    if name == column.name:
        return column
    meaning = column.meaning.replace("pinion", "sun").replace("gear", "planet")
    return replace(column, name=name, meaning=meaning)
