"""Names of what no sensor sees: those that a configuration's model has, and those asked for that it has not."""

from __future__ import annotations

import difflib
from dataclasses import replace

from siggen.drivetrain.structure import Structure
from siggen.errors import Problem
from siggen.gearbox.draw import draw_specimen
from siggen.gearbox.possible import PossibleGearbox
from siggen.gearbox.specimen import Specimen
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import CORNER_REACH_PITCHES
from siggen.mesh.mesh_tables import TABLE_POINTS, mesh_tables
from siggen.names import Names
from siggen.record.motion import MeshBehind, SpecimenMesh, specimen_motion, teeth_missing
from siggen.record.structure import structure
from siggen.record.teeth import WavyTeeth

NEAREST = 3


def quantity_problems(gearbox: PossibleGearbox) -> list[Problem]:
    """Return the names in `internals.quantities` that the model does not have, each with those nearest to it."""
    section, problems = gearbox.config.internals, []
    available = available_quantities(gearbox) if section is not None and section.named else ()
    for place, name in section.named if section is not None else ():
        if name not in available:
            near = ", ".join(difflib.get_close_matches(name, available, NEAREST, cutoff=0.0))
            allowed = (
                f"allowed: all, or one of the {len(available)} quantities of this model; nearest: {near}; a record "
                "simulated alone without this key shows every one"
            )
            problems.append(Problem(f"internals.quantities.{place}", f"'{name}'", allowed))
    return problems


def available_quantities(gearbox: PossibleGearbox) -> tuple[str, ...]:
    """Return the names of all internal quantities of the records of a set.

    They follow from the configuration alone: the gears of the ranges with the longest path of contact have as many
    pairs in reach as any.
    """
    possible = ((own, pair) for own in gearbox.pairs for pair in own.meshes[0].pairs)
    own, pair = max(possible, key=lambda one: one[1].contact_ratio)
    reaches = (one.reach_pitches(pair) for state in own.config.states for one in state.damages)
    reach = max(reaches, default=CORNER_REACH_PITCHES)
    specimen = draw_specimen(own.config, 0)
    assembled = structure(specimen)
    behind = tuple(
        MeshBehind(_tabulated(one.pair, specimen, assembled), float(turning))
        for one, turning in zip(specimen.behind, specimen.shaft_turns[1:-1], strict=True)
    )
    mesh = replace(_tabulated(pair, specimen, assembled, reach), behind=behind)
    step_s = 1.0 / (specimen.sampling.fs_hz * specimen.law.steps_per_sample)
    law = specimen.law
    if law.across_the_face:  # every integrator has the same quantities; this one starts no motion
        law = law.by_reference()
    motion = specimen_motion(law, mesh, specimen.points[0], step_s)
    return quantity_names(specimen.names, motion.structure, motion.internal_names)


def _tabulated(
    pair: GearPair, specimen: Specimen, assembled: Structure, reach: float = CORNER_REACH_PITCHES
) -> SpecimenMesh:
    """Return a healthy mesh of a gearbox, whose corners are followed for a reach."""
    tables = mesh_tables(pair, (), specimen.meshes[0].teeth.options, points=TABLE_POINTS)
    teeth = WavyTeeth(teeth_missing(specimen.law, pair, TABLE_POINTS, reach), pair)
    return SpecimenMesh(pair, assembled, tables, teeth)


def quantity_names(names: Names, assembled: Structure, internal_names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names of the quantities of a motion of this structure with these internals."""
    return (
        angle_name(names),
        *(acceleration_name(place) for place in assembled.motions),
        *(bearing_force_name(place) for place in assembled.bearing_forces),
        *internal_names,
        "transmission_error_m",
    )


def angle_name(names: Names) -> str:
    """Return the name of the angle of the first driver."""
    return f"{names.first.driver.body}_angle_rad"


def acceleration_name(place: str) -> str:
    """Return the name of the clean acceleration of a motion such as "casing/vertical"."""
    return f"clean_accel_{'_'.join(place.split('/'))}_m_s2"


def bearing_force_name(place: str) -> str:
    """Return the name of a bearing force, or of the moment that keeps a ring from turning."""
    if place.endswith("/turning"):
        return f"support_moment_{place.rpartition('/')[0]}_nm"
    return f"bearing_force_{'_'.join(place.split('/'))}_n"
