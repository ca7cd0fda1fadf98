"""Columns of planetary sets: those of a pair under the names of sun and planets, and those of ring and carrier."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.columns.manufacture_columns import error_columns, wave_columns
from siggen.columns.of_parts import FAULTY_TEETH, TEETH, of_gear
from siggen.keys.column import HERTZ, Column, Role, in_role, list_of
from siggen.names import PLANETARY, GearName

if TYPE_CHECKING:
    from siggen.gearbox.tooth_errors import MadeWith

EACH = "each_planet"
RING = PLANETARY.meshes[1].driven
PLANET_HZ = Column(
    "planet_hz",
    pa.float64(),
    HERTZ,
    "rotation frequency of the planets about their pins, against the carrier",
    quantity="hz",
    of="planet",
)
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


def manufacture_of_others(made: MadeWith) -> tuple[Column, ...]:
    """Return the columns of errors of the ring and of all planets, as lists, of the flanks towards the sun."""
    ring, each = GearName("ring", "ring", "ring", "the ring"), GearName(EACH, EACH, EACH, "each planet")
    of_ring = (of_gear(column, ring) for column in (*error_columns(made), *wave_columns(made)))
    of_planets = (of_gear(replace(column, type=list_of(column.type)), each) for column in error_columns(made))
    return in_role(Role.PROVENANCE, *of_ring, *of_planets, section="manufacture")
