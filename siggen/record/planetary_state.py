"""Labels of a planetary set: those of sun and first planet, seen as a pair, and what the ring and the others add."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from siggen.columns.manufacture_columns import error_columns, wave_columns
from siggen.columns.planetary_columns import EACH
from siggen.config import Config
from siggen.config.planetary import RING
from siggen.names import DRIVEN, SEVERAL
from siggen.planning.specimen import Specimen
from siggen.record.stage_labels import ADDED, LARGEST, LOSS
from siggen.specimen.static_mesh import StaticMesh


def with_ring_labels(config: Config, suns: Sequence[Mapping[str, Any]], ring: Mapping[str, Any]) -> dict[str, object]:
    """Return the labels of a state by those of its sun with each planet, and those of the first planet in the ring.

    Counts and areas add up; of shares, lengths and losses the largest counts.
    """
    first = suns[0]
    gears = [str(one) for one in (first["faulty_gear"],) if one != "none"]
    gears += [RING] * (ring["faulty_gear"] != "none")
    return {
        **first,
        **{key: first[key] + ring[key] for key in ADDED},
        **{key: max(first[key], ring[key]) for key in LARGEST},
        "faulty_gear": SEVERAL if len(gears) > 1 else next(iter(gears), "none"),
        "faulty_teeth_ring": ring["faulty_teeth_gear"],
        **_errors_of_others(config, suns, ring),
    }


def _errors_of_others(config: Config, suns: Sequence[Mapping[str, Any]], ring: Mapping[str, Any]) -> dict[str, object]:
    """Return the errors of the ring, and of each planet towards the sun, by those of driven gears of pairs."""
    section = config.manufacture
    if section is None:
        return {}
    errors, waves = error_columns(section), wave_columns(section)
    of_ring = {one.name.format(RING): ring[one.name.format(DRIVEN)] for one in (*errors, *waves)}
    return of_ring | {one.name.format(EACH): [sun[one.name.format(DRIVEN)] for sun in suns] for one in errors}


def planetary_labels(
    specimen: Specimen, labels: Mapping[str, Any], meshes: tuple[StaticMesh, ...]
) -> dict[str, object]:
    """Return the labels of a set by those of its sun and first planet as a pair; each planet carries its share.

    `meshes` are those of the first planet with the sun and with the ring, at rest.
    """
    if specimen.planets is None:
        return dict(labels)
    teeth, sun_hz = specimen.planets.teeth, float(labels["pinion_shaft_hz"])
    carrier_hz, of_each = sun_hz / (1.0 + teeth.ring / teeth.sun), float(labels["torque_nm"]) / len(teeth.places)
    torques = (of_each, of_each * teeth.planet / teeth.sun)
    return {
        **{name: value for name, value in labels.items() if name != "gear_shaft_hz"},
        "planet_hz": carrier_hz * teeth.ring / teeth.planet,
        "mesh_hz": carrier_hz * teeth.ring,
        LOSS: max(mesh.largest_loss(torque) for mesh, torque in zip(meshes, torques, strict=True)),
        "teeth_ring": teeth.ring,
        "planet_positions_deg": [360.0 * float(place) for place in teeth.places],
        "carrier_hz": carrier_hz,
        "pin_errors_um": [1e6 * error for error in specimen.planets.pin_errors_m],
    }
