"""Sentences about the damage of a set that is idealised."""

from __future__ import annotations

from siggen.config import Config
from siggen.keys.number import bounds


def damage_notes(config: Config) -> tuple[str, ...]:
    """Return what to know about the shapes of damage in a set.

    A spall through the face whose edges are exactly parallel to the axis takes the whole contact line at once; with
    edges skewed by 0.1 to 1 mm over the face the line crosses them bit by bit, as lines of helical teeth always do.
    """
    if bounds(config.gears.helix_deg) != (0.0, 0.0):
        return ()
    width_mm = bounds(config.gears.face_width_mm)[0]
    asked = [one.straight_edges(width_mm) for state in config.states if state.damaged for one in state.damages]
    found = [answer for answer in asked if answer is not None]
    if not all(parallel for parallel, _ in found) or not any(through for _, through in found):
        return ()
    return (
        "all spalls are idealised: their edges are exactly parallel to the axis, so the whole contact line enters a "
        "spall across the face at once; edges of real spalls are skewed and wavy (damage kind: irregular, "
        "docs/understand/irregular_spalls.md)",
    )
