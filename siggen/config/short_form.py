"""A machine as the pairs that all code reads, and back: its names are those of pinions and gears.

The first mesh is `gears`, with a pinion and a gear; further meshes are `stages`. The shaft of the pinion is
`dynamics.pinion`, that of the gear `dynamics.gear`, those behind are `stages[].gear`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import cache
from typing import Any

from siggen.config.dynamics import RotorSection
from siggen.config.gears import GearsSection, Pair, ToothForm, Wheel
from siggen.config.inheritance import REPLACED
from siggen.config.machine import MachineMesh, MachineSection
from siggen.config.machine_problems import idlers, train
from siggen.config.stages import Stage
from siggen.errors import Problem
from siggen.keys.problems import received_text
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

OF_SHAFTS = ("driver", "driven")
"""Keys of `dynamics.shafts` beside a machine."""


@cache
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
    found, gears = train(machine), {gear.name: index for index, gear in enumerate(machine.gears)}
    for number, place in enumerate(found.meshes):
        mesh, path = machine.meshes[place], f"stages.{number - 1}." if number else ""
        for role, gear in zip(SECTIONS, (mesh.driver, mesh.driven), strict=True):
            yield f"{path}gears.{role}", f"machine.gears.{gears[gear]}"
        yield f"{path}gears", f"machine.meshes.{place}"
        if number:
            here = f"stages.{number - 1}"
            yield from ((f"{here}.{key}", f"machine.meshes.{place}.{key}") for key in ("name", "direction_deg"))
            yield f"{here}.span_mm", f"machine.shafts.{found.shafts[number]}.span_mm"
            yield f"{here}.gear", f"machine.shafts.{found.shafts[number + 1]}"
            yield here, f"machine.meshes.{place}"
    for role, key, place in zip(SECTIONS, OF_SHAFTS, found.shafts, strict=False):
        yield f"dynamics.{role}", f"machine.shafts.{place}"
        yield f"dynamics.shafts.{role}", f"dynamics.shafts.{key}"


def short_form(raw: Mapping[str, Any], names: Names) -> tuple[dict[str, Any], list[Problem]]:
    """Return what a file says beside its machine in words of pairs, and words of the file that are none of its own."""
    short = {key: value for key, value in raw.items() if key not in (*REPLACED, "machine")}
    short |= {"dynamics": _with_shafts(raw["dynamics"], OF_SHAFTS, SECTIONS)} if "dynamics" in raw else {}
    return _with_changes(short, names), [*_beside(raw), *_keys(raw)]


def own_form(plain: Mapping[str, Any], names: Names) -> dict[str, Any]:
    """Return a configuration as plain mappings and lists as the user writes it; `short_form` of it is the same."""
    own = {key: value for key, value in plain.items() if key not in REPLACED}
    dynamics = {key: value for key, value in own["dynamics"].items() if key not in SECTIONS}
    own = {**own, "dynamics": _with_shafts(dynamics, SECTIONS, OF_SHAFTS)}
    states = {
        name: {**one, "changes": {names.own_path(path): to for path, to in one["changes"].items()}}
        for name, one in own["states"].items()
    }
    return {**own, "states": states}


def _beside(raw: Mapping[str, Any]) -> Iterator[Problem]:
    for key in REPLACED:
        if raw.get(key):
            yield Problem(key, "a section beside machine", "allowed: either this section or machine")


def _keys(raw: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield keys of a pair alone."""
    if isinstance(dynamics := raw.get("dynamics"), Mapping):
        for key in {*SECTIONS, *OF_SHAFTS} & dynamics.keys():
            yield Problem(f"dynamics.{key}", received_text(dynamics[key]), "allowed with a machine: machine.shafts")
        shafts = dynamics.get("shafts")
        for key, now in zip(SECTIONS, OF_SHAFTS, strict=True):
            if isinstance(shafts, Mapping) and key in shafts:
                yield Problem(f"dynamics.shafts.{key}", received_text(shafts[key]), f"allowed with a machine: {now}")


def _with_shafts(dynamics: Any, keys: tuple[str, str], to: tuple[str, str]) -> Any:
    """Return the section with the keys of its shafts replaced."""
    shafts = dynamics.get("shafts") if isinstance(dynamics, Mapping) else None
    table = dict(zip(keys, to, strict=True))
    own = {table.get(key, key): one for key, one in shafts.items()} if isinstance(shafts, Mapping) else shafts
    return dynamics if own is None else {**dynamics, "shafts": own}


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


def _values(section: Section, model: type[Section]) -> dict[str, Any]:
    """Return what a section has of a model's keys."""
    return {key: getattr(section, key) for key in model.model_fields}


def _with_changes(short: dict[str, Any], names: Names) -> dict[str, Any]:
    """Return a raw configuration whose states change keys of the short form."""
    states = short.get("states")
    if not isinstance(states, Mapping):
        return short
    return {**short, "states": {name: _with_short_paths(state, names) for name, state in states.items()}}


def _with_short_paths(state: Any, names: Names) -> Any:
    changes = state.get("changes") if isinstance(state, Mapping) else None
    if not isinstance(changes, Mapping):
        return state
    return {**state, "changes": {names.inner_path(str(path)): to for path, to in changes.items()}}
