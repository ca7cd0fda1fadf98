"""Rows of the damage table: the damage of one record with its places and sizes."""

from __future__ import annotations

from functools import lru_cache

from siggen.columns.damage_columns import has_drawn_edges
from siggen.config import Config
from siggen.gears.damage.tooth_damage import Damage
from siggen.keys.number import constant
from siggen.planning.plan import planned_record
from siggen.planning.specimen import draw_specimen
from siggen.specimen.damage import state_damage
from siggen.specimen.gears import gear_pair


def damage_rows(config: Config, record_id: int) -> list[dict[str, object]]:
    """Return one row per damage of a record, lengths in mm; none for a healthy record."""
    record = planned_record(config, record_id)
    damage, edges = _damage(config, record.specimen_id, record.state_id)
    return [{"record_id": record_id, **edges, **one.table_row()} for one in damage]


@lru_cache(maxsize=8)  # records of one specimen and state come one after the other
def _damage(config: Config, specimen_id: int, state_id: int) -> tuple[Damage, dict[str, object]]:
    """Return the damage of a state, and in sets that store edges those of damage that states none itself."""
    specimen = draw_specimen(config, specimen_id)
    damage = state_damage(config, specimen_id, gear_pair(specimen.gears), state_id)
    if not has_drawn_edges(config):
        return damage, {}
    return damage, {"edge_radius_mm": constant(specimen.dynamics.mesh.pit_edge_radius_mm), "strip_depth_mm": []}
