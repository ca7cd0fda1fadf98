"""A machine as the pairs that all code reads, and back: its names are those of pinions and gears.

The first mesh is `gears`, with a pinion and a gear; further meshes are `stages`. The shaft of the pinion is
`dynamics.pinion`, that of the gear `dynamics.gear`, those behind are `stages[].gear`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import lru_cache
from typing import Any

from siggen.config.dynamics import RotorSection
from siggen.config.gears import GearsSection, Pair, ToothForm, Wheel
from siggen.config.inheritance import REPLACED
from siggen.config.machine import MachineMesh, MachineSection
from siggen.config.machine_problems import idlers, train
from siggen.config.stages import Stage
from siggen.errors import Problem
from siggen.keys.problems import joined, received_text
from siggen.keys.section import Section
from siggen.names import (
    GEAR,
    PAIR,
    PINION,
    PLANETARY,
    SECTIONS,
    GearName,
    MeshName,
    Names,
    ShaftName,
)


@lru_cache(maxsize=128)  # a state that changes shafts has a machine of its own in every gearbox
def names_of(machine: MachineSection) -> Names:
    """Return the names of a machine without problems."""
    found, shared = train(machine), idlers(machine)
    inner = ("", *(machine.meshes[place].name for place in found.meshes[1:]))
    meshes = tuple(
        _mesh_name(name, machine.meshes[place], shared) for name, place in zip(inner, found.meshes, strict=True)
    )
    of_shafts = zip((PINION, *(name or GEAR for name in inner)), found.shafts, strict=True)
    shafts = [(name, machine.shafts[place].name) for name, place in of_shafts]
    named = tuple(ShaftName(name, own, f"the shaft {own}") for name, own in shafts)
    return Names(meshes, named, tuple(_paths(machine)), given=True)


def names_in(machine: MachineSection | None, *, planetary: bool) -> Names:
    """Return the names of a gearbox by valid sections."""
    if machine is not None:
        return names_of(machine)
    return PLANETARY if planetary else PAIR


def _mesh_name(inner: str, mesh: MachineMesh, shared: Collection[str]) -> MeshName:
    gears = []
    for role, gear in zip(SECTIONS, (mesh.driver, mesh.driven), strict=True):
        word = f"{mesh.name}.{gear}" if gear in shared else gear  # a flank of each mesh
        gears.append(GearName(f"{inner}.{role}" if inner else role, word, gear, word))
    return MeshName(inner, mesh.name, *gears)


def _paths(machine: MachineSection) -> Iterator[tuple[str, str]]:
    """Yield keys of sections and where the machine has them."""
    order = train(machine)
    shafts = [f"machine.shafts.{machine.shafts[place].name}" for place in order.shafts]
    for number, mesh in enumerate(machine.meshes[place] for place in order.meshes):
        stage, at = f"stages.{number - 1}" if number else "", f"machine.meshes.{mesh.name}"
        for role, gear in zip(SECTIONS, (mesh.driver, mesh.driven), strict=True):
            yield joined(stage, "gears", role), f"machine.gears.{gear}"
        yield joined(stage, "gears"), at
        if stage:
            yield f"{stage}.span_mm", f"{shafts[number]}.span_mm"
            yield f"{stage}.gear", shafts[number + 1]
            yield stage, at
    yield from ((f"dynamics.{role}", shaft) for role, shaft in zip(SECTIONS, shafts, strict=False))


def problems_beside(raw: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield what a file says beside its machine that is said by that."""
    for key in REPLACED:
        if raw.get(key):
            yield Problem(key, "a section beside machine", "allowed: either this section or machine")
    given = raw.get("dynamics")
    dynamics: Mapping[str, Any] = given if isinstance(given, Mapping) else {}
    for key in {*SECTIONS} & dynamics.keys():
        yield Problem(f"dynamics.{key}", received_text(dynamics[key]), "allowed with a machine: machine.shafts")


def without_inner(plain: Mapping[str, Any]) -> dict[str, Any]:
    """Return a configuration with a machine as plain mappings and lists, without what the machine says."""
    dynamics = {key: value for key, value in plain["dynamics"].items() if key not in SECTIONS}
    return {**{key: value for key, value in plain.items() if key not in REPLACED}, "dynamics": dynamics}


def drivetrain(machine: MachineSection) -> tuple[GearsSection, tuple[Stage, ...], dict[str, RotorSection]]:
    """Return its first pair, its further meshes, and both shafts of the first mesh by the keys of `dynamics`."""
    found, shafts = train(machine), machine.shafts
    wheels = {gear.name: Wheel(**_values(gear, Wheel)) for gear in machine.gears}
    pairs = [
        Pair(**_values(mesh, ToothForm), pinion=wheels[mesh.driver], gear=wheels[mesh.driven])
        for mesh in (machine.meshes[place] for place in found.meshes)
    ]
    stages = []
    for number, pair in enumerate(pairs[1:], start=1):
        mesh, front, own = machine.meshes[found.meshes[number]], *found.shafts[number : number + 2]
        stages.append(
            Stage(
                name=mesh.name,
                gears=pair,
                gear=RotorSection(**_values(shafts[own], RotorSection)),
                span_mm="idler" if mesh.driver in idlers(machine) else shafts[front].span_mm,
                direction_deg=mesh.direction_deg,
            )
        )
    rotors = (RotorSection(**_values(shafts[place], RotorSection)) for place in found.shafts)
    return GearsSection(**_values(pairs[0], Pair)), tuple(stages), dict(zip(SECTIONS, rotors, strict=False))


@lru_cache(maxsize=128)
def stages_of(machine: MachineSection | None) -> tuple[Stage, ...]:
    """Return the further meshes of a machine, in the order of power; none without one."""
    return () if machine is None else drivetrain(machine)[1]


def _values(section: Section, model: type[Section]) -> dict[str, Any]:
    """Return what a section has of a model's keys."""
    return {key: getattr(section, key) for key in model.model_fields}
