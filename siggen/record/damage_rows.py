"""Rows of the damage table: the damage of records with its places and sizes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby
from math import tan

from siggen.columns.damage import DAMAGE_COLUMNS, has_drawn_edges, kind_columns, nothing_of
from siggen.damage.heights import flank_heights
from siggen.damage.part import Part
from siggen.gearbox.plan import PlannedRecord
from siggen.gearbox.specimen import Specimen, ToothMesh
from siggen.gears.gear_pair import GearPair
from siggen.names import Names, Side
from siggen.record.bearing_spalls import drawn_labels
from siggen.record.teeth import MeshTeeth


def damage_rows(
    gearbox: Specimen, records: Iterable[PlannedRecord], mesh: int | None = None
) -> Iterator[dict[str, object]]:
    """Yield one row per part of the damage of records of a gearbox, lengths in mm; `mesh`: of one alone."""
    empty = {column.name: nothing_of(column) for column in (*DAMAGE_COLUMNS, *kind_columns(gearbox))}
    for state_id, of_state in groupby(records, key=lambda record: record.state_id):
        specimen = gearbox.in_state(state_id)
        if has_drawn_edges(gearbox):  # those of damage that states none itself
            empty |= {"edge_radius_mm": 1e3 * specimen.law.edge_radius_m, "strip_depth_mm": []}
        parts = [
            (part, {**empty, **_row(gearbox.names, part, one)})
            for number, one in enumerate(specimen.meshes)
            if mesh in (None, number)
            for part in MeshTeeth(specimen.law, one.teeth).damage(state_id)
        ]
        for record in of_state:
            for part, row in parts:
                yield {**row, "record_id": record.record_id, **drawn_labels(gearbox.seed, record, part)}


def _row(names: Names, part: Part, mesh: ToothMesh) -> dict[str, object]:
    """Return the row of a part, whose gear has the name of its stage before it, or that in a planetary set."""
    row = part.table_row()
    side = str(row["gear"])
    bearing = {"bearing": names.bearings[str(row["bearing"])]} if row.get("bearing") else {}
    flank = _flank(mesh.pair, Side(side)) if side in set(Side) else {}
    return {**row, **bearing, **flank, "gear": names.gear(f"{mesh.inner}.{side}" if mesh.inner else side)}


def _flank(pair: GearPair, side: Side) -> dict[str, float]:
    """Return the size of the flanks of a gear, heights above the base circle along the tooth's axis."""
    gear = pair.member(side)
    pitch_m, tip_m = float(gear.height_m(tan(gear.pressure_angle_rad))), flank_heights(gear)[1]
    return {"face_width_mm": 1e3 * pair.face_width_m, "pitch_height_mm": 1e3 * pitch_m, "tip_height_mm": 1e3 * tip_m}
