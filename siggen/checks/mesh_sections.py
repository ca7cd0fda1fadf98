"""Sections of one mesh of a gearbox, as if a user had written a file for its pair alone: what checks of pairs read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from siggen.config import Gears, OperatingRange, Pair, Rotor, Stage, StateSection
from siggen.config.machine import Machine
from siggen.config.planetary import RING
from siggen.config.short_form import mesh_alone
from siggen.config.stages import turned
from siggen.faults.fault import Fault
from siggen.gearbox.mesh_damage import sections_on
from siggen.keys.distributions import Uniform
from siggen.keys.number import Number, bounds


def first_sections(sections: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return valid sections of a configuration as those of its first mesh alone."""
    # also without stages: damage may name one that is wrong itself, or not there
    return {**_sections_on(sections, ""), **_machine_alone(sections, 0)}


def _machine_alone(sections: Mapping[str, Any], number: int) -> dict[str, Machine]:
    """Return the section `machine` of one mesh alone, where there is one."""
    machine: Machine | None = sections.get("machine")
    return {} if machine is None else {"machine": mesh_alone(machine, number)}


def stage_sections(sections: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield path and sections of each further mesh alone, at the bounds of all numbers."""
    if "gears" not in sections:
        return
    stages: tuple[Stage, ...] = sections.get("stages", ())
    for index, (stage, turning) in enumerate(zip(stages, turned(sections["gears"], stages), strict=False)):
        own = {**_sections_on(sections, stage.name), **_machine_alone(sections, index + 1), "gears": _gears(stage)}
        if "dynamics" in sections:
            own["dynamics"] = sections["dynamics"].model_copy(update={"pinion": Rotor(), "gear": stage.gear})
        if "operating_points" in sections:
            own["operating_points"] = _points(sections["operating_points"], float(turning))
        yield f"stages.{index}", own


def _gears(stage: Stage) -> Gears:
    return Gears.model_construct(**{name: getattr(stage.gears, name) for name in Pair.model_fields})


def ring_sections(sections: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return valid sections of a planetary set as those of its planets in their ring alone."""
    return _sections_on(sections, RING)


def _sections_on(sections: Mapping[str, Any], name: str) -> dict[str, Any]:
    states: Mapping[str, StateSection] = sections.get("states", {})
    own = {index: state.model_copy(update={"damage": _own(state, name)}) for index, state in states.items()}
    return {**sections, "states": own, "stages": ()}


def _own(state: StateSection, name: str) -> tuple[Fault, ...] | Fault | None:
    """Return the damage of a state on one mesh as a section or a list, as the state has it."""
    own = sections_on(state, name)
    return (own if isinstance(state.damage, tuple) else own[0]) if own else None


def _points(points: tuple[OperatingRange, ...], turning: float) -> tuple[OperatingRange, ...]:
    """Return operating points of the first pinion as a pinion has them that turns `turning` times as fast."""
    return tuple(
        OperatingRange(speed_hz=_scaled(one.speed_hz, turning), torque_nm=_scaled(one.torque_nm, 1.0 / turning))
        for one in points
    )


def _scaled(number: Number, factor: float) -> Number:
    if isinstance(number, float):
        return number * factor
    low, high = (factor * one for one in bounds(number))
    return Uniform(low=low, high=high)
