"""Sizes of the damage of a gearbox's states, from its drawing alone: no table is computed and nothing moves."""

from __future__ import annotations

from collections.abc import Mapping

from siggen.config import Config
from siggen.planning.gearbox import gearbox_config
from siggen.planning.specimen import draw_specimen
from siggen.planning.state_config import state_config
from siggen.record.labels import damage_labels
from siggen.record.stage_labels import LARGEST
from siggen.specimen.made_gears import MadeGears
from siggen.specimen.planetary_meshes import made_meshes


def damage_sizes(config: Config, specimen_id: int) -> dict[str, Mapping[str, object]]:
    """Return state -> the labels `LARGEST` of its record but the depth to which flanks sink; the largest of all meshes.

    A state whose damage cannot be drawn is left out.
    """
    shared = _made(gearbox_config(config, specimen_id), specimen_id)
    found: dict[str, Mapping[str, object]] = {}
    for state_id, name in enumerate(config.state_names):
        changed = bool(config.changes_of(state_id))
        meshes = _made(state_config(config, specimen_id, state_id), specimen_id) if changed else shared
        try:
            rows = [_labels(one, state_id) for one in meshes]
        except ValueError:
            continue
        found[name] = {key: max(row[key] for row in rows) for key in LARGEST}  # type: ignore[type-var]
    return found


def _made(config: Config, specimen_id: int) -> list[MadeGears]:
    made = MadeGears(config, draw_specimen(config, specimen_id))
    return [made, *made.stages] if made.specimen.planets is None else made_meshes(made, config)


def _labels(made: MadeGears, state_id: int) -> dict[str, object]:
    return damage_labels(made.config.states[state_id], made.pair, made.damage(state_id), made.options)
