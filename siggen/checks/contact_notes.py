"""Sentences about the lubricated contacts of a set that lie outside the data of the formulas applied to them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from siggen.config import Config, Friction
from siggen.config.oil import oils_of
from siggen.dynamics.friction.contact_kinematics import Values
from siggen.dynamics.friction.lubrication import FilmGroups
from siggen.dynamics.friction.lubrication_notes import lubrication_notes
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.drawing import corners
from siggen.keys.number import bounds
from siggen.planning.gearbox import pair_configs
from siggen.planning.specimen import OperatingPoint
from siggen.specimen.contact import solves_across_the_face
from siggen.specimen.friction import composite_roughness_m, light_force_n, lubricated_mesh
from siggen.specimen.gears import gear_pair

FORCE_SHARES = np.array([[0.3], [1.0]])
"""Forces of a pair over the static mesh force, between which most of an engagement lies."""
POSITIONS = 9


def contact_notes(config: Config) -> tuple[str, ...]:
    """Return what to know about the lubricated contacts of a set, at the bounds of its distributions.

    Contacts are those of the path of contact at 0.3 to 1 times the static mesh force; lands inside damage, where the
    set has any that counts as geometry, with a remark of their own.
    """
    if config.dynamics.rubbing != "mixed_ehl":
        return ()
    healthy, pitted = zip(*_groups(config), strict=True)
    notes = lubrication_notes(_united(healthy), "masjedi_khonsari")
    missing = any(one.nouns for state in config.states if state.damaged for one in state.damages)
    if not (missing and solves_across_the_face(config.dynamics)):
        return notes
    # Load, speed and material are those of the healthy flank: only the roughness is news.
    inside = lubrication_notes(_united(pitted), "masjedi_khonsari", checked=("roughness",))
    return (*notes, *(f"lands inside damage: {note}" for note in inside if note not in notes))


def _groups(config: Config) -> Iterator[tuple[FilmGroups, FilmGroups]]:
    """Yield the groups of healthy flanks and of lands inside damage at all combinations of bounds."""
    for own in pair_configs(config):
        yield from _groups_of_pair(own)


def _groups_of_pair(config: Config) -> Iterator[tuple[FilmGroups, FilmGroups]]:
    points = [corner for point in config.operating_points for corner in corners(point)]
    for gears in corners(config.gears):
        pair = gear_pair(gears)
        for section in _frictions(config):
            for point in points:
                torque_nm = min(map(abs, bounds(point.torque_nm)))
                yield _groups_at(section, pair, OperatingPoint(bounds(point.speed_hz)[0], torque_nm))


def _frictions(config: Config) -> Iterator[Friction]:
    friction = config.dynamics.friction
    for oil in oils_of(friction.oil):
        yield from corners(friction.model_copy(update={"oil": oil}))


def _groups_at(section: Friction, pair: GearPair, point: OperatingPoint) -> tuple[FilmGroups, FilmGroups]:
    mesh = lubricated_mesh(section, pair, point)
    position = np.linspace(pair.contact_start_m, pair.contact_end_m, POSITIONS)
    # Without torque flanks touch now and then: there is no film under no load.
    loaded_n = point.torque_nm / pair.pinion.base_radius_m
    force = FORCE_SHARES * (loaded_n if loaded_n > 0.0 else light_force_n(pair))
    healthy_m, pitted_m = composite_roughness_m(section)
    return mesh.groups(position, force, healthy_m), mesh.groups(position, force, pitted_m)


def _united(found: tuple[FilmGroups, ...]) -> FilmGroups:
    def values(name: str) -> Values:
        return np.concatenate([np.ravel(getattr(groups, name)) for groups in found])

    return FilmGroups(*(values(name) for name in FilmGroups._fields))
