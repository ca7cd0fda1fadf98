"""What is physically impossible in a configuration: gears that cannot mesh, damage that does not lie on the flank.

Everything is checked at the bounds of the distributions, so that no specimen can turn out impossible.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations, pairwise
from math import inf, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from siggen.arrays import FloatArray
from siggen.checks.housing_problems import housing_problems
from siggen.checks.tilt_problems import tilt_problems
from siggen.damage.ball_geometry import BallGeometry
from siggen.damage.bearing_spall import BearingSpalls
from siggen.damage.fault import Fault
from siggen.damage.flank_place import found_problems
from siggen.drivetrain.bearings import BallBearing
from siggen.errors import Problem
from siggen.gearbox.possible import PossibleGearbox, PossibleMesh
from siggen.gearbox.teeth import mesh_options
from siggen.gears.gear_pair import GearPair, GeometryProblem
from siggen.gears.planetary import InternalPair
from siggen.gears.tolerances import outside_iso_1328
from siggen.keys.drawing import corners
from siggen.keys.number import Number, bounds
from siggen.keys.problems import joined, refused_problems, section_problems
from siggen.keys.section import Section
from siggen.mesh.body_coupling import StiffTeethError
from siggen.mesh.mesh_stiffness import mesh_stiffness
from siggen.names import GEAR, PINION, SHAFT_OF, Side
from siggen.record.structure import LEAST_SPAN

# What is impossible for one of a set's gear pairs, told pair by pair, so that no gearbox turns out impossible.


def pair_problems(
    gearbox: PossibleGearbox, check: Callable[[PossibleGearbox], Iterable[Problem]]
) -> tuple[Problem, ...]:
    """Return the first problem of each pair of `gears.pairs`: a number out of its range, or what a check finds."""
    told = []
    for index, own in enumerate(gearbox.pairs):
        changed = {key: value for key, value in own.config if value is not getattr(gearbox.config, key)}
        outside = (one for key, value in changed.items() for one in _out_of_range(key, value))
        problem = next(outside, None) or next(iter(check(own)), None)
        if problem is not None:
            received = f"{gearbox.config.gears.pairs[index]}: {problem.path} would be {problem.received}"
            told.append(Problem(f"gears.pairs.{index}", received, problem.allowed))
    return tuple(told)


def _out_of_range(path: str, value: Any) -> Iterator[Problem]:
    """Yield numbers that a section must not hold, though nobody wrote them: they were carried over."""
    if isinstance(value, tuple):
        for place, entry in enumerate(value):
            named = isinstance(entry, Section) and entry.key_field
            yield from _out_of_range(joined(path, getattr(entry, named) if named else place), entry)
    elif isinstance(value, Section):
        own = {key: getattr(value, key) for key in type(value).model_fields}
        try:
            type(value).model_validate(
                own
            )  # not what it would be in a file: what a state has changed has no form there
        except ValidationError as error:
            for problem in section_problems(type(value), error.errors()):
                yield Problem(joined(path, problem.path), problem.received, problem.allowed)
        for key, inner in own.items():
            yield from _out_of_range(joined(path, key), inner)


# What is impossible about the bearings of shafts: balls that do not fit, spalls that do not fit their element.

OF_BALLS = (".geometry.", ".sizing.torque_factor", ".sizing.shear_n_per_mm2", ".sizing.series")
"""What balls follow from."""
STIFFNESS = "stiffness_n_per_m"
"""Key of a `bearing` that its `geometry` replaces."""


def bearing_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield the problems of both shafts at the bounds of all numbers."""
    for role in Side:
        spalls = [one for _, one in gearbox.meshes[0].damages if isinstance(one, BearingSpalls)]
        of_balls = OF_BALLS if spalls else (".geometry.",)  # nothing else asks what sizes gearboxes draw
        given = [one for one in corners(partial(gearbox.ball, role), *of_balls) if one is not None]
        crowded = [one for one in given if one.ball_diameter_m >= one.room_m]
        if crowded:
            received = f"{crowded[0].balls} balls of {1e3 * crowded[0].ball_diameter_m:g} mm"
            allowed = f"allowed: below {1e3 * crowded[0].room_m:.4g} mm, the distance of two balls' centres"
            yield Problem(f"dynamics.{role}.bearing.geometry.ball_diameter_mm", received, allowed)
        else:
            yield from _spall_problems(gearbox, f"{role}_bearing", given or [BallGeometry().bearing()])
        if given:
            yield from _change_problems(gearbox, gearbox.config.names.own_path(f"dynamics.{role}.bearing"))


def _spall_problems(gearbox: PossibleGearbox, place: str, bearings: list[BallBearing]) -> Iterator[Problem]:
    """Yield spalls that do not fit one of what a bearing may be."""
    for path, damage in gearbox.meshes[0].damages:
        if isinstance(damage, BearingSpalls) and damage.bearing == place:
            for bearing in bearings:
                yield from (replace(one, path=f"{path}.{one.path}") for one in damage.problems_in(bearing))


def _change_problems(gearbox: PossibleGearbox, at: str) -> Iterator[Problem]:
    """Yield changes of states to a stiffness that a bearing replaces: such a state would be healthy by another name."""
    for state in gearbox.config.states:
        for change in state.changes:
            if change.path == f"{at}.{STIFFNESS}":
                path, received = (
                    f"states.{state.name}.changes.{change.path}",
                    f"a key that {at}.geometry stands in place of",
                )
                yield Problem(path, received, f"allowed: changes of {at}.geometry.clearance_um, or {at}.geometry: null")


# Edges of damage that are rounder than the contact across the face holds for.
#
# Derived: the law of a rounded edge (`siggen.mesh.contact_edges`) lets the sink fall with a growing distance
# inside the gap only while r/(R + r) is at most 1/8, so r at most R/7. R is taken at the pitch point. Beyond, contacts
# of some gearboxes are not solved.

LARGEST_SHARE = 1.0 / 7.0
"""Radius of an edge over the relative radius of curvature at the pitch point."""


def edge_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield edge radii that are too large at the bounds of all numbers, for the gears that are possible."""
    if gearbox.config.dynamics.mesh.law != "pairs":
        return
    for mesh in gearbox.meshes:
        most_mm = 1e3 * LARGEST_SHARE * min(map(_pitch_radius_m, mesh.pairs), default=inf)
        given = {path: damage.own_edge_radius for path, damage in mesh.damages}
        radii = {f"{path}.{own[0]}": own[1] for path, own in given.items() if own is not None}
        if len(radii) < len(given):
            radii["dynamics.mesh.pit_edge_radius_mm"] = gearbox.config.dynamics.mesh.pit_edge_radius_mm
        for path, radius in radii.items():
            if bounds(radius)[1] > most_mm:
                allowed = f"allowed: at most {most_mm:.3g}, a seventh of the flanks' relative radius at the pitch point"
                yield Problem(path, str(radius), allowed)


def _pitch_radius_m(pair: GearPair) -> float:
    position, line = pair.pitch_point_m, pair.line_of_action_m
    return position * (line - position) / line


# What is impossible in a section `dynamics.shafts`: models without them, bearings inside the gear, thick shafts.


def shaft_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield the problems of shafts at the bounds of all numbers, for the gears that are possible."""
    dynamics = gearbox.config.dynamics
    if dynamics.shafts is None:
        return
    if dynamics.model != "casing":
        allowed = f"allowed: null with dynamics.model: {dynamics.model}, or dynamics.model: casing"
        yield Problem("dynamics.shafts", "a mapping", allowed)
    elif dynamics.mesh.law != "pairs":
        received = f"a mapping, with dynamics.mesh.law: {dynamics.mesh.law}"
        allowed = "allowed: null, or dynamics.mesh.law: pairs, whose contact feels a tilt"
        yield Problem("dynamics.shafts", received, allowed)
    else:
        for pair in gearbox.meshes[0].pairs:
            for side in Side:
                yield from _of_shaft(gearbox, side, pair)


def _of_shaft(gearbox: PossibleGearbox, side: Side, pair: GearPair) -> Iterator[Problem]:
    shafts = [*corners(gearbox.shaft(side, pair))]
    least_mm, shares = 1e3 * min(one.span_m for one in shafts), [one.gear_share for one in shafts]
    nearer_mm = least_mm * min(*shares, *(1.0 - share for share in shares))
    half_mm = 0.5e3 * pair.face_width_m
    if nearer_mm < half_mm:
        places = f"gear_position {min(shares):g} to {max(shares):g} a bearing {nearer_mm:g} mm from the middle"
        allowed = f"allowed: bearings beside the gear, at least {half_mm:g} mm from its middle (face_width_mm)"
        yield Problem(f"dynamics.shafts.{SHAFT_OF[side]}.bearing_span_mm", f"{least_mm:g}, with {places}", allowed)
    thickest_mm, root_mm = 1e3 * max(one.diameter_m for one in shafts), 2e3 * pair.member(side).root_radius_m
    if thickest_mm >= root_mm:
        allowed = f"allowed: less than the root diameter of its gear, {root_mm:.4g} mm"
        yield Problem(f"dynamics.shafts.{SHAFT_OF[side]}.diameter_mm", f"{thickest_mm:g}", allowed)


# What does not fit into a gearbox with further meshes: gears on a short shaft, and shafts that stand in one another.
#
# Gears of one shaft stand at a third and two thirds between its bearings, so all three gaps hold what stands in them
# from 1.5 times both faces on. Shafts without a common mesh have no common plane of gears either, so one may end
# before the other begins. They stand beside each other, or in one line: coaxial (reverted) gearboxes, whose centre
# distances are equal and which fold by 180 degrees. Two axes a little apart are refused: neither do the shafts pass
# each other, nor does one bore of the wall between them hold the bearings of both. Gears round an idler lie in one
# plane, so the tips of those that do not mesh pass each other. All of it is derived.

ON_ONE_AXIS_MM = 0.02
"""Axes as near as this are one: boxes are bored no closer (half of IT7 of 50 to 80 mm, ISO 286-1)."""
BETWEEN = 5
"""Values of a range at which axes are looked at, its bounds included."""


def stage_layout_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield what does not fit, at the bounds of all numbers; nothing where pairs are refused for themselves."""
    stages, meshes = gearbox.config.stages, [mesh.pairs for mesh in gearbox.meshes]
    if not stages or gearbox.config.planetary is not None or any(mesh.problems for mesh in gearbox.meshes):
        return
    for index, (stage, pairs) in enumerate(zip(stages, pairwise(meshes), strict=True)):
        yield from _span(stage.span_mm, index, sum(max(pair.face_width_m for pair in own) for own in pairs))
    yield from _axes(gearbox, meshes)


def _span(span_mm: Number | str | None, index: int, faces_m: float) -> Iterator[Problem]:
    least_mm = 1e3 * LEAST_SPAN * faces_m
    if not isinstance(span_mm, str | None) and bounds(span_mm)[0] < least_mm:
        received = f"{bounds(span_mm)[0]:g} mm for faces of {1e3 * faces_m:g} mm together"
        allowed = (
            f"allowed: at least {least_mm:g} mm, {LEAST_SPAN:g} times both face_width_mm, since the gears "
            "stand at a third and at two thirds between the bearings; or null"
        )
        yield Problem(f"stages.{index}.span_mm", received, allowed)


def _axes(gearbox: PossibleGearbox, meshes: Sequence[Sequence[GearPair]]) -> Iterator[Problem]:
    """Yield the first shaft that stands in one in front of it, by the stage whose direction sets it."""
    stages, names = gearbox.config.stages, gearbox.config.names.shafts
    turned = [np.zeros(1), *(np.radians(_values(*bounds(stage.direction_deg))) for stage in stages)]
    distances = [_values(*_ends(pair.working_centre_distance_m for pair in pairs)) for pairs in meshes]
    tips = [[max(pair.member(role).tip_radius_m for pair in pairs) for role in Side] for pairs in meshes]
    driving, driven = ([max(pair.member(role).bore_radius_m for pair in pairs) for pairs in meshes] for role in Side)
    shafts = [driving[0], *map(min, driven, driving[1:]), driven[-1]]
    for first, last in combinations(range(len(shafts)), 2):
        if last < first + 2:
            continue
        apart_mm = 1e3 * _apart_m(distances[first:last], turned[first:last])
        in_plane = all(stage.idler for stage in stages[first : last - 1])
        together_mm = 1e3 * (tips[first][0] + tips[last - 1][1] if in_plane else shafts[first] + shafts[last])
        if (apart_mm.max() <= ON_ONE_AXIS_MM and not in_plane) or apart_mm.min() >= together_mm:
            continue
        received = (
            f"{stages[last - 2].direction_deg}, with which the axis of {names[last].word}_shaft stands "
            f"{apart_mm.min():.4g} mm from that of {names[first].word}_shaft"
        )
        allowed = f"allowed: a direction with at least {together_mm:.4g} mm, " + (
            "the tip radii of both gears, which lie in one plane with the idler"
            if in_plane
            else "the radii of both shafts (bore_radius_mm), or 0: 180 degrees and equal centre distances (coaxial)"
        )
        yield Problem(f"stages.{last - 2}.direction_deg", received, allowed)
        return


def _apart_m(distances: Sequence[FloatArray], turned: Sequence[FloatArray]) -> FloatArray:
    """Return how far two axes may be apart [m]: sums of centre distances along their directions."""
    place = np.zeros(1, dtype=np.complex128)
    for distance, direction in zip(distances, turned, strict=True):
        step = distance[:, None] * np.exp(1j * direction[None, :])
        place = (place[:, None] + step.reshape(1, -1)).ravel()
    return np.abs(place)


def _ends(values: Iterable[float]) -> tuple[float, float]:
    found = sorted(values)
    return found[0], found[-1]


def _values(low: float, high: float) -> FloatArray:
    return np.unique(np.linspace(low, high, BETWEEN))


# What is physically impossible in a section `variation`: motors that stall by slip, run-downs driven by the load.


def variation_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield the problems of a section at the bounds of all numbers, for the gears that are possible."""
    if gearbox.config.variation.active and gearbox.config.operating_points:
        yield from _stalling(gearbox)
        yield from _driven_by_load(gearbox)


def _stalling(gearbox: PossibleGearbox) -> Iterator[Problem]:
    slip, rated_nm = bounds(gearbox.config.variation.speed.slip)[1], gearbox.rated_nm
    torque_nm = max(bounds(point.torque_nm)[1] for point in gearbox.config.operating_points)
    if slip * torque_nm / rated_nm >= 0.5:
        received = f"{slip:g} at {rated_nm:g} N m, which is {slip * torque_nm / rated_nm:.0%} at {torque_nm:g} N m"
        allowed = "allowed: a slip below 50 % at the highest torque; lower slip or the torque, or raise "
        yield Problem("variation.speed.slip", received, f"{allowed}dynamics.rated_torque_nm")


def _driven_by_load(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield run-ups and run-downs that load the other flanks in the mean than the torque of an operating point does.

    Ranges around 0 and 0 itself load both.
    """
    speed, duration_s = gearbox.config.variation.speed, gearbox.config.duration_s
    fall = bounds(speed.end_ratio)[0] - bounds(speed.start_ratio)[1]
    rise = bounds(speed.end_ratio)[1] - bounds(speed.start_ratio)[0]
    inertias = [gearbox.driven_inertia_kg_m2(pair) for pair in gearbox.meshes[0].pairs]
    for point in gearbox.config.operating_points:
        low, high = bounds(point.torque_nm)
        if low <= 0.0 <= high:
            continue
        sign, torque_nm, change = (1.0, low, min(fall, 0.0)) if low > 0.0 else (-1.0, high, max(rise, 0.0))
        speeding = 2.0 * pi * bounds(point.speed_hz)[1] * change / duration_s
        at_mesh = [sign * (torque_nm + inertia * speeding) for inertia in inertias]
        if min(at_mesh, default=1.0) <= 0.0:
            received = f"{change:+g} of {bounds(point.speed_hz)[1]:g} Hz in {duration_s:g} s, with which "
            received += "the load drives" if sign > 0.0 else "the motor drives"
            received += f" ({sign * min(at_mesh):.4g} N m at the mesh)"
            advice = "above 0 at the mesh; raise end_ratio, duration_s or the torque"
            if sign < 0.0:
                advice = "below 0 at the mesh, as its torque is; lower end_ratio or the torque, or raise duration_s"
            yield Problem("variation.speed.end_ratio", received, f"allowed: a mean torque {advice}")
            return


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
            received = f"'{options.beam}', {stiff}"
            low, high = sorted((pair.pinion.teeth, pair.gear.teeth))
            if high > USUAL_RATIO * low:
                name = GEAR if pair.gear.teeth == high else PINION
                received = f"{high} against {low}, a ratio of {high / low:.3g}; stiffness.beam is then {received}"
                allowed = f"allowed: a ratio up to {USUAL_RATIO:g}, as pairs have; or beam: rack_trochoid"
                yield Problem(f"{mesh.at}gears.{name}.teeth", received, allowed)
                continue
            yield Problem("stiffness.beam", received, "allowed: larger bores, or another beam, such as rack_trochoid")


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


# What is impossible about the keys that states change: told per state, with the key of the change.


def state_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield what is wrong with what states change, at the bounds of all numbers; of sections that are valid."""
    changing = [number for number, state in enumerate(gearbox.config.states) if state.changes]
    known = {problem.path for problem in _every(gearbox)} if changing else set()
    for number in changing:
        yield from _changed_problems(gearbox, number, known)


def _changed_problems(gearbox: PossibleGearbox, number: int, known: Collection[str]) -> Iterator[Problem]:
    config, at = gearbox.config, f"states.{gearbox.config.states[number].name}.changes"
    changes = [one for _, one in config.changes_of(number)]
    texts = " and ".join(one.text for one in changes)
    try:
        changed = gearbox.changed(number)
    except PydanticCustomError as error:
        yield from refused_problems(error, at)
        return
    if config.manufacture is not None and config.manufacture.draw == "state":
        allowed = "allowed: none with manufacture.draw: state, whose gears are others in every state; or draw: specimen"
        yield Problem(at, texts, allowed)
    paths = [one.path for one in changes]
    for problem in _every(changed):
        if problem.path in known:
            continue
        if problem.path in paths:
            yield Problem(f"{at}.{problem.path}", problem.received, problem.allowed)
        else:
            path = f"{at}.{paths[0]}" if len(changes) == 1 else at
            yield Problem(path, f"{problem.path}: {problem.received}", problem.allowed)
    before, after = _columns(gearbox), _columns(changed)
    if others := [name for name, present in after.items() if present != before[name]]:
        received = f"{texts}, which adds or takes columns: those of {', '.join(others)}"
        allowed = "allowed: what leaves the columns of the set as they are; give the healthy gearbox some of it"
        yield Problem(at, received, allowed)


def _every(gearbox: PossibleGearbox) -> list[Problem]:
    """Return all problems, each at the key that the user wrote."""
    names = gearbox.config.names
    return [names.problem(problem) for problem in (*gearbox.contradictions(), *physical_problems(gearbox))]


def _columns(gearbox: PossibleGearbox) -> dict[str, bool]:
    """Return what numbers alone give columns of its own, and whether there is any of it."""
    manufacture = gearbox.config.manufacture
    crowned = manufacture is not None and manufacture.has_crowning
    return {"variation": gearbox.config.variation.active, "manufacture.crowning_um": crowned}
