"""What is impossible about the bearings of shafts: balls that do not fit, spalls that do not fit their element."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from siggen.dynamics.bearings.ball_bearing import BallBearing
from siggen.errors import Problem
from siggen.faults.ball_geometry import BallGeometry
from siggen.faults.bearing_spall import BearingSpalls
from siggen.gearbox.possible import PossibleGearbox
from siggen.keys.drawing import corners
from siggen.names import Side

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
