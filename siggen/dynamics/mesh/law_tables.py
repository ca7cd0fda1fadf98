"""LawTables: the packed pair law as named arrays and numbers, for readers outside siggen (derived: names alone)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from siggen.dynamics.mesh import pair_law as at
from siggen.dynamics.mesh.pair_law import PairLaw

NUMBERS = {
    "contact_ratio": at.CONTACT_RATIO,
    "intervals_per_pitch": at.PER_PITCH,
    "missing_intervals_per_pitch": at.MISSING_PER_PITCH,
    "reach_before": at.REACH_BEFORE,
    "reach_after": at.REACH_AFTER,
    "start_m": at.START_M,
    "base_pitch_m": at.PITCH_M,
    "line_of_action_m": at.LINE_M,
    "backlash_m": at.BACKLASH_M,
    "film_n_s_per_m": at.FILM,
    "film_floor_m": at.FILM_FLOOR_M,
}
DAMPING = {
    "damping_structure_root_kg": at.DAMPING_STRUCTURE,
    "damping_film_root_kg": at.DAMPING_FILM,
    "damping_asperities_root_kg": at.DAMPING_ASPERITIES,
}
FRICTION = {
    "friction.boundary": at.BOUNDARY,
    "friction.slip_speed_m_s": at.SLIP_SPEED,
    "friction.table.line_m": at.LUBRICATED_LINE,
    "friction.table.start_m": at.LUBRICATED_START,
    "friction.table.per_m": at.LUBRICATED_PER_M,
    "friction.table.floor_n_per_m": at.LUBRICATED_FLOOR,
    "friction.table.per_log": at.LUBRICATED_PER_LOG,
}


def law_tables(law: PairLaw) -> dict[str, Any]:
    """Return name -> array or number of everything that this law uses, in the shapes of docs/exported_model.md.

    Parameters
    ----------
    law : PairLaw
        Read as the compiled loop reads it, so that what a reader gets is what is integrated.
    """
    head, scalars = law.places, law.scalars
    single = NUMBERS | (DAMPING if head[at.SHARE_DAMPS] else {"damping_root_kg": at.DAMPING_ROOT})
    tables = {name: float(scalars[place]) for name, place in single.items()} | _teeth(law)
    if head[at.GROUPS]:
        tables |= _slices(law) | {"slices.lead_m": float(scalars[at.LEAD_M])}
    if head[at.APART]:
        tables["coupling_m_per_n"] = _numbers(law, at.COUPLING_AT, (head[at.APART], head[at.POINTS]))
    tables["rubs"] = bool(head[at.ROUGHNESSES])
    if tables["rubs"]:
        tables |= _friction(law) | {name: float(scalars[place]) for name, place in FRICTION.items()}
    return tables


def _teeth(law: PairLaw) -> dict[str, NDArray[Any]]:
    head = law.places
    teeth = (int(head[at.TEETH_1]), int(head[at.TEETH_2]))
    points, missing_points = int(head[at.POINTS]), int(head[at.MISSING_POINTS])
    table_of_pair = _wholes(law, at.TABLE_AT, teeth)
    tables = {
        "stiffness": _numbers(law, at.STIFFNESS_AT, (int(table_of_pair.max()) + 1, points)),
        "table_of_pair": table_of_pair,
    }
    of_gears = ((at.MISSING_1_AT, at.OFFSET_1_AT, at.KIND_1_AT), (at.MISSING_2_AT, at.OFFSET_2_AT, at.KIND_2_AT))
    for gear, (missing, offset, kind) in enumerate(of_gears):
        kinds = _wholes(law, kind, (teeth[gear],))
        tables[f"kind_of_tooth_{gear + 1}"] = kinds
        tables[f"missing_{gear + 1}"] = _numbers(law, missing, (int(kinds.max()) + 1, missing_points))
        tables[f"offset_{gear + 1}"] = _numbers(law, offset, (teeth[gear],))
    return tables


def _slices(law: PairLaw) -> dict[str, NDArray[Any]]:
    points, groups = int(law.places[at.POINTS]), int(law.places[at.GROUPS])
    rows = int(_wholes(law, at.TABLE_AT, (int(law.places[at.TEETH_1]), int(law.places[at.TEETH_2]))).max()) + 1
    tables = {"slices.sink_m": _numbers(law, at.SINK_AT, (rows, points, groups))}
    for name, place in (("flush", at.FLUSH_AT), ("land", at.LAND_AT), ("on_damage", at.ON_DAMAGE_AT)):
        tables[f"slices.{name}"] = _numbers(law, place, (rows, points))
    tables["slices.contact_n_per_m"] = _numbers(law, at.CONTACT_AT, (points,))
    return tables


def _friction(law: PairLaw) -> dict[str, NDArray[Any]]:
    roughnesses, positions, loads = (
        int(law.places[place]) for place in (at.ROUGHNESSES, at.LUBRICATED_POSITIONS, at.LUBRICATED_LOADS)
    )
    return {
        "friction.table.ratio": _numbers(law, at.RATIO_AT, (roughnesses, positions, loads)),
        "friction.table.fluid": _numbers(law, at.FLUID_AT, (positions, loads)),
    }


def _numbers(law: PairLaw, place: int, shape: tuple[int, ...]) -> NDArray[Any]:
    return _taken(law.numbers, int(law.places[place]), shape)


def _wholes(law: PairLaw, place: int, shape: tuple[int, ...]) -> NDArray[Any]:
    return _taken(law.places, int(law.places[place]), shape)


def _taken(packed: NDArray[Any], first: int, shape: tuple[int, ...]) -> NDArray[Any]:
    return packed[first : first + int(np.prod(shape))].reshape(shape)
