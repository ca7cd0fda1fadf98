"""What is physically impossible in a configuration: gears that cannot mesh, damage that does not lie on the flank.

Everything is checked at the bounds of the distributions, so that no specimen can turn out impossible.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from siggen.checks.bearing_problems import bearing_problems
from siggen.checks.edge_problems import edge_problems
from siggen.checks.housing_problems import housing_problems
from siggen.checks.pair_problems import pair_problems
from siggen.checks.shaft_problems import shaft_problems
from siggen.checks.stage_layout_problems import stage_layout_problems
from siggen.checks.tilt_problems import tilt_problems
from siggen.checks.variation_problems import variation_problems
from siggen.errors import Problem
from siggen.faults.fault import Fault
from siggen.faults.flank_place import found_problems
from siggen.gearbox.pair import mesh_options
from siggen.gearbox.possible import PossibleGearbox, PossibleMesh
from siggen.gears.errors.iso_1328 import outside_iso_1328
from siggen.gears.geometry.gear_pair import GearPair, GeometryProblem
from siggen.gears.geometry.internal_pair import InternalPair
from siggen.gears.stiffness.coupled_pairs import StiffTeethError
from siggen.gears.stiffness.mesh_stiffness import mesh_stiffness
from siggen.names import GEAR, PINION, Side

KEYS = {
    "teeth": "teeth",
    "bore_radius_m": "bore_radius_mm",
    "centre_distance_m": "centre_distance_mm",
}
"""Key of the configuration that a geometry problem is about, where one key is to blame."""

OF_DYNAMICS = (
    bearing_problems, variation_problems, shaft_problems, housing_problems, edge_problems, tilt_problems,
)  # fmt: skip
USUAL_RATIO = 10.0
"""Of one pair of spur gears; beyond it the ratio is the cause, whatever follows from it."""
PLACES = 65
"""Angles over one pitch at which a coupling is checked: compliances change smoothly between."""


def physical_problems(gearbox: PossibleGearbox) -> tuple[Problem, ...]:
    """Return the physical problems of valid sections, each path once; of each pair of a set the first."""
    if "gears" in gearbox.refused:
        return ()
    if not gearbox.config.gears.pairs:
        return _problems(gearbox)
    if gearbox.config.stages or "operating_points" in gearbox.refused:  # told together; no torque to carry over
        return ()
    return pair_problems(gearbox, _problems)


def _problems(gearbox: PossibleGearbox) -> tuple[Problem, ...]:
    # A section dynamics that is refused for itself says nothing: no problem that follows from it.
    through_face = "dynamics" in gearbox.refused or gearbox.config.dynamics.mesh.law == "pairs"
    problems: list[Problem] = []
    for mesh in gearbox.meshes:
        problems += [_located(mesh, problem) for problem in mesh.problems]
        for path, damage in mesh.damages:
            problems += _state_problems(mesh, damage, path, through_face=through_face or mesh.internal)
        if gearbox.config.manufacture is not None:
            problems += _outside_tolerances(mesh)
        problems += _coupling_problems(mesh, gearbox)
    for check in OF_DYNAMICS if "dynamics" not in gearbox.refused else ():
        problems += check(gearbox)
    problems += stage_layout_problems(gearbox)
    return tuple({problem.path: problem for problem in reversed(problems)}.values())


def _outside_tolerances(mesh: PossibleMesh) -> Iterator[Problem]:
    """Yield gears that the standard knows no tolerances of; a planet has those of its mesh with the sun."""
    for pair in mesh.pairs:
        for side in (Side.DRIVEN,) if isinstance(pair, InternalPair) else Side:
            for problem in outside_iso_1328(pair.member(side), pair.face_width_m, side, pair.helix_rad):
                received = f"tolerances for a {mesh.name.gear(side).word} with {problem.name} {problem.received}"
                yield Problem("manufacture", received, f"{problem.allowed}; or null")


def _coupling_problems(mesh: PossibleMesh, gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield a coupling that the teeth of a beam are too stiff for; damage, which softens them, never makes them so."""
    for pair in mesh.pairs:
        options = mesh_options(pair, gearbox.bending)
        try:
            if options.coupling != "none":
                mesh_stiffness(pair, _one_pitch_rad(pair), options)
        except StiffTeethError:
            stiff = "whose teeth deflect less than their neighbour deflects them"
            received = f"'{gearbox.config.stiffness.coupling}' with beam: {options.beam}, {stiff}"
            low, high = sorted((pair.pinion.teeth, pair.gear.teeth))
            if high > USUAL_RATIO * low:
                name = GEAR if pair.gear.teeth == high else PINION
                received = f"{high} against {low}, a ratio of {high / low:.3g}; stiffness.coupling is then {received}"
                allowed = f"allowed: a ratio up to {USUAL_RATIO:g}, as pairs have; else coupling: none"
                yield Problem(f"{mesh.at}gears.{name}.teeth", received, allowed)
                continue
            yield Problem(
                "stiffness.coupling", received, "allowed: none, or larger bores, or a softer beam such as calibrated"
            )


def _one_pitch_rad(pair: GearPair) -> NDArray[np.float64]:
    return np.linspace(0.0, 2.0 * math.pi / pair.pinion.teeth, PLACES)


def _located(mesh: PossibleMesh, problem: GeometryProblem) -> Problem:
    if mesh.internal:
        received = f"{problem.name}, {problem.where}: {problem.received}" if problem.received else problem.where
        return Problem(f"{mesh.at}ring_teeth", received, problem.allowed)
    section = "gears" if problem.where == "pair" or problem.name == "rack tip" else f"gears.{problem.where}"
    key = KEYS.get(problem.name)
    received = problem.received if key else f"{problem.name}: {problem.received}"
    path = f"{mesh.at}{section}.{key}" if key else f"{mesh.at}{section}"
    return Problem(path, received, problem.allowed)


def _state_problems(mesh: PossibleMesh, damage: Fault, path: str, *, through_face: bool) -> Iterator[Problem]:
    """Yield what is wrong with the damage of a state; with `through_face` it may take the whole contact length."""
    for pair in mesh.flanks:
        misplaced = [replace(problem, path=f"{path}.{problem.path}") for problem in damage.place_problems(pair)]
        yield from misplaced
        if not misplaced and not through_face:
            yield from found_problems(pair, damage.widest(pair), path, called=[gear.word for gear in mesh.name.gears])
