"""Further meshes of a gearbox: each is looked at as if a user had written a file for its pair alone.

So nothing that makes teeth, their errors or their damage knows of gearboxes with several meshes. Random numbers of a
stage follow from the seed and its name.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from siggen.config import Config, Gears, OperatingRange, Pair, PlainRotor, Rotor, Stage, StateSection
from siggen.config.machine import Machine
from siggen.config.planetary import RING, in_pair
from siggen.config.short_form import mesh_alone
from siggen.config.stages import turned
from siggen.faults.fault import Fault
from siggen.faults.flank_place import mesh_of_gear
from siggen.keys.distributions import Uniform
from siggen.keys.number import Number, bounds
from siggen.planning.specimen import OperatingPoint, Specimen

DOT = "."
"""Between the name of a stage and that of its gear, where damage names both."""


def first_mesh(config: Config) -> Config:
    """Return the configuration of the pair of `gears` alone; itself where there is no other mesh."""
    if not config.stages and config.planetary is None:
        return config
    own = {"stages": (), "planetary": None, "states": _states_on(config, ""), "machine": _machine(config, 0)}
    return config.model_copy(update=own)


def stage_config(config: Config, specimen: Specimen, index: int) -> Config:
    """Return the configuration of the pair of a further stage of a drawn gearbox alone.

    Its operating points are those of its pinion, as ranges; speed and torque of a record come from the first pinion.
    """
    own, turning = stage_specimen(specimen, index), float(specimen.shaft_turns[index + 1])
    name = specimen.stages[index].name
    points = _points(config.operating_points, turning)
    return config.model_copy(
        update={
            "seed": _seed(config.seed, name), "gears": own.gears, "dynamics": own.dynamics, "stages": (),
            "stiffness": own.stiffness, "operating_points": points, "states": _states_on(config, name),
            "machine": _machine(config, index + 1),
        }
    )  # fmt: skip


def ring_config(config: Config) -> Config:
    """Return the configuration of a planetary set's planets in their ring, as if that were its pair."""
    alone = {"seed": _seed(config.seed, RING), "planetary": None, "states": _states_on(config, RING)}
    return config.model_copy(update=alone)


def planet_config(config: Config, number: int) -> Config:
    """Return the configuration of one pair, of the planet of a number in a set; the first one has that of the pair."""
    return config if number == 0 else config.model_copy(update={"seed": _seed(config.seed, f"planet_{number}")})


def first_sections(sections: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return valid sections of a configuration as those of its first mesh alone."""
    # also without stages: damage may name one that is wrong itself, or not there
    return {**_sections_on(sections, ""), **_machine_alone(sections, 0)}


def _machine_alone(sections: Mapping[str, Any], number: int) -> dict[str, Machine]:
    """Return the section `machine` of one mesh alone, where there is one."""
    machine: Machine | None = sections.get("machine")
    return {} if machine is None else {"machine": mesh_alone(machine, number)}


def stage_sections(sections: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield path and sections of each further mesh alone, as `stage_config`, at the bounds of all numbers."""
    if "gears" not in sections:
        return
    stages: tuple[Stage, ...] = sections.get("stages", ())
    for index, (stage, turning) in enumerate(zip(stages, turned(sections["gears"], stages), strict=False)):
        own = {**_sections_on(sections, stage.name), **_machine_alone(sections, index + 1), "gears": _gears(stage)}
        if "dynamics" in sections:
            own["dynamics"] = sections["dynamics"].model_copy(update=_rotors(stage))
        if "operating_points" in sections:
            own["operating_points"] = _points(sections["operating_points"], float(turning))
        yield f"stages.{index}", own


def _gears(stage: Stage) -> Gears:
    return Gears.model_construct(**{name: getattr(stage.gears, name) for name in Pair.model_fields})


def _rotors(stage: Stage) -> dict[str, Rotor]:
    """Return the rotors of a stage as those of a pair alone; its pinion is a disc."""
    own = {name: getattr(stage.gear, name) for name in PlainRotor.model_fields}
    return {"pinion": Rotor(), "gear": Rotor.model_construct(**own)}


def ring_sections(sections: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return valid sections of a planetary set as those of its planets in their ring alone."""
    return _sections_on(sections, RING)


def _sections_on(sections: Mapping[str, Any], name: str) -> dict[str, Any]:
    states: Mapping[str, StateSection] = sections.get("states", {})
    own = {index: state.model_copy(update={"damage": _own(state, name)}) for index, state in states.items()}
    return {**sections, "states": own, "stages": ()}


def stage_specimen(specimen: Specimen, index: int) -> Specimen:
    """Return a drawn gearbox with the pair of a further stage in place of the first one."""
    stage = specimen.stages[index]
    dynamics = specimen.dynamics.model_copy(update=_rotors(stage))
    alone = replace(specimen, meshes=(specimen.meshes[index + 1],), names=specimen.names.alone(index + 1), train=None)
    return replace(alone, gears=_gears(stage), dynamics=dynamics, stages=())


def stage_point(point: OperatingPoint, turning: float) -> OperatingPoint:
    """Return an operating point as a pinion has it that turns `turning` times per turn of the first one."""
    return OperatingPoint(point.speed_hz * turning, point.torque_nm / turning)


def stage_of(damage: Fault) -> str:
    """Return the name of the further stage that a damage is on, or `ring`; empty for the first mesh and no gear."""
    return mesh_of_gear(damage.hit_gear)


def _machine(config: Config, number: int) -> Machine | None:
    return None if config.machine is None else mesh_alone(config.machine, number)


def _states_on(config: Config, name: str) -> tuple[StateSection, ...]:
    """Return the states with their damage on the gears of one mesh alone, which are called pinion and gear there."""
    return tuple(_on(config, state_id, name) for state_id in range(len(config.states)))


def _on(config: Config, state_id: int, name: str) -> StateSection:
    """Return a state with the damage of one mesh; what it grows from stays, though it may add nothing here."""
    state, older = config.states[state_id], config.grown_from(state_id)
    milder = None if older is None else config.states[older].name
    return state.model_copy(update={"damage": _own(state, name), "grows": milder})


def _own(state: StateSection, name: str) -> tuple[Fault, ...] | Fault | None:
    """Return the damage of a state on one mesh as a section or a list, as the state has it."""
    own = tuple(_alone(one) for one in state.damages if stage_of(one) == name)
    return (own if isinstance(state.damage, tuple) else own[0]) if own else None


def _alone(damage: Fault) -> Fault:
    return damage.with_gears(lambda gear: in_pair(gear.rpartition(DOT)[2]))


def _seed(seed: int, name: str) -> int:
    return int.from_bytes(hashlib.sha256(f"{seed} stages.{name}".encode()).digest()[:8]) >> 1


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
