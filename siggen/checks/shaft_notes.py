"""Sentences about contact and tilt across the face, and what limits them."""

from __future__ import annotations

from siggen.checks.bearing_notes import bearing_notes
from siggen.checks.tilt_problems import NEEDED, flank_tilts
from siggen.config import Config
from siggen.gearbox.pair import gear_pair


def shaft_notes(config: Config) -> tuple[str, ...]:
    """Return what to know where the contact is solved across the face or gears tilt."""
    mesh, notes = config.dynamics.mesh, []
    if mesh.law == "pairs":
        notes.append("contact across the face: load-dependent, with elastic edges of damage (dynamics.mesh.law: pairs)")
    if config.dynamics.shafts is not None:
        notes.append(
            "shafts bend and gears tilt (dynamics.shafts), down to no load; only a tilt at which an end of the face "
            "meets the other flank is outside_model"
        )
        tilts = flank_tilts({name: getattr(config, name) for name in NEEDED}, gear_pair(config.gears))
        if tilts.largest_rad > tilts.limit_rad:
            notes.append(
                f"at the bounds of shafts and bearings {tilts.torque_nm:.3g} N m tilt the flanks by "
                f"{1e6 * tilts.largest_rad:.0f} urad; at {1e6 * tilts.limit_rad:.0f} an end meets the other flank: "
                "such gearboxes end as outside_model; stiffer bearings, or a gear_position nearer to 0.5, prevent it"
            )
    return (*notes, *bearing_notes(config))
