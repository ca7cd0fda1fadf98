"""Columns of manufacturing errors, part of the labels of `siggen.columns.record`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.keys.column import MICROMETRE, Column, Role, in_role

if TYPE_CHECKING:
    from siggen.config import Config

GEAR_ERROR_COLUMNS = (
    ("accuracy_class_{}", pa.int32(), "", "flank tolerance class of the {} by ISO 1328-1:2013"),
    ("tolerance_share_{}", pa.float64(), "", "share of that class's tolerances that the {} may use"),
    ("pitch_deviation_{}_um", pa.float64(), MICROMETRE, "largest single pitch deviation of the {}"),
    ("cumulative_pitch_{}_um", pa.float64(), MICROMETRE, "total cumulative pitch deviation of the {}"),
    ("runout_{}_um", pa.float64(), MICROMETRE, "radial runout of the {}, twice its eccentricity; part of its pitch"),
    ("profile_slope_{}_um", pa.float64(), MICROMETRE, "largest profile slope deviation of the {}'s teeth"),
    ("profile_form_{}_um", pa.float64(), MICROMETRE, "largest profile form deviation of the {}'s teeth"),
    ("profile_deviation_{}_um", pa.float64(), MICROMETRE, "largest total profile deviation of the {}'s teeth"),
)
"""Columns of each gear in sets with manufacturing errors: as a machine measures them about the shaft's axis."""


CROWNING_COLUMNS = (
    ("crowning_{}_um", pa.float64(), MICROMETRE, "crowning of the {}: what its teeth miss at both ends of the face"),
)
HELIX_COLUMNS = (
    ("helix_slope_{}_um", pa.float64(), MICROMETRE, "helix slope deviation of the {}; part of lead_misalignment_um"),
    ("helix_form_{}_um", pa.float64(), MICROMETRE, "helix form deviation of the {}"),
)


def manufacture_columns(config: Config) -> tuple[Column, ...]:
    """Return the columns of manufacturing errors; none for sets of perfect gears."""
    if config.manufacture is None:
        return ()
    section = config.manufacture
    named = (
        *GEAR_ERROR_COLUMNS,
        *(CROWNING_COLUMNS if section.has_crowning else ()),
        *(HELIX_COLUMNS if section.has_helix else ()),
    )
    of_gears = (
        Column(name.format(which), kind, unit, meaning.format(which))
        for which in ("pinion", "gear")
        for name, kind, unit, meaning in named
    )
    waves = _wave_columns() if config.manufacture.flank_waves == "on" else ()
    lead = "distance of the flanks at the far end of the face when they touch at the near one; its sign is the end"
    return in_role(
        Role.PROVENANCE,
        Column("manufacture_draw", pa.string(), "", "whether states share the specimen's gears: specimen or state"),
        *of_gears,
        Column("lead_misalignment_um", pa.float64(), MICROMETRE, lead),
        *waves,
        section="manufacture",
    )


def _wave_columns() -> tuple[Column, ...]:
    number, length = (pa.list_(pa.field("element", kind, nullable=False)) for kind in (pa.int32(), pa.float64()))
    amplitude = "amplitudes of these waves on the flanks, averaged over the face"
    return tuple(
        column
        for which in ("pinion", "gear")
        for column in (
            Column(f"ghost_orders_{which}", number, "", f"waves over all teeth of the {which}, per turn of its shaft"),
            Column(f"ghost_amplitudes_{which}_um", length, MICROMETRE, amplitude),
        )
    )
