"""Rows of the damage table: the damage of one record with its places and sizes."""

from __future__ import annotations

from functools import lru_cache

from siggen.config import Config
from siggen.gears.damage.tooth_damage import Damage
from siggen.planning.plan import planned_record
from siggen.planning.specimen import draw_specimen
from siggen.specimen.damage import state_damage
from siggen.specimen.gears import gear_pair


def damage_rows(config: Config, record_id: int) -> list[dict[str, object]]:
    """Return one row per damage of a record, lengths in mm; none for a healthy record."""
    record = planned_record(config, record_id)
    damage = _damage(config, record.specimen_id, record.state_id)
    return [{"record_id": record_id, **one.table_row()} for one in damage]


@lru_cache(maxsize=8)  # records of one specimen and state come one after the other
def _damage(config: Config, specimen_id: int, state_id: int) -> Damage:
    pair = gear_pair(draw_specimen(config, specimen_id).gears)
    return state_damage(config, specimen_id, pair, state_id)
