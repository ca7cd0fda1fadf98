"""Options of the stiffness model that a configuration names, and what to know about it."""

from __future__ import annotations

from dataclasses import replace

from siggen.config import Config, Stiffness
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.internal_pair import InternalPair
from siggen.gears.stiffness.stiffness_notes import stiffness_notes
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from siggen.keys.drawing import corners
from siggen.planning.gear_pair import gear_pair

__all__ = ["gear_pair", "mesh_options", "model_notes", "stiffness_options"]


def stiffness_options(stiffness: Stiffness) -> StiffnessOptions:
    """Return the options of the stiffness model that a section `stiffness` names."""
    return StiffnessOptions(stiffness.beam, coupling=stiffness.coupled_by)


def mesh_options(pair: GearPair, options: StiffnessOptions) -> StiffnessOptions:
    """Return the options of one pair of a gearbox: in a ring neighbours do not act on each other."""
    return replace(options, coupling="none") if isinstance(pair, InternalPair) else options


def model_notes(config: Config) -> tuple[str, ...]:
    """Return what to know about the stiffness model of a set, at the bounds of its gears, each sentence once."""
    options = stiffness_options(config.stiffness)
    gears = [gear.word for gear in config.names.first.gears]
    notes = (note for corner in corners(config.gears) for note in stiffness_notes(gear_pair(corner), options, gears))
    return tuple(dict.fromkeys(notes))
