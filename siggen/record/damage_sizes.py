"""Sizes of the damage of a gearbox's states, from its drawing alone: no table is computed and nothing moves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from siggen.config import Config
from siggen.gearbox.configured import gearbox_config, state_config
from siggen.gearbox.draw import draw_specimen
from siggen.gearbox.specimen import Specimen
from siggen.record.labels import damage_labels
from siggen.record.stage_labels import LARGEST
from siggen.specimen.mesh_teeth import MeshTeeth, all_teeth


def damage_sizes(config: Config, specimen_id: int) -> dict[str, Mapping[str, object]]:
    """Return state -> the labels `LARGEST` of its record but the depth to which flanks sink; the largest of all meshes.

    A state whose damage cannot be drawn is left out.
    """
    shared = _teeth(gearbox_config(config, specimen_id), specimen_id)
    found: dict[str, Mapping[str, object]] = {}
    for state_id, name in enumerate(config.state_names):
        changed = bool(config.changes_of(state_id))
        specimen, teeth = _teeth(state_config(config, specimen_id, state_id), specimen_id) if changed else shared
        try:
            rows = [
                damage_labels(specimen.states[state_id], one.pair, one.damage(state_id), one.options) for one in teeth
            ]
        except ValueError:
            continue
        found[name] = {key: max(row[key] for row in rows) for key in LARGEST}  # type: ignore[type-var]
    return found


def _teeth(config: Config, specimen_id: int) -> tuple[Specimen, Sequence[MeshTeeth]]:
    specimen = draw_specimen(config, specimen_id)
    return specimen, all_teeth(specimen)
