"""Sentences about contact and tilt across the face, what limits them, and bearings whose stiffness follows the load."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees

from siggen.checks.bearing_problems import STIFFNESS
from siggen.checks.tilt_problems import flank_tilts
from siggen.gearbox.configured import state_config
from siggen.gearbox.draw import draw_specimen
from siggen.gearbox.possible import PossibleGearbox
from siggen.gearbox.specimen import Specimen
from siggen.names import Side
from siggen.specimen.loaded_bearings import BEARINGS
from siggen.specimen.structure import specimen_bearings


def shaft_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield what to know where the contact is solved across the face or gears tilt."""
    dynamics = gearbox.config.dynamics
    if dynamics.mesh.law == "pairs":
        yield "contact across the face: load-dependent, with elastic edges of damage (dynamics.mesh.law: pairs)"
    if dynamics.shafts is not None:
        yield (
            "shafts bend and gears tilt (dynamics.shafts), down to no load; only a tilt at which an end of the face "
            "meets the other flank is outside_model"
        )
        tilts = flank_tilts(gearbox, gearbox.meshes[0].pairs[0])
        if tilts.largest_rad > tilts.limit_rad:
            yield (
                f"at the bounds of shafts and bearings {gearbox.largest_torque_nm:.3g} N m tilt the flanks by "
                f"{1e6 * tilts.largest_rad:.0f} urad; at {1e6 * tilts.limit_rad:.0f} an end meets the other flank: "
                "such gearboxes end as outside_model; stiffer bearings, or a gear_position nearer to 0.5, prevent it"
            )
    if any(getattr(gearbox.dynamics, role).bearing.geometry is not None for role in Side):
        yield from _bearing_notes(gearbox)


def _bearing_notes(gearbox: PossibleGearbox) -> Iterator[str]:
    """Yield the stiffness of both bearings of each such shaft of gearbox 0, and that of states that change it."""
    config = gearbox.config
    for role in Side:  # a preset that a file extends may have given them
        bearing = getattr(config.dynamics, role).bearing
        if bearing.geometry is not None and STIFFNESS in bearing.model_fields_set:
            at = config.names.own_path(f"dynamics.{role}.bearing")
            yield (
                f"{at}.{STIFFNESS}: not used: {at}.geometry has a stiffness by load; "
                f"{at}.geometry: null takes the given one"
            )
    found = dict(_bearings(draw_specimen(config, 0)))
    yield from (f"{key}: {text}" for key, text in found.items())
    for index, state in enumerate(config.states):
        if state.changes:
            changed = _bearings(draw_specimen(state_config(config, 0, index), 0))
            yield from (f"{key}, state {state.name}: {text}" for key, text in changed if found.get(key) != text)


def _bearings(specimen: Specimen) -> Iterator[tuple[str, str]]:
    for point in specimen.points:
        for role, one in specimen_bearings(specimen.under(point)).items():
            balls = f"{one.bearing.balls} balls of {1e3 * one.bearing.ball_diameter_m:.3g} mm"
            text = (
                f"{BEARINGS * one.along_n_per_m:.3g} N/m along the load, {BEARINGS * one.across_n_per_m:.3g} across; "
                f"{balls} bear it over {degrees(one.half_zone_rad):.0f} degrees to either side (clearance "
                f"{1e6 * one.bearing.clearance_m:.3g} um)"
            )
            shaft = next(one.called for one in specimen.names.shafts if one.inner == role)
            yield f"both bearings of {shaft} under {point.torque_nm:.3g} N m (gearbox 0)", text
