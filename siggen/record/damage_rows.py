"""Rows of the damage table: the pits and spalls of one record with their places and sizes."""

from __future__ import annotations

from functools import lru_cache

from siggen.config import Config
from siggen.gears.damage.flank_damage import Damage, Pit, Spall
from siggen.gears.damage.outlines import Ellipse, Polygon
from siggen.planning.plan import planned_record
from siggen.planning.specimen import draw_specimen
from siggen.specimen.damage import state_damage
from siggen.specimen.gears import gear_pair


def damage_rows(config: Config, record_id: int) -> list[dict[str, object]]:
    """Return one row per pit or spall of a record, lengths in mm; none for a healthy record."""
    record = planned_record(config, record_id)
    damage = _damage(config, record.specimen_id, record.state_id)
    return [{"record_id": record_id, **_row(pit)} for pit in damage]


@lru_cache(maxsize=8)  # records of one specimen and state come one after the other
def _damage(config: Config, specimen_id: int, state_id: int) -> Damage:
    pair = gear_pair(draw_specimen(config, specimen_id).gears)
    return state_damage(config, specimen_id, pair, state_id)


def _row(pit: Pit | Spall) -> dict[str, object]:
    outline = pit.outline
    (low, high), (left, right) = outline.height_range_m, outline.face_range_m
    corners = outline.vertices_m if isinstance(outline, Polygon) else ()
    if isinstance(outline, Ellipse):
        across, along = outline.semi_axis_face_m, outline.semi_axis_profile_m
    else:
        across, along = 0.5 * (right - left), 0.5 * (high - low)
    return {
        "gear": pit.gear,
        "tooth": pit.tooth,
        "kind": pit.kind,
        "shape": outline.shape,
        "height_mm": 1e3 * outline.height_m,
        "face_mm": 1e3 * outline.face_m,
        "semi_axis_face_mm": 1e3 * across,
        "semi_axis_profile_mm": 1e3 * along,
        "depth_mm": 1e3 * pit.depth_m,
        "depth_law": pit.floor,
        "polygon_face_mm": [1e3 * face for _, face in corners],
        "polygon_height_mm": [1e3 * height for height, _ in corners],
    }
