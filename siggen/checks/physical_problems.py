"""What is physically impossible in a configuration: gears that cannot mesh, damage that does not lie on the flank.

Everything is checked at the bounds of the distributions, so that no specimen can turn out impossible.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from siggen.checks.shaft_problems import shaft_problems
from siggen.checks.variation_problems import variation_problems
from siggen.config import (
    ClusteredPits,
    DamageModel,
    Dynamics,
    Gears,
    LayeredPits,
    ListedPits,
    Number,
    ParsedConfig,
    Spalls,
    SpallSize,
    Stiffness,
    bounds,
    corners,
)
from siggen.config.damage import PitSize
from siggen.errors import Problem
from siggen.gears.damage.flank_damage import Damage, Pit, Spall, damage_problems, flank_heights
from siggen.gears.errors.iso_1328 import outside_iso_1328
from siggen.gears.geometry.gear_pair import GearPair, GeometryProblem, geometry_problems
from siggen.gears.stiffness.coupled_pairs import StiffTeethError
from siggen.gears.stiffness.mesh_stiffness import mesh_stiffness
from siggen.specimen.contact import damage_is_geometry
from siggen.specimen.friction import roughness_problem
from siggen.specimen.gears import gear_pair, pit_height_m, stiffness_options
from siggen.specimen.spalls import spall_on_tooth

PROBE_M = 1e-9
"""Size of a pit that is checked for its place alone."""

KEYS = {
    "teeth": "teeth",
    "bore_radius_m": "bore_radius_mm",
    "centre_distance_m": "centre_distance_mm",
    "rack tip": "clearance_coefficient",
}
"""Key of the configuration that a geometry problem is about, where one key is to blame."""

GO_ON = {"contact": ", or dynamics.mesh.law: pairs with dynamics.mesh.damage: all or geometry"}
"""What else to do about a problem, by its name."""

PLACES = 65
"""Angles over one pitch at which a coupling is checked: compliances change smoothly between."""

SIZE_KEYS = ("face_length_mm", "profile_length_mm", "lower_width_mm", "upper_width_mm", "depth_mm")
SPALL_KEYS = {
    "height_m": "centre_height_mm",
    "face_m": "face_centre_mm",
    "depth_m": "depth_mm",
    "vertices_m": "vertices",
}
"""Key of the configuration that a problem of a spall is about."""


@dataclass(frozen=True, slots=True)
class _Place:
    """A place where pits of a state may come to lie, and the keys of the configuration that put them there."""

    gear: str
    height_m: float
    face_m: float
    size: PitSize
    height_key: str
    face_key: str
    depth_key: str
    remark: str = ""


def physical_problems(parsed: ParsedConfig) -> tuple[Problem, ...]:
    """Return the physical problems of the sections that are valid, each path once."""
    gears: Gears | None = parsed.sections.get("gears")
    if gears is None:
        return ()
    pairs = [gear_pair(corner) for corner in corners(_without_material(gears))]
    problems = [_located(problem) for pair in pairs for problem in geometry_problems(pair)]
    sound = [pair for pair in pairs if not geometry_problems(pair)]
    flanks = list({_without_bores(pair): pair for pair in sound}.values())
    dynamics: Dynamics | None = parsed.sections.get("dynamics")
    # A section dynamics that is refused for itself says nothing about damage: no second problem that follows from it.
    through_face = dynamics is None or damage_is_geometry(dynamics)
    for index, state in parsed.sections.get("states", {}).items():
        if state.damage is not None:
            problems += _state_problems(flanks, state.damage, f"states.{index}.damage", through_face=through_face)
    if parsed.sections.get("manufacture") is not None:
        problems += _tolerance_problems(sound)
    problems += _friction_problems(dynamics)
    problems += _coupling_problems(gears, parsed.sections.get("stiffness"), sound)
    problems += variation_problems(parsed.sections, sound)
    problems += shaft_problems(parsed.sections, sound)
    return tuple({problem.path: problem for problem in reversed(problems)}.values())


def _tolerance_problems(pairs: list[GearPair]) -> Iterator[Problem]:
    for pair in pairs:
        for which in ("pinion", "gear"):
            for problem in outside_iso_1328(pair.member(which), pair.face_width_m, which):
                received = f"tolerances for a {which} with {problem.name} {problem.received}"
                yield Problem("manufacture", received, f"{problem.allowed}; or null")


def _friction_problems(dynamics: Dynamics | None) -> list[Problem]:
    allowed = "" if dynamics is None else roughness_problem(dynamics.friction)
    if dynamics is None or not allowed:
        return []
    received = f"{dynamics.friction.roughness_um} with fluid: {dynamics.friction.fluid}"
    return [Problem("dynamics.friction.roughness_um", received, f"allowed: what the model holds for: {allowed}")]


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
    received = _in_mm(problem.received) if key else f"{problem.name}: {_in_mm(problem.received)}"
    if problem.name == "rack tip":
        section = "gears"
    return Problem(f"{section}.{key}" if key else section, received, _allowed(problem.allowed))


def _allowed(text: str) -> str:
    return "allowed: " + _in_mm(text.removeprefix("allowed: "))


def _in_mm(text: str) -> str:
    """Return a text with its lengths in mm, the unit of the configuration."""
    text = re.sub(r"\b([a-z_]+)_m (?=[-\d])", r"\1 ", text)
    return re.sub(r"(-?\d[\d.]*(?:e[-+]?\d+)?) m\b", lambda found: f"{float(found[1]) * 1e3:.6g} mm", text)


def _state_problems(pairs: list[GearPair], damage: DamageModel, path: str, *, through_face: bool) -> Iterator[Problem]:
    """Yield what is wrong with the damage of a state; with `through_face` it may take the whole contact length."""
    for pair in pairs:
        misplaced = [problem for place in _places(pair, damage) for problem in _place_problems(pair, place, path)]
        for key, size, reading in _spalls(damage):
            misplaced += _spall_problems(pair, size, reading, f"{path}.{key}" if key else path)
        yield from misplaced
        if not misplaced and not through_face:
            yield from _found(pair, _widest_row(pair, damage), path)


def _place_problems(pair: GearPair, place: _Place, path: str) -> list[Problem]:
    """Return what is wrong with one place: its height and its place on the face first, then the depth there."""
    middle_m = pair.face_width_m / 2
    at_height = _found(pair, (_probe(place, place.height_m, middle_m),), f"{path}.{place.height_key}", place.remark)
    pitch_m = pit_height_m(pair, place.gear, "pitch", "axial")
    at_face = _found(pair, (_probe(place, pitch_m, place.face_m),), f"{path}.{place.face_key}", place.remark)
    if at_height or at_face:
        return [*at_height, *at_face]
    deepest = replace(
        _probe(place, place.height_m, middle_m),
        semi_axis_profile_m=bounds(place.size.semi_axis_profile_mm)[1] / 1e3,
        depth_m=bounds(place.size.depth_mm)[1] / 1e3,
    )
    return _found(pair, (deepest,), f"{path}.{place.depth_key}", place.remark)


def _probe(place: _Place, height_m: float, face_m: float) -> Pit:
    return Pit(place.gear, 0, height_m, face_m, PROBE_M, PROBE_M, PROBE_M, place.size.floor)


def _spalls(damage: DamageModel) -> Iterator[tuple[str, SpallSize, str]]:
    """Yield the spalls of a state: the key below which they stand, their section, and how their heights are read."""
    match damage:
        case Spalls():
            yield "", damage, damage.height_reading
        case ListedPits():
            yield from ((f"spalls.{i}", spall, damage.height_reading) for i, spall in enumerate(damage.spalls))


def _spall_problems(pair: GearPair, size: SpallSize, reading: str, path: str) -> Iterator[Problem]:
    """Yield what is wrong with a spall by itself, at every combination of its bounds."""
    for corner in corners(size):
        spall = spall_on_tooth(pair, corner, reading, 0)
        for problem in damage_problems(pair, (spall,)):
            if problem.name != "contact":
                key = _spall_key(size, problem.name)
                yield Problem(f"{path}.{key}", _in_mm(problem.received), _allowed(problem.allowed))


def _spall_key(size: SpallSize, name: str) -> str:
    if size.shape == "polygon" and name in ("height_m", "face_m"):
        return "vertices"
    if name == "depth_m" and size.depth_law == "length_squared":
        return "depth_coefficient_um_per_mm2"
    return SPALL_KEYS.get(name, "profile_length_mm")


def _largest_spall(pair: GearPair, size: SpallSize, reading: str, tooth: int) -> Spall:
    """Return a spall with all its sizes at their upper and its place at its lower bounds, without depth to speak of."""
    sizes = {key: value for key in SIZE_KEYS if (value := getattr(size, key)) is not None}
    largest = size.model_copy(update={key: bounds(value)[1] for key, value in sizes.items()})
    spall = spall_on_tooth(pair, next(corners(largest)), reading, tooth)
    return replace(spall, depth_m=PROBE_M)


def _found(pair: GearPair, pits: Damage, path: str, remark: str = "") -> list[Problem]:
    return [
        Problem(path, f"{remark}{_in_mm(problem.received)}", _allowed(problem.allowed) + GO_ON.get(problem.name, ""))
        for problem in damage_problems(pair, pits)
    ]


def _places(pair: GearPair, damage: DamageModel) -> Iterator[_Place]:
    match damage:
        case LayeredPits():
            yield from _layered_places(pair, damage)
        case ClusteredPits():
            middle_m, keys = pair.face_width_m / 2, ("centre_height_mm", "spread_face_mm", "depth_mm")
            for height_m in _heights_m(pair, damage.gear, damage.centre_height_mm, damage.height_reading):
                yield _Place(damage.gear, height_m, middle_m, damage, *keys)
            for height_m in flank_heights(pair.member(damage.gear)):
                remark = "a pit scattered to the end of the flank: "
                yield _Place(damage.gear, height_m, middle_m, damage, *keys, remark)
        case ListedPits():
            for index, pit in enumerate(damage.pits):
                listed = f"pits.{index}"
                for height_m in _heights_m(pair, pit.gear, pit.height_mm, damage.height_reading):
                    for face_mm in bounds(pit.face_mm):
                        yield _Place(
                            pit.gear,
                            height_m,
                            face_mm / 1e3,
                            pit,
                            f"{listed}.height_mm",
                            f"{listed}.face_mm",
                            f"{listed}.depth_mm",
                        )


def _layered_places(pair: GearPair, damage: LayeredPits) -> Iterator[_Place]:
    """Yield the outermost pits of the first and of the last row, moved outwards as far as jitter may move them."""
    jitter_m = bounds(damage.jitter_mm)[1] / 1e3
    centres_m = (
        [pair.face_width_m / 2] if damage.face_centre_mm is None else [x / 1e3 for x in bounds(damage.face_centre_mm)]
    )
    reach_m = (damage.pits_per_layer - 1) / 2 * bounds(damage.spacing_face_mm)[1] / 1e3 + jitter_m
    climb_m = (damage.layers - 1) * bounds(damage.spacing_profile_mm)[1] / 1e3
    face_key = "spacing_face_mm" if damage.pits_per_layer > 1 else "face_centre_mm"
    for first_m in _heights_m(pair, damage.gear, damage.first_height_mm, damage.height_reading):
        for row, height_m in ((1, first_m - jitter_m), (damage.layers, first_m + climb_m + jitter_m)):
            for face_m in (centres_m[0] - reach_m, centres_m[-1] + reach_m):
                remark = f"outermost pit of row {row} of {damage.layers}: "
                yield _Place(damage.gear, height_m, face_m, damage, "first_height_mm", face_key, "depth_mm", remark)


def _heights_m(pair: GearPair, gear: str, height_mm: Number | str, reading: str) -> list[float]:
    if isinstance(height_mm, str):
        return [pit_height_m(pair, gear, height_mm, reading)]
    return [pit_height_m(pair, gear, value, reading) for value in dict.fromkeys(bounds(height_mm))]


def _widest_row(pair: GearPair, damage: DamageModel) -> Damage:
    """Return the damage of a state that may together take away the whole width of contact, as large as it may be.

    Scattered pits are left out: how much of the width they take is known only when they are drawn.
    """
    match damage:
        case LayeredPits():
            height_m = _heights_m(pair, damage.gear, damage.first_height_mm, damage.height_reading)[0]
            return tuple(_largest(damage.gear, 0, height_m, face_m, damage) for face_m in _row_faces_m(pair, damage))
        case Spalls():
            return (_largest_spall(pair, damage, damage.height_reading, 0),)
        case ListedPits():
            pits = tuple(
                _largest(
                    pit.gear,
                    pit.tooth,
                    _heights_m(pair, pit.gear, pit.height_mm, damage.height_reading)[0],
                    bounds(pit.face_mm)[0] / 1e3,
                    pit,
                )
                for pit in damage.pits
                if pit.tooth < pair.member(pit.gear).teeth  # others are refused by name elsewhere
            )
            spalls = [s for s in damage.spalls if s.tooth < pair.member(s.gear).teeth]
            return (*pits, *(_largest_spall(pair, s, damage.height_reading, s.tooth) for s in spalls))
    return ()


def _largest(gear: str, tooth: int, height_m: float, face_m: float, size: PitSize) -> Pit:
    across_m, along_m = bounds(size.semi_axis_face_mm)[1] / 1e3, bounds(size.semi_axis_profile_mm)[1] / 1e3
    return Pit(gear, tooth, height_m, face_m, across_m, along_m, PROBE_M, size.floor)


def _row_faces_m(pair: GearPair, damage: LayeredPits) -> list[float]:
    centre_m = pair.face_width_m / 2 if damage.face_centre_mm is None else bounds(damage.face_centre_mm)[0] / 1e3
    spacing_m = bounds(damage.spacing_face_mm)[1] / 1e3
    return [centre_m + (i - (damage.pits_per_layer - 1) / 2) * spacing_m for i in range(damage.pits_per_layer)]
