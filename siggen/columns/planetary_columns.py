"""Columns of planetary sets: those of a pair under the names of sun and planets, and those of ring and carrier."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.columns.manufacture_columns import error_columns, wave_columns
from siggen.columns.of_parts import FAULTY_TEETH, TEETH, frequency_of, of_gear, of_shaft, quantity_of
from siggen.keys.column import HERTZ, Column, Role, in_role, list_of
from siggen.names import PLANETARY

if TYPE_CHECKING:
    from siggen.gearbox.tooth_errors import MadeWith

EACH = "each_planet"
RING = PLANETARY.meshes[1].driven
SET_COLUMNS = in_role(
    Role.CONDITION,
    *(replace(of_gear(column, RING), label="") for column in (FAULTY_TEETH, TEETH)),
    Column("planet_positions_deg", list_of(pa.float64()), "deg", "where the planets stand on the carrier"),
    Column("carrier_hz", pa.float64(), HERTZ, "rotation frequency of the carrier"),
    Column(
        "pin_errors_um", list_of(pa.float64()), "um", "how far each planet's pin is ahead of its place", Role.PROVENANCE
    ),
    section="planetary",
)


def planetary_operating_columns() -> tuple[Column, ...]:
    """Return the columns of speed, load and teeth of sun and planets."""
    sun, planet = PLANETARY.first.gears
    teeth = "number of teeth of the sun", "number of teeth of each planet"
    against = "rotation frequency of the planets about their pins, against the carrier"
    start = "angle of the sun at the first sample; that of the carrier by their ratio"
    return in_role(
        Role.CONDITION,
        *(
            replace(of_gear(TEETH, gear), meaning=meaning, section="gears")
            for gear, meaning in zip((sun, planet), teeth, strict=True)
        ),
        Column("speed_hz", pa.float64(), HERTZ, "nominal speed of the input shaft, that of the sun"),
        Column("torque_nm", pa.float64(), "N m", "torque at the input shaft"),
        of_shaft(Column("{}_shaft_hz", pa.float64(), HERTZ, "rotation frequency of {}"), PLANETARY.shafts[0]),
        Column("planet_hz", pa.float64(), HERTZ, against, quantity="hz", of="planet"),
        frequency_of(PLANETARY.first),
        Column("start_angle_rad", pa.float64(), "rad", start, Role.PROVENANCE),
        section="operating_points",
    )


def manufacture_of_others(made: MadeWith) -> Iterator[Column]:
    """Yield the columns of errors of the ring and of all planets, as lists, of the flanks towards the sun."""
    for column in (*error_columns(made), *wave_columns(made)):
        yield _made(column, "ring", "the ring")
    for column in error_columns(made):
        yield _made(replace(column, type=list_of(column.type)), EACH, "each planet")


def _made(column: Column, word: str, called: str) -> Column:
    named = replace(column, name=column.name.format(word), meaning=column.meaning.format(called))
    (made,) = in_role(Role.PROVENANCE, named, section="manufacture")
    return replace(made, quantity=quantity_of(column), of=word)
