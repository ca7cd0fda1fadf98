"""Rows of the damage table: the pits of one record with their places and sizes."""

from __future__ import annotations

from functools import lru_cache

from siggen.config import Config
from siggen.dataset.plan import planned_record
from siggen.dataset.specimen import draw_specimen
from siggen.gears.damage import Damage, Pit
from siggen.specimen_physics import gear_pair
from siggen.state_damage import state_damage


def damage_rows(config: Config, record_id: int) -> list[dict[str, object]]:
    """Return one row per pit of a record, lengths in mm; none for a healthy record."""
    record = planned_record(config, record_id)
    damage = _damage(config, record.specimen_id, record.state_id)
    return [{"record_id": record_id, **_row(pit)} for pit in damage]


@lru_cache(maxsize=8)  # records of one specimen and state come one after the other
def _damage(config: Config, specimen_id: int, state_id: int) -> Damage:
    pair = gear_pair(draw_specimen(config, specimen_id).gears)
    return state_damage(config, specimen_id, pair, state_id)


def _row(pit: Pit) -> dict[str, object]:
    return {
        "gear": pit.gear,
        "tooth": pit.tooth,
        "kind": "pit",
        "shape": "ellipse",
        "height_mm": 1e3 * pit.height_m,
        "face_mm": 1e3 * pit.face_m,
        "semi_axis_face_mm": 1e3 * pit.semi_axis_face_m,
        "semi_axis_profile_mm": 1e3 * pit.semi_axis_profile_m,
        "depth_mm": 1e3 * pit.depth_m,
        "depth_law": pit.floor,
        "polygon_face_mm": [],
        "polygon_height_mm": [],
    }
