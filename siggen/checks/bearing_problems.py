"""What is impossible about the bearings of shafts: balls that do not fit, spalls that do not fit their element."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from siggen.config import Dynamics
from siggen.dynamics.bearings.ball_bearing import BallBearing
from siggen.errors import Problem
from siggen.faults.ball_geometry import BallGeometry
from siggen.faults.bearing_spall import BearingSpalls
from siggen.keys.drawing import corners

STIFFNESSES = ("bearing_stiffness_x_n_per_m", "bearing_stiffness_y_n_per_m")
"""Keys of a shaft's section that its `bearing` replaces."""


def bearing_problems(sections: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the problems of both shafts at the bounds of all numbers."""
    dynamics: Dynamics | None = sections.get("dynamics")
    for which in ("pinion", "gear") if dynamics is not None else ():
        section = getattr(dynamics, which).bearing or BallGeometry()
        bearings = [one.bearing() for one in corners(section)]
        crowded = [one for one in bearings if one.ball_diameter_m >= one.room_m]
        if crowded:
            received = f"{crowded[0].balls} balls of {1e3 * crowded[0].ball_diameter_m:g} mm"
            allowed = f"allowed: below {1e3 * crowded[0].room_m:.4g} mm, the distance of two balls' centres"
            yield Problem(f"dynamics.{which}.bearing.ball_diameter_mm", received, allowed)
        else:
            yield from _spall_problems(sections, f"{which}_bearing", bearings)
        if getattr(dynamics, which).bearing is not None:
            yield from _change_problems(sections, f"dynamics.{which}")


def _spall_problems(sections: Mapping[str, Any], place: str, bearings: list[BallBearing]) -> Iterator[Problem]:
    """Yield spalls that do not fit one of what a bearing may be."""
    for index, state in sections.get("states", {}).items():
        for path, damage in state.placed(f"states.{index}"):
            if isinstance(damage, BearingSpalls) and damage.bearing == place:
                for bearing in bearings:
                    yield from (replace(one, path=f"{path}.{one.path}") for one in damage.problems_in(bearing))


def _change_problems(sections: Mapping[str, Any], at: str) -> Iterator[Problem]:
    """Yield changes of states to a stiffness that a bearing replaces: such a state would be healthy by another name."""
    unused = [f"{at}.{key}" for key in STIFFNESSES]
    for index, state in sections.get("states", {}).items():
        for change in state.changes:
            if change.path in unused:
                allowed = f"allowed: changes of {at}.bearing.clearance_um, or {at}.bearing: null"
                yield Problem(
                    f"states.{index}.changes.{change.path}", f"a key that {at}.bearing stands in place of", allowed
                )
