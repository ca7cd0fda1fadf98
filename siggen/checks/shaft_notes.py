"""Sentences about contact and tilt across the face, and what limits them."""

from __future__ import annotations

from siggen.config import Config


def shaft_notes(config: Config) -> tuple[str, ...]:
    """Return what to know where the contact is solved across the face, gears tilt or flanks are misaligned."""
    mesh, notes = config.dynamics.mesh, []
    if mesh.law == "pairs" and mesh.contact == "face":
        notes.append("contact across the face: load-dependent, with elastic edges of damage (dynamics.mesh.contact)")
    if config.dynamics.shafts is not None:
        notes.append(
            "shafts bend and gears tilt (dynamics.shafts); a tilt that lifts the ends of the face by more than 4 % of "
            "the largest approach (100 to 200 urad for 20 mm) is outside_model"
        )
    uneven = config.manufacture is not None and not config.manufacture.even_face
    if uneven and mesh.contact != "face":
        notes.append(
            "misalignment, helix and crowning act several times too hard: with dynamics.mesh.contact: slices teeth are "
            "rigid across the face; with face they give way (docs/understand/contact_across_the_face.md)"
        )
    return tuple(notes)
