"""Forces that come with the rotation of a specimen's shafts: unbalance."""

from __future__ import annotations

from math import pi

from siggen.dynamics.drive.excitation import InputSource
from siggen.dynamics.drive.external_forces import Unbalance, bearing_places, shaft_mass, turning_sense
from siggen.dynamics.structure.structure import Structure
from siggen.gearbox.specimen import Specimen

RATED_SPEED_HZ = 50.0
"""Of the pinion shaft, to which a grade of balance belongs; that of the others by their ratios."""


def force_sources(specimen: Specimen, structure: Structure) -> tuple[InputSource, ...]:
    """Return the unbalance of all shafts where a gearbox has it.

    Raises
    ------
    ValueError
        If the structure has no bearings.
    """
    levels = specimen.unbalance
    if levels is None:
        return ()
    shafts = zip(bearing_places(structure), map(float, specimen.shaft_turns), levels.phases_rad, strict=True)
    return tuple(_unbalance(structure, levels.grade_mm_s, *shaft) for shaft in shafts)


def _unbalance(structure: Structure, grade_mm_s: float, place: str, order: float, phase_rad: float) -> Unbalance:
    mass_kg, directions = shaft_mass(structure, place)
    return Unbalance(
        directions=directions,
        moment_kg_m=mass_kg * 1e-3 * grade_mm_s / (2.0 * pi * RATED_SPEED_HZ * order),
        order=order * turning_sense(structure, place),
        phase_rad=phase_rad,
    )
