"""How far the tables that simulations use are from what they stand for, of one specimen, in numbers and in words."""

from __future__ import annotations

import numpy as np

from siggen.config import Config
from siggen.gears.contact.contact_table import contact_table
from siggen.gears.contact.contact_table_error import ContactTableError, contact_table_error
from siggen.gears.contact.table_options import face_slices
from siggen.gears.damage.tooth_damage import Damage, has_extent, on_teeth
from siggen.gears.stiffness.mesh_tables import TABLE_POINTS, mesh_tables, table_error
from siggen.planning.gearbox import gearbox_config
from siggen.planning.specimen import draw_operating_point, draw_specimen
from siggen.specimen.contact import face_options, largest_force_n, solves_across_the_face
from siggen.specimen.damage import state_damage
from siggen.specimen.errors import specimen_errors
from siggen.specimen.friction import mean_force_n
from siggen.specimen.gears import gear_pair, stiffness_options

STATES = 3
"""States whose contact is looked at: a table and its error cost some tenths of a second each."""
PLACES = 8
"""Per kind of pair, at which a table of the contact is compared with its solver."""


def worst_table_error(config: Config, specimen_id: int = 0, points: int = TABLE_POINTS) -> float:
    """Return the largest relative error of the interpolated stiffness tables of one specimen over all its states.

    Of healthy teeth where the contact is solved across the face, which has tables of its own.

    Source: `siggen.gears.stiffness.mesh_tables.table_error`, half-way between the points of the tables that simulations
    use.
    """
    config = gearbox_config(config, specimen_id)
    specimen = draw_specimen(config, specimen_id)
    pair, options = gear_pair(specimen.gears), stiffness_options(specimen.stiffness)
    damages: dict[Damage, None] = {(): None}
    if not solves_across_the_face(specimen.dynamics):
        damages = dict.fromkeys(on_teeth(state_damage(config, specimen_id, pair, i)) for i in range(len(config.states)))
    return max(table_error(pair, d, options, mesh_tables(pair, d, options, points=points)) for d in damages)


def table_error_text(config: Config, specimen_id: int = 0) -> str:
    """Return in words how exactly the tables of one specimen's stiffness, or contact across the face, are."""
    if solves_across_the_face(config.dynamics):
        return _contact_text(config, specimen_id)
    try:
        error = f"within {100.0 * worst_table_error(config, specimen_id):.2g} %"
    except ValueError as refusal:
        error = f"nowhere: {refusal}"
    return (
        f"tables of {TABLE_POINTS} points, as simulations use them, interpolate the stiffness of "
        f"teeth in all states of specimen {specimen_id} {error}"
    )


def worst_contact_table_error(
    config: Config, specimen_id: int = 0, points: int = TABLE_POINTS
) -> tuple[ContactTableError, tuple[str, ...]]:
    """Return the errors of one specimen's contact tables over the force of its first operating point, and the states.

    The worst of sound teeth, which err at the ends of the path, where tips are near, and of the last `STATES` states
    that no other one grows from, whose damage holds the others'.

    Raises
    ------
    ValueError
        If what was drawn cannot be built.
    """
    config = gearbox_config(config, specimen_id)
    specimen = draw_specimen(config, specimen_id)
    pair, teeth = gear_pair(specimen.gears), stiffness_options(specimen.stiffness)
    options = face_options(specimen.dynamics, largest_force_n(config.operating_points, pair), pair)
    force_n = mean_force_n(pair, draw_operating_point(config, specimen_id, 0))
    milder = {config.grown_from(index) for index in range(len(config.states))}
    drawn = {i: on_teeth(state_damage(config, specimen_id, pair, i)) for i in range(len(config.states))}
    damaged = [i for i, on in drawn.items() if on and config.states[i].damaged and i not in milder]
    found = []
    for index in (None, *damaged[-STATES:]):
        damage = () if index is None else tuple(one for one in drawn[index] if has_extent(one))
        errors = specimen_errors(config, pair, specimen_id, index or 0)
        slices = face_slices(pair, options)
        lead = np.zeros(slices) if errors is None else errors.lead_m(slices)
        table = contact_table(pair, damage, teeth, options, points, lead)
        found.append(contact_table_error(pair, damage, teeth, options, table, force_n, PLACES, lead))
    worst = ContactTableError(*(max(values) for values in zip(*found, strict=True)))
    return worst, ("sound teeth", *(config.states[index].name for index in damaged[-STATES:]))


def _contact_text(config: Config, specimen_id: int) -> str:
    pair = gear_pair(draw_specimen(gearbox_config(config, specimen_id), specimen_id).gears)
    torque_nm = mean_force_n(pair, draw_operating_point(config, specimen_id, 0)) * pair.pinion.base_radius_m
    try:
        error, states = worst_contact_table_error(config, specimen_id)
    except ValueError as refusal:
        return f"tables of the contact across the face of specimen {specimen_id} cannot be made: {refusal}"
    return (
        f"tables of the contact across the face, as simulations use them, give the force of a pair within "
        f"{100.0 * error.rms:.2g} % rms and {100.0 * error.largest:.2g} % at most of the force at {torque_nm:.3g} N m "
        f"(specimen {specimen_id}: {', '.join(states)})"
    )
