"""Forces that come with the rotation of a specimen's shafts: unbalance."""

from __future__ import annotations

from math import pi

from siggen.config import Config
from siggen.dynamics.drive.excitation import Source
from siggen.dynamics.drive.external_forces import (
    Unbalance,
    bearing_places,
    shaft_mass,
    turning_sense,
)
from siggen.dynamics.structure.structure import Structure
from siggen.keys.number import constant
from siggen.planning.specimen import Specimen
from siggen.seeding import Stage, named_uniforms

RATED_SPEED_HZ = 50.0
"""Of the pinion shaft, to which a grade of balance belongs; that of the others by their ratios."""


def force_sources(config: Config, specimen: Specimen, structure: Structure) -> tuple[Source, ...]:
    """Return the unbalance of all shafts where a drawn `dynamics` section has it.

    Raises
    ------
    ValueError
        If the structure has no bearings.
    """
    if constant(specimen.dynamics.unbalance.grade_mm_s) <= 0.0:
        return ()
    orders = map(float, specimen.shaft_turns)
    by_shaft = zip(bearing_places(structure), orders, strict=True)
    return tuple(_unbalance(config, specimen, structure, place, order) for place, order in by_shaft)


def _unbalance(config: Config, specimen: Specimen, structure: Structure, place: str, order: float) -> Unbalance:
    section = specimen.dynamics.unbalance
    uniform = named_uniforms(config.seed, Stage.SUPPORTS, specimen.specimen_id)
    mass_kg, directions = shaft_mass(structure, place)
    rated_rad_s = 2.0 * pi * RATED_SPEED_HZ * order
    return Unbalance(
        directions=directions,
        moment_kg_m=mass_kg * 1e-3 * constant(section.grade_mm_s) / rated_rad_s,
        order=order * turning_sense(structure, place),
        phase_rad=2.0 * pi * uniform(f"dynamics.unbalance.{place}.phase"),
    )
