"""Sizes of the damage of a gearbox's states, from its drawing alone: no table is computed and nothing moves."""

from __future__ import annotations

from collections.abc import Mapping

from siggen.gearbox.specimen import Specimen
from siggen.record.labels import LARGEST, damage_labels
from siggen.record.teeth import all_teeth


def damage_sizes(gearbox: Specimen) -> dict[str, Mapping[str, object]]:
    """Return state -> the labels `LARGEST` of its record but the depth to which flanks sink; the largest of all meshes.

    A state whose damage cannot be drawn is left out.
    """
    found: dict[str, Mapping[str, object]] = {}
    for number, state in enumerate(gearbox.states):
        try:
            rows = [
                damage_labels(state, one.pair, one.damage(number), one.options)
                for one in all_teeth(gearbox.in_state(number))
            ]
        except ValueError:
            continue
        found[state.name] = {key: max(row[key] for row in rows) for key in LARGEST}  # type: ignore[type-var]
    return found
