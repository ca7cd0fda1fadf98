"""Labels of the further meshes of a gearbox, and how those of all meshes make one label of the record."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from siggen.gearbox.specimen import Specimen
from siggen.names import SEVERAL, Side
from siggen.specimen.static_mesh import StaticMesh

ADDED = ("damage_count", "damaged_area_mm2")
LARGEST = (
    "damaged_area_share", "damage_face_length_mm", "damage_profile_length_mm", "contact_length_loss_mm",
    "mesh_stiffness_loss", "through_face", "sink_depth_um",
)  # fmt: skip
LOSS = "mesh_stiffness_loss_as_simulated"


def stage_labels(first: Mapping[str, Any], behind: Mapping[str, Mapping[str, Any]]) -> dict[str, object]:
    """Return the labels of a state by those of its first mesh and, by name, of each mesh behind it.

    Counts and areas add up; of shares, lengths and losses the largest counts.
    """
    every = (first, *behind.values())
    teeth = {
        f"faulty_teeth_{name}_{gear}": labels[f"faulty_teeth_{gear}"]
        for name, labels in behind.items()
        for gear in Side
    }
    added = {key: sum(labels[key] for labels in every) for key in ADDED}
    largest = {key: max(labels[key] for labels in every) for key in LARGEST}
    return {**first, **added, **largest, **teeth, "faulty_gear": _faulty_gear(first, behind)}


def stage_operating_labels(
    specimen: Specimen, first: Mapping[str, Any], behind: Sequence[StaticMesh]
) -> dict[str, object]:
    """Return teeth and frequencies of the further meshes, and the largest loss of stiffness of any mesh.

    Their first shaft is that of the first mesh's gear.
    """
    found: dict[str, object] = {}
    shaft_hz = float(first["gear_shaft_hz"])
    losses = [float(first[LOSS])]
    for mesh, static, turned in zip(specimen.behind, behind, specimen.shaft_turns[1:], strict=False):
        pair = static.pair
        losses.append(static.largest_loss(float(first["torque_nm"]) / float(turned)))
        found |= {f"teeth_{mesh.inner}_{gear}": pair.member(gear).teeth for gear in Side}
        found[f"mesh_{mesh.inner}_hz"] = shaft_hz * pair.pinion.teeth
        shaft_hz *= pair.pinion.teeth / pair.gear.teeth
        found[f"{mesh.inner}_shaft_hz"] = shaft_hz
    return {**found, LOSS: max(losses)} if behind else {}


def _faulty_gear(first: Mapping[str, Any], behind: Mapping[str, Mapping[str, Any]]) -> str:
    """Return which gear carries damage; `several` where gears of several meshes do."""
    each = {"": str(first["faulty_gear"]), **{name: str(one["faulty_gear"]) for name, one in behind.items()}}
    found = [f"{name}.{gear}" if name else gear for name, gear in each.items() if gear != "none"]
    return SEVERAL if len(found) > 1 or SEVERAL in each.values() else next(iter(found), "none")
