"""Labels of a planetary set: those of sun and first planet, seen as a pair, and what the ring and the others add."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from siggen.gearbox.specimen import Specimen
from siggen.names import PLANETARY, SEVERAL
from siggen.record.stage_labels import ADDED, LARGEST, LOSS
from siggen.specimen.static_mesh import StaticMesh


def with_ring_labels(first: Mapping[str, Any], ring: Mapping[str, Any]) -> dict[str, object]:
    """Return the labels of a state by those of its sun with the first planet, and of that planet in the ring.

    Counts and areas add up; of shares, lengths and losses the largest counts.
    """
    gears = [str(one) for one in (first["faulty_gear"],) if one != "none"]
    gears += [PLANETARY.meshes[1].driven.word] * (ring["faulty_gear"] != "none")
    return {
        **first,
        **{key: first[key] + ring[key] for key in ADDED},
        **{key: max(first[key], ring[key]) for key in LARGEST},
        "faulty_gear": SEVERAL if len(gears) > 1 else next(iter(gears), "none"),
        "faulty_teeth_ring": ring["faulty_teeth_gear"],
    }


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
