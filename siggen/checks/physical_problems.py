"""What is physically impossible in a configuration: gears that cannot mesh, damage that does not lie on the flank.

Everything is checked at the bounds of the distributions, so that no specimen can turn out impossible.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from siggen.checks.bearing_problems import bearing_problems
from siggen.checks.edge_problems import edge_problems
from siggen.checks.housing_problems import housing_problems
from siggen.checks.mesh_sections import first_sections, ring_sections, stage_sections
from siggen.checks.pair_problems import pair_problems
from siggen.checks.ring_problems import ring_problems, rings_round
from siggen.checks.shaft_problems import shaft_problems
from siggen.checks.stage_layout_problems import stage_layout_problems
from siggen.checks.tilt_problems import tilt_problems
from siggen.checks.variation_problems import variation_problems
from siggen.config import Dynamics, Gears, ParsedConfig, Stiffness
from siggen.config.short_form import names_in
from siggen.errors import Problem
from siggen.faults.fault import Fault
from siggen.faults.flank_place import allowed_text, found_problems, in_mm, mesh_of_gear
from siggen.gearbox.configured import possible_states
from siggen.gearbox.pair import gear_pair, stiffness_options
from siggen.gears.errors.iso_1328 import outside_iso_1328
from siggen.gears.geometry.gear_pair import GearPair, GeometryProblem, geometry_problems
from siggen.gears.stiffness.coupled_pairs import StiffTeethError
from siggen.gears.stiffness.mesh_stiffness import mesh_stiffness
from siggen.keys.drawing import corners
from siggen.keys.number import bounds

KEYS = {
    "teeth": "teeth",
    "bore_radius_m": "bore_radius_mm",
    "centre_distance_m": "centre_distance_mm",
}
"""Key of the configuration that a geometry problem is about, where one key is to blame."""

USUAL_RATIO = 10.0
"""Of one pair of spur gears; beyond it the ratio is the cause, whatever follows from it."""
PLACES = 65
"""Angles over one pitch at which a coupling is checked: compliances change smoothly between."""


def physical_problems(parsed: ParsedConfig) -> tuple[Problem, ...]:
    """Return the physical problems of the sections that are valid, each path once; of each pair of a set the first."""
    gears: Gears | None = parsed.sections.get("gears")
    if gears is None:
        return ()
    if gears.pairs and _has_stages(parsed.sections):  # refused together
        return ()
    if gears.pairs:
        return pair_problems(parsed.sections, _problems)
    behind = (_located_in(path, one) for path, own in stage_sections(parsed.sections) for one in _problems(own))
    ring = _of_ring(parsed.sections)
    return (*_problems(first_sections(parsed.sections)), *ring, *behind, *stage_layout_problems(parsed.sections))


def _has_stages(sections: Mapping[str, Any]) -> bool:
    """Return whether there are further meshes, or damage names one."""
    damages = (one for state in sections.get("states", {}).values() for one in state.damages)
    return bool(sections.get("stages")) or any(mesh_of_gear(one.hit_gear) for one in damages)


def _located_in(path: str, problem: Problem) -> Problem:
    """Return a problem of a further stage where its file has what it is about."""
    own = problem.path.startswith("gears") or problem.path == "manufacture"
    return replace(problem, path=f"{path}.{problem.path}") if own else problem


def _problems(sections: Mapping[str, Any]) -> tuple[Problem, ...]:
    gears: Gears = sections["gears"]
    pairs = [gear_pair(corner) for corner in corners(_without_material(gears))]
    problems = [_located(problem) for pair in pairs for problem in geometry_problems(pair)]
    sound = [pair for pair in pairs if not geometry_problems(pair)]
    flanks = list({_without_bores(pair): pair for pair in sound}.values())
    dynamics: Dynamics | None = sections.get("dynamics")
    # A section dynamics that is refused for itself says nothing about damage: no second problem that follows from it.
    through_face = dynamics is None or dynamics.mesh.law == "pairs"
    for index, state in (item for states in possible_states(sections.get("states", {})) for item in states.items()):
        for path, damage in state.placed(f"states.{index}"):
            problems += _state_problems(flanks, damage, path, through_face=through_face)
    if sections.get("manufacture") is not None:
        driver, driven = names_in(sections["machine"], planetary=False).first.gears
        problems += _outside_tolerances(sound, {"pinion": driver.word, "gear": driven.word})
    problems += _coupling_problems(gears, sections.get("stiffness"), sound)
    problems += bearing_problems(sections)
    problems += variation_problems(sections, sound)
    problems += shaft_problems(sections, sound)
    problems += housing_problems(sections, sound)
    problems += edge_problems(sections, sound)
    problems += tilt_problems(sections, flanks)
    problems += ring_problems(sections.get("planetary"), flanks)
    return tuple({problem.path: problem for problem in reversed(problems)}.values())


def _of_ring(sections: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield what is wrong with the ring of a planetary set: damage off its flanks, each path once, and tolerances."""
    section, gears = sections.get("planetary"), sections["gears"]
    if section is None:
        return
    sound = [one for one in map(gear_pair, corners(_without_material(gears))) if not geometry_problems(one)]
    rings = rings_round(section, sound)
    if sections.get("manufacture") is not None:
        yield from _outside_tolerances(rings, {"gear": "ring"})
    found = [
        problem
        for state, one in ring_sections(sections)["states"].items()
        for path, damage in one.placed(f"states.{state}")
        for problem in _state_problems(rings, damage, path, through_face=True)
    ]
    yield from {problem.path: problem for problem in reversed(found)}.values()


def _outside_tolerances(pairs: Sequence[GearPair], members: Mapping[str, str]) -> Iterator[Problem]:
    for pair in pairs:
        for which, name in members.items():
            for problem in outside_iso_1328(pair.member(which), pair.face_width_m, which, pair.helix_rad):
                received = f"tolerances for a {name} with {problem.name} {problem.received}"
                yield Problem("manufacture", received, f"{problem.allowed}; or null")


def _coupling_problems(gears: Gears, stiffness: Stiffness | None, pairs: list[GearPair]) -> Iterator[Problem]:
    """Yield a coupling that the teeth of a beam are too stiff for; damage, which softens them, never makes them so."""
    if stiffness is None or stiffness.coupled_by == "none":
        return
    options, largest = stiffness_options(stiffness), bounds(gears.poisson_ratio)[1]
    for pair in pairs:
        try:
            # The bodies' twist grows with Poisson's ratio, the contact's compliance falls.
            mesh_stiffness(replace(pair, poisson_ratio=largest), _one_pitch_rad(pair), options)
        except StiffTeethError:
            stiff = "whose teeth deflect less than their neighbour deflects them"
            received = f"'{stiffness.coupling}' with beam: {stiffness.beam}, {stiff}"
            low, high = sorted((pair.pinion.teeth, pair.gear.teeth))
            if high > USUAL_RATIO * low:
                name = "gear" if pair.gear.teeth == high else "pinion"
                received = f"{high} against {low}, a ratio of {high / low:.3g}; stiffness.coupling is then {received}"
                allowed = f"allowed: a ratio up to {USUAL_RATIO:g}, as pairs have; else coupling: none"
                yield Problem(f"gears.{name}.teeth", received, allowed)
                continue
            yield Problem(
                "stiffness.coupling", received, "allowed: none, or larger bores, or a softer beam such as calibrated"
            )


def _one_pitch_rad(pair: GearPair) -> NDArray[np.float64]:
    return np.linspace(0.0, 2.0 * math.pi / pair.pinion.teeth, PLACES)


def _without_material(gears: Gears) -> Gears:
    """Return the section with one material; geometry does not need it, and each distribution doubles the corners."""
    material = {key: bounds(getattr(gears, key))[0] for key in ("youngs_modulus_gpa", "poisson_ratio")}
    return gears.model_copy(update=material)


def _without_bores(pair: GearPair) -> GearPair:
    """Return the pair with bores that say nothing, so that pairs of equal teeth are equal."""
    return replace(pair, pinion=replace(pair.pinion, bore_radius_m=0.0), gear=replace(pair.gear, bore_radius_m=0.0))


def _located(problem: GeometryProblem) -> Problem:
    section = "gears" if problem.where == "pair" else f"gears.{problem.where}"
    key = KEYS.get(problem.name)
    received = in_mm(problem.received) if key else f"{problem.name}: {in_mm(problem.received)}"
    if problem.name == "rack tip":
        section = "gears"
    return Problem(f"{section}.{key}" if key else section, received, allowed_text(problem.allowed))


def _state_problems(pairs: Sequence[GearPair], damage: Fault, path: str, *, through_face: bool) -> Iterator[Problem]:
    """Yield what is wrong with the damage of a state; with `through_face` it may take the whole contact length."""
    for pair in pairs:
        misplaced = [replace(problem, path=f"{path}.{problem.path}") for problem in damage.place_problems(pair)]
        yield from misplaced
        if not misplaced and not through_face:
            yield from found_problems(pair, damage.widest(pair), path)
