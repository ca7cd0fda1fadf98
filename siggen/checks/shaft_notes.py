"""Sentences about contact and tilt across the face, and what limits them."""

from __future__ import annotations

from collections.abc import Iterator

from siggen.checks.tilt_problems import NEEDED, FlankTilts, flank_tilts, median_tilt_rad
from siggen.config import Config, bounds
from siggen.gears.errors.iso_1328 import flank_tolerances
from siggen.gears.geometry.gear_pair import GearPair
from siggen.specimen.gears import gear_pair

LIGHT = 20.0
"""Errors across the face over what a tilt may lift, at their largest. Of 12 records with damage 0 to 1 were outside the
model up to 26 times, 3 to 6 from 39 times on (files of `siggen init`, module 0.5 to 2)."""

STEEP = 0.1
"""Tilt at rest, of half of the gearboxes, over what the model holds to. Of 8 records with a through-face spall of half
a module 1 to 4 were outside the model from 0.13 to 0.40, none up to 0.07 (files of `siggen init`, module 2 to 6): teeth
that drop into it tilt the shafts further, whatever the class of the gears."""


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
        pair = gear_pair(config.gears)
        tilts = _tilts(config, pair)
        if tilts.largest_rad > tilts.limit_rad:
            notes.append(
                f"at the bounds of shafts and bearings {tilts.torque_nm:.3g} N m tilt the flanks by "
                f"{1e6 * tilts.largest_rad:.3g} urad, the model holds to {1e6 * tilts.limit_rad:.3g}: such gearboxes "
                "end as outside_model; stiffer bearings, or a gear_position nearer to 0.5, prevent it"
            )
        notes += [*_steep(config, pair, tilts), *_light_load(config, pair, tilts)]
    uneven = config.manufacture is not None and not config.manufacture.even_face
    if uneven and mesh.contact != "face":
        notes.append(
            "misalignment, helix and crowning act several times too hard: with dynamics.mesh.contact: slices teeth are "
            "rigid across the face; with face they give way (docs/understand/contact_across_the_face.md)"
        )
    return tuple(notes)


def outside_notes(config: Config) -> Iterator[str]:
    """Yield why records may end as outside_model: a tilt near the limit, or errors that are large for the load."""
    if config.dynamics.shafts is not None:
        pair = gear_pair(config.gears)
        tilts = _tilts(config, pair)
        yield from _steep(config, pair, tilts)
        yield from _light_load(config, pair, tilts)


def _steep(config: Config, pair: GearPair, tilts: FlankTilts) -> Iterator[str]:
    share = median_tilt_rad({name: getattr(config, name) for name in NEEDED}, pair) / tilts.limit_rad
    if share > STEEP:
        yield (
            f"in half of the gearboxes the flanks tilt at rest by {100.0 * share:.0f} % or more of what the model "
            "holds to; where damage runs through the face, teeth that drop into it tilt the shafts further: expect an "
            "eighth to half of such records to end as outside_model. Stiffer shafts and bearings, a narrower face or "
            "damage that leaves a part of the face prevent it"
        )


def _tilts(config: Config, pair: GearPair) -> FlankTilts:
    return flank_tilts({name: getattr(config, name) for name in NEEDED}, pair)


def _light_load(config: Config, pair: GearPair, tilts: FlankTilts) -> Iterator[str]:
    lift_um, errors_um = 0.5e6 * tilts.limit_rad * pair.face_width_m, _errors_across_um(config, pair)
    if errors_um > LIGHT * lift_um:
        yield (
            f"at {tilts.torque_nm:.3g} N m errors across the face of up to {errors_um:.2g} um are "
            f"{errors_um / lift_um:.0f} times what a tilt of the flanks may lift ({lift_um:.2g} um): expect records "
            "with damage to end as outside_model, a quarter to half of them from 40 times on; twice the torque "
            "prevents nearly all of it, a finer manufacture.accuracy_class part of it"
        )


def _errors_across_um(config: Config, pair: GearPair) -> float:
    """Return the largest helix slopes of both gears and misalignment together [um]."""
    section = config.manufacture
    if section is None:
        return 0.0
    said = section.lead_misalignment_um
    lead = 0.0 if isinstance(said, str) else bounds(said)[1]
    if not section.has_helix and not isinstance(said, str):
        return lead
    coarse = [bounds(number)[1] for number in (section.accuracy_class, section.accuracy_class_gear) if number]
    share = 1e6 * bounds(section.tolerance_share)[1]
    gears = zip((pair.pinion, pair.gear), (coarse[0], coarse[-1]), strict=True)
    return lead + sum(
        share * flank_tolerances(gear, pair.face_width_m, round(grade)).helix_slope_m for gear, grade in gears
    )
