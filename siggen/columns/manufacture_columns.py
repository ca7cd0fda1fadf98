"""Columns of manufacturing errors, part of the labels of `siggen.columns.record`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.columns.of_parts import of_gear
from siggen.keys.column import MICROMETRE, Column, Role, in_role, list_of

if TYPE_CHECKING:
    from siggen.gearbox.specimen import Specimen
    from siggen.gearbox.tooth_errors import MadeWith

GEAR_ERROR_COLUMNS = (
    Column("accuracy_class_{}", pa.int32(), "", "flank tolerance class of {} by ISO 1328-1:2013"),
    Column("tolerance_share_{}", pa.float64(), "", "share of that class's tolerances that {} may use"),
    Column("pitch_deviation_{}_um", pa.float64(), MICROMETRE, "largest single pitch deviation of {}"),
    Column("cumulative_pitch_{}_um", pa.float64(), MICROMETRE, "total cumulative pitch deviation of {}"),
    Column("runout_{}_um", pa.float64(), MICROMETRE, "radial runout of {}, twice its eccentricity; part of its pitch"),
    Column("profile_slope_{}_um", pa.float64(), MICROMETRE, "largest profile slope deviation of {}'s teeth"),
    Column("profile_form_{}_um", pa.float64(), MICROMETRE, "largest profile form deviation of {}'s teeth"),
    Column("profile_deviation_{}_um", pa.float64(), MICROMETRE, "largest total profile deviation of {}'s teeth"),
)
"""Columns of each gear in sets with manufacturing errors: as a machine measures them about the shaft's axis."""


CROWNING_COLUMNS = (
    Column("crowning_{}_um", pa.float64(), MICROMETRE, "crowning of {}: what its teeth miss at both ends of the face"),
)
HELIX_COLUMNS = (
    Column("helix_slope_{}_um", pa.float64(), MICROMETRE, "helix slope deviation of {}; part of lead_misalignment_um"),
    Column("helix_form_{}_um", pa.float64(), MICROMETRE, "helix form deviation of {}"),
)

WAVE_COLUMNS = (
    Column("ghost_orders_{}", list_of(pa.int32()), "", "waves over all teeth of {}, per turn of its shaft"),
    Column(
        "ghost_amplitudes_{}_um",
        list_of(pa.float64()),
        MICROMETRE,
        "amplitudes of these waves on the flanks of {}, averaged over the face",
    ),
)


def manufacture_columns(gearbox: Specimen) -> tuple[Column, ...]:
    """Return the columns of manufacturing errors; none for sets of perfect gears."""
    made = gearbox.meshes[0].teeth.made
    if made is None:
        return ()
    gears = gearbox.names.first.gears
    of_gears = (of_gear(column, gear) for gear in gears for column in error_columns(made))
    waves = (of_gear(column, gear) for gear in gears for column in wave_columns(made))
    lead = "distance of the flanks at the far end of the face when they touch at the near one; its sign is the end"
    return in_role(
        Role.PROVENANCE,
        Column("manufacture_draw", pa.string(), "", "whether states share the specimen's gears: specimen or state"),
        *of_gears,
        Column("lead_misalignment_um", pa.float64(), MICROMETRE, lead),
        *waves,
        section="manufacture",
    )


def error_columns(made: MadeWith) -> tuple[Column, ...]:
    """Return the columns of errors of one gear, which is left open."""
    return (
        *GEAR_ERROR_COLUMNS,
        *(CROWNING_COLUMNS if made.crowned else ()),
        *(HELIX_COLUMNS if made.helices else ()),
    )


def wave_columns(made: MadeWith) -> tuple[Column, ...]:
    """Return the columns of waves of one gear, which is left open."""
    return WAVE_COLUMNS if made.waves else ()
