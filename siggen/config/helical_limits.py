"""What helical teeth do not go with; each is refused where it is written."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from siggen.errors import Problem
from siggen.keys.number import bounds

SPUR = "or gears.helix_deg: 0"


def helical_problems(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    """Yield what helical teeth are asked for that only spur teeth can do."""
    if "gears" not in sections or bounds(sections["gears"].helix_deg) == (0.0, 0.0):
        return
    # slices find damage of flanks each at its own place
    mesh = sections["dynamics"].mesh if "dynamics" in sections else None
    sliced = mesh is None or (mesh.law == "pairs" and mesh.damage == "geometry")
    for index, state in sections.get("states", {}).items():
        for where, one in state.placed(f"states.{index}"):
            if not one.nouns:
                allowed = (
                    f"allowed: pits and spalls with helical teeth, which slices cross at places of their own; {SPUR}"
                )
                yield Problem(f"{where}.kind", f"'{one.kind_word()}'", allowed)
            elif not sliced:
                allowed = f"allowed: with helical teeth, dynamics.mesh.law: pairs and damage: geometry; {SPUR}"
                yield Problem(f"{where}.kind", f"'{one.kind_word()}'", allowed)
