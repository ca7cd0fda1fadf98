"""Rows of the damage table: the damage of one record with its places and sizes."""

from __future__ import annotations

from functools import lru_cache

from siggen.columns.damage_columns import DAMAGE_COLUMNS, has_drawn_edges, kind_columns, nothing_of
from siggen.config import Config
from siggen.faults.flank_place import DOT
from siggen.gearbox.configured import state_config
from siggen.gearbox.draw import draw_specimen
from siggen.gears.damage.part import Part, Parts
from siggen.planning.plan import planned_record
from siggen.specimen.bearing_spalls import drawn_labels
from siggen.specimen.mesh_teeth import MeshTeeth


def damage_rows(config: Config, record_id: int, mesh: int | None = None) -> list[dict[str, object]]:
    """Return one row per part of a record's damage, lengths in mm; none for a healthy record; `mesh`: of one alone."""
    record = planned_record(config, record_id)
    placed, shared = _damage(config, record.specimen_id, record.state_id)
    empty = {column.name: nothing_of(column) for column in (*DAMAGE_COLUMNS, *kind_columns(config))}
    return [
        {**empty, "record_id": record_id, **shared, **_row(config, one, name), **drawn_labels(config.seed, record, one)}
        for number, (name, parts) in enumerate(placed.items())
        if mesh in (None, number)
        for one in parts
    ]


def _row(config: Config, part: Part, stage: str) -> dict[str, object]:
    """Return the row of a part, whose gear has the name of its stage before it, or that in a planetary set."""
    row, names = part.table_row(), config.names
    gear = f"{stage}{DOT}{row['gear']}" if stage else str(row["gear"])
    bearing = {"bearing": names.bearings[str(row["bearing"])]} if row.get("bearing") else {}
    return {**row, **bearing, "gear": names.gear(gear)}


@lru_cache(maxsize=8)  # records of one specimen and state come one after the other
def _damage(config: Config, specimen_id: int, state_id: int) -> tuple[dict[str, Parts], dict[str, object]]:
    """Return the damage of a state by stage, and in sets that store edges those of damage that states none itself."""
    specimen = draw_specimen(state_config(config, specimen_id, state_id), specimen_id)
    meshes = [(mesh.inner, mesh.teeth) for mesh in specimen.meshes]
    damage = {name: MeshTeeth(specimen.law, teeth).damage(state_id) for name, teeth in meshes}
    if not has_drawn_edges(config):
        return damage, {}
    return damage, {"edge_radius_mm": 1e3 * specimen.law.edge_radius_m, "strip_depth_mm": []}
