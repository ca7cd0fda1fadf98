"""Columns of the table of damage."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.keys.column import MILLIMETRE, Column, Role, in_role, list_of

if TYPE_CHECKING:
    from siggen.gearbox.specimen import Specimen

DAMAGE_COLUMNS = (
    Column("record_id", pa.int64(), "", "record that shows the damage", Role.KEY),
    Column("gear", pa.string(), "", "gear with the damage; none for damage that is on no gear"),
    Column("tooth", pa.int32(), "", "index of the tooth; -1 for all teeth of its gear, or none"),
    Column("kind", pa.string(), "", "what the damage is"),
    Column("shape", pa.string(), "", "ellipse, rectangle, polygon or none"),
    Column(
        "height_mm",
        pa.float64(),
        MILLIMETRE,
        "centre above the base circle along the tooth's axis",
    ),
    Column("face_mm", pa.float64(), MILLIMETRE, "centre across the face, from the face's edge"),
    Column("semi_axis_face_mm", pa.float64(), MILLIMETRE, "half the length across the face"),
    Column(
        "semi_axis_profile_mm",
        pa.float64(),
        MILLIMETRE,
        "half the length along the tooth's axis",
    ),
    Column("face_width_mm", pa.float64(), MILLIMETRE, "of the damaged gear; 0 where damage is on none"),
    Column("pitch_height_mm", pa.float64(), MILLIMETRE, "of its pitch circle, as height_mm"),
    Column("tip_height_mm", pa.float64(), MILLIMETRE, "of its tip, as height_mm"),
    Column("depth_mm", pa.float64(), MILLIMETRE, "largest depth"),
    Column("depth_law", pa.string(), "", "how the depth runs: flat or dish"),
    Column(
        "polygon_face_mm",
        list_of(pa.float64()),
        MILLIMETRE,
        "corners (rectangle, polygon) across the face; else empty",
    ),
    Column("polygon_height_mm", list_of(pa.float64()), MILLIMETRE, "heights of the corners; else empty"),
)
"""Columns of `damage.parquet`: one row per part of a record's damage."""
EDGE_COLUMNS = (
    Column("edge_radius_mm", pa.float64(), MILLIMETRE, "radius of the damage's edges"),
    Column(
        "strip_depth_mm",
        list_of(pa.float64()),
        MILLIMETRE,
        "depth between neighbouring corners of the lower edge, which come first; empty: depth_mm everywhere",
    ),
)
"""More columns of `damage.parquet` in sets whose damage has edges of its own."""


def damage_columns(gearbox: Specimen) -> tuple[Column, ...]:
    """Return the columns of `damage.parquet` of a set."""
    edges = EDGE_COLUMNS if has_drawn_edges(gearbox) else ()
    return in_role(Role.TARGET, *DAMAGE_COLUMNS, *edges, *kind_columns(gearbox))


def kind_columns(gearbox: Specimen) -> tuple[Column, ...]:
    """Return the columns that kinds of damage of a set have beyond those of all, each once."""
    return tuple(dict.fromkeys(column for kind in gearbox.damages for column in kind.columns))


def nothing_of(column: Column) -> object:
    """Return what a row holds where a kind has nothing to say: no column of a set holds nulls."""
    if pa.types.is_list(column.type):
        return []
    return "" if pa.types.is_string(column.type) else pa.scalar(0).cast(column.type).as_py()


def has_drawn_edges(gearbox: Specimen) -> bool:
    """Tell whether damage of a set has edges of its own, so that its rows have `EDGE_COLUMNS`."""
    return any(section.own_edge_radius is not None for section in gearbox.damages)
