"""State and labels of a planetary set: those of sun and first planet, seen as a pair, and what the others add."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from siggen.columns.planetary_columns import RENAMED
from siggen.config import Config
from siggen.config.planetary import NAMES
from siggen.gears.damage.tooth_damage import on_teeth
from siggen.gears.stiffness.mesh_stiffness import StiffnessOptions
from siggen.gears.stiffness.mesh_tables import TABLE_POINTS
from siggen.planning.specimen import Specimen
from siggen.specimen.contact import largest_force_n, tooth_tables
from siggen.specimen.made_gears import MadeGears
from siggen.specimen.motion import SpecimenMesh
from siggen.specimen.planetary_meshes import with_planets
from siggen.specimen.planetary_numbers import pin_errors_m, planetary_teeth
from siggen.specimen.static_mesh import StaticMesh

LOSS = "mesh_stiffness_loss_as_simulated"


def planetary_mesh(
    config: Config, specimen: Specimen, made: MadeGears, state_id: int, first: SpecimenMesh, options: StiffnessOptions
) -> SpecimenMesh:
    """Return all meshes of a set by that of the sun with its first planet, in a state."""
    damage = on_teeth(made.damage(state_id))
    of_sun = tuple(one for one in damage if one.gear == "pinion")
    if len(of_sun) == len(damage):
        return with_planets(config, specimen, first, first, options)
    teeth = tooth_tables(
        specimen.dynamics, first.pair, of_sun, options, TABLE_POINTS,
        largest_force_n(config.operating_points, first.pair),
    )  # fmt: skip
    other = replace(first, tables=teeth.tables, coupling_m_per_n=teeth.coupling_m_per_n, contact=teeth.contact)
    return with_planets(config, specimen, first, other, options)


def planetary_labels(
    config: Config, specimen: Specimen, labels: Mapping[str, Any], static: StaticMesh
) -> dict[str, object]:
    """Return the labels of a set by those of its sun and first planet as a pair; each planet carries its share."""
    if specimen.planetary is None:
        return dict(labels)
    teeth, sun_hz = planetary_teeth(specimen), float(labels["pinion_shaft_hz"])
    carrier_hz = sun_hz / (1.0 + teeth.ring / teeth.sun)
    found = {RENAMED[name][0] if name in RENAMED else name: value for name, value in labels.items()}
    return {
        **found,
        "faulty_gear": NAMES.get(str(labels["faulty_gear"]), labels["faulty_gear"]),
        "planet_hz": carrier_hz * teeth.ring / teeth.planet,
        "mesh_hz": carrier_hz * teeth.ring,
        LOSS: static.largest_loss(float(labels["torque_nm"]) / len(teeth.places)),
        "teeth_ring": teeth.ring,
        "planet_positions_deg": [360.0 * float(place) for place in teeth.places],
        "carrier_hz": carrier_hz,
        "pin_errors_um": [1e6 * float(error) for error in pin_errors_m(config, specimen)],
    }
