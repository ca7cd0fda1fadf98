"""LawTables: the packed pair law as named arrays and numbers, for readers outside siggen (derived: names alone)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from siggen.mesh import pair_law as layout
from siggen.mesh.contact_table import TILTING_VALUES
from siggen.mesh.pair_law import PairLaw

NUMBERS = {
    "contact_ratio": layout.CONTACT_RATIO,
    "intervals_per_pitch": layout.PER_PITCH,
    "missing_intervals_per_pitch": layout.MISSING_PER_PITCH,
    "reach_before": layout.REACH_BEFORE,
    "reach_after": layout.REACH_AFTER,
    "start_m": layout.START_M,
    "base_pitch_m": layout.PITCH_M,
    "line_of_action_m": layout.LINE_M,
    "backlash_m": layout.BACKLASH_M,
}
DAMPING = {
    "damping_structure_root_kg": layout.DAMPING_STRUCTURE,
    "damping_film_root_kg": layout.DAMPING_FILM,
    "damping_asperities_root_kg": layout.DAMPING_ASPERITIES,
}
FRICTION = {
    "friction.boundary": layout.BOUNDARY,
    "friction.slip_speed_m_s": layout.SLIP_SPEED,
    "friction.table.line_m": layout.LUBRICATED_LINE,
    "friction.table.start_m": layout.LUBRICATED_START,
    "friction.table.per_m": layout.LUBRICATED_PER_M,
    "friction.table.floor_n_per_m": layout.LUBRICATED_FLOOR,
    "friction.table.per_log": layout.LUBRICATED_PER_LOG,
}


def law_tables(law: PairLaw) -> dict[str, Any]:
    """Return name -> array or number of everything that this law uses (docs/reference/exported_model.md).

    Parameters
    ----------
    law : PairLaw
        Read as the compiled loop reads it, so that what a reader gets is what is integrated.
    """
    head, scalars = law.places, law.scalars
    single = NUMBERS | (DAMPING if head[layout.SHARE_DAMPS] else {"damping_root_kg": layout.DAMPING_ROOT})
    tables = {name: float(scalars[place]) for name, place in single.items()} | _teeth(law)
    if head[layout.CONTACT_NODES]:
        tables |= _contact(law)
    if head[layout.APART]:
        tables["coupling_m_per_n"] = _numbers(law, layout.COUPLING_AT, (head[layout.APART], head[layout.POINTS]))
    if head[layout.SPREAD_AT]:
        tables["spread"] = _numbers(law, layout.SPREAD_AT, (3, head[layout.POINTS]))
    tables["rubs"] = bool(head[layout.ROUGHNESSES])
    if tables["rubs"]:
        tables |= _friction(law) | {name: float(scalars[place]) for name, place in FRICTION.items()}
    return tables


def _teeth(law: PairLaw) -> dict[str, NDArray[Any]]:
    head = law.places
    teeth = (int(head[layout.TEETH_1]), int(head[layout.TEETH_2]))
    points, missing_points = int(head[layout.POINTS]), int(head[layout.MISSING_POINTS])
    table_of_pair = _wholes(law, layout.TABLE_AT, teeth)
    tables = {
        "stiffness": _numbers(law, layout.STIFFNESS_AT, (int(table_of_pair.max()) + 1, points)),
        "table_of_pair": table_of_pair,
    }
    of_gears = (
        (layout.MISSING_1_AT, layout.OFFSET_1_AT, layout.KIND_1_AT),
        (layout.MISSING_2_AT, layout.OFFSET_2_AT, layout.KIND_2_AT),
    )
    for gear, (missing, offset, kind) in enumerate(of_gears):
        kinds = _wholes(law, kind, (teeth[gear],))
        tables[f"kind_of_tooth_{gear + 1}"] = kinds
        tables[f"missing_{gear + 1}"] = _numbers(law, missing, (int(kinds.max()) + 1, missing_points))
        tables[f"offset_{gear + 1}"] = _numbers(law, offset, (teeth[gear],))
    return tables


def _contact(law: PairLaw) -> dict[str, Any]:
    points, nodes, columns, values = (
        int(law.places[place])
        for place in (layout.POINTS, layout.CONTACT_NODES, layout.CONTACT_COLUMNS, layout.CONTACT_VALUES)
    )
    rows = int(_wholes(law, layout.TABLE_AT, (int(law.places[layout.TEETH_1]), int(law.places[layout.TEETH_2]))).max())
    return {
        "contact.touch_m": _numbers(law, layout.TOUCH_AT, (rows + 1, points)),
        "contact.column": _numbers(law, layout.COLUMN_AT, (rows + 1, points - 1)),
        "contact.gain": _numbers(law, layout.GAIN_AT, (rows + 1, points - 1)),
        "contact.curves": _numbers(law, layout.CURVES_AT, (columns, nodes, *_rays(values))),
        "contact.unit_m": float(law.scalars[layout.CONTACT_UNIT]),
        "contact.lead_m": float(law.scalars[layout.LEAD_M]),
        "contact.half_face_m": float(law.scalars[layout.CONTACT_HALF_FACE]),
    }


def _rays(values: int) -> tuple[int, int]:
    """Return how many rays in approach and tilt have how many values each."""
    return (1, values) if values < TILTING_VALUES else (values // TILTING_VALUES, TILTING_VALUES)


def _friction(law: PairLaw) -> dict[str, NDArray[Any]]:
    roughnesses, positions, loads = (
        int(law.places[place]) for place in (layout.ROUGHNESSES, layout.LUBRICATED_POSITIONS, layout.LUBRICATED_LOADS)
    )
    return {
        "friction.table.share": _numbers(law, layout.SHARE_AT, (roughnesses, positions, loads)),
        "friction.table.fluid": _numbers(law, layout.FLUID_AT, (positions, loads)),
    }


def _numbers(law: PairLaw, place: int, shape: tuple[int, ...]) -> NDArray[Any]:
    return _taken(law.numbers, int(law.places[place]), shape)


def _wholes(law: PairLaw, place: int, shape: tuple[int, ...]) -> NDArray[Any]:
    return _taken(law.places, int(law.places[place]), shape)


def _taken(packed: NDArray[Any], first: int, shape: tuple[int, ...]) -> NDArray[Any]:
    return packed[first : first + int(np.prod(shape))].reshape(shape)
