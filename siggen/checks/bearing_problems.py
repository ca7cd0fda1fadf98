"""What is impossible about `dynamics.<shaft>.bearing`: balls that do not fit, a spall in a bearing of other numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from siggen.config import Dynamics
from siggen.errors import Problem
from siggen.faults.bearing_spall import BearingSpalls
from siggen.keys.drawing import corners


def bearing_problems(sections: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the problems of both shafts at the bounds of all numbers."""
    dynamics: Dynamics | None = sections.get("dynamics")
    for which in ("pinion", "gear") if dynamics is not None else ():
        section = getattr(dynamics, which).bearing
        for one in () if section is None else corners(section):
            bearing = one.bearing()
            if bearing.ball_diameter_m >= bearing.room_m:
                received = f"{bearing.balls} balls of {1e3 * bearing.ball_diameter_m:g} mm"
                allowed = f"allowed: below {1e3 * bearing.room_m:.4g} mm, the distance of two balls' centres"
                yield Problem(f"dynamics.{which}.bearing.ball_diameter_mm", received, allowed)
                break
        if section is not None:
            yield from _spall_problems(sections, f"{which}_bearing", section)


def _spall_problems(sections: Mapping[str, Any], place: str, section: Any) -> Iterator[Problem]:
    """Yield spalls of a bearing whose numbers are others; a state may change its clearance."""
    for index, state in sections.get("states", {}).items():
        for path, damage in state.placed(f"states.{index}"):
            if isinstance(damage, BearingSpalls) and damage.bearing == place:
                given = damage.geometry.model_copy(update={"clearance_um": section.clearance_um})
                if given != section:
                    shaft = place.partition("_")[0]
                    allowed = f"allowed: the numbers of dynamics.{shaft}.bearing, in which the spall is"
                    yield Problem(f"{path}.geometry", "another bearing", allowed)
