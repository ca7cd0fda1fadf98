"""What a machine cannot be as a graph: names, gears, meshes and shafts that do not fit together; and its order."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from siggen.config.machine import IDLER, MachineMesh, MachineSection
from siggen.errors import Problem
from siggen.keys.problems import nearest

TAKEN = ("motor", "load", "casing", "base", "either", "several", "none", "mesh")
"""Words with a meaning of their own in places of sensors and in labels."""


@dataclass(frozen=True, slots=True)
class Train:
    """Meshes and shafts in the order of power, as places in their lists; there is one shaft more."""

    meshes: tuple[int, ...]
    shafts: tuple[int, ...]


def machine_problems(machine: MachineSection) -> list[Problem]:
    """Return what is wrong about a machine, the first kind of it: what refers to nothing goes before loops."""
    for check in (_names, _references, _pairs, _gears, _connected, _loops, _branches, _spans):
        if found := list(check(machine)):
            return found
    return []


def train(machine: MachineSection) -> Train:
    """Return the order of power of a machine without problems."""
    shaft_of = _shaft_of(machine)
    ends = [(shaft_of[mesh.driver], shaft_of[mesh.driven]) for mesh in machine.meshes]
    order = {driving: (index, driven) for index, (driving, driven) in enumerate(ends)}
    (shaft,) = {driving for driving, _ in ends} - {driven for _, driven in ends}
    meshes, shafts = [], [shaft]
    while shaft in order:
        index, shaft = order[shaft]
        meshes.append(index)
        shafts.append(shaft)
    return Train(tuple(meshes), tuple(shafts))


def idlers(machine: MachineSection) -> frozenset[str]:
    """Return the names of the gears that one gear drives and that drive another one."""
    return frozenset({mesh.driver for mesh in machine.meshes} & {mesh.driven for mesh in machine.meshes})


def _names(machine: MachineSection) -> Iterator[Problem]:
    for key in MachineSection.model_fields:
        names = [part.name for part in getattr(machine, key)]
        for index, name in enumerate(names):
            alike = [other for other in names[:index] if other.lower() == name.lower()]
            if alike:
                allowed = "allowed: every name once, whatever its case: readers of columns may not tell"
                yield Problem(f"machine.{key}.{name}", f"'{name}' beside '{alike[0]}'", allowed)
            if name.lower() in TAKEN:
                allowed = f"allowed: another name than {', '.join(TAKEN)}"
                yield Problem(f"machine.{key}.{name}", "a name that means something else", allowed)
    meshes = [one.name.lower() for one in machine.meshes]
    for gear in machine.gears:
        if gear.name.lower() in meshes:
            yield Problem(f"machine.gears.{gear.name}", f"'{gear.name}', as a mesh is called", "allowed: another name")
    flanks = {f"{mesh.name}_{name}".lower() for mesh in machine.meshes for name in idlers(machine)}
    for gear in machine.gears:
        if gear.name.lower() in flanks:
            received = f"'{gear.name}', as columns name a flank of an idler by its mesh"
            yield Problem(f"machine.gears.{gear.name}", received, "allowed: a name whose columns are its own")
    columns = {f"mesh_{one.name}_hz".lower() for one in machine.meshes}
    for shaft in machine.shafts:
        if f"{shaft.name}_shaft_hz".lower() in columns:
            received = f"'{shaft.name}', whose column {shaft.name}_shaft_hz a mesh has too"
            yield Problem(f"machine.shafts.{shaft.name}", received, "allowed: a name whose columns are its own")


def _references(machine: MachineSection) -> Iterator[Problem]:
    shafts, gears = [one.name for one in machine.shafts], [one.name for one in machine.gears]
    for gear in machine.gears:
        yield from _unknown(f"machine.gears.{gear.name}.shaft", gear.shaft, shafts)
    for mesh in machine.meshes:
        yield from _unknown(f"machine.meshes.{mesh.name}.driver", mesh.driver, gears)
        yield from _unknown(f"machine.meshes.{mesh.name}.driven", mesh.driven, gears)


def _unknown(path: str, name: str, known: Sequence[str]) -> Iterator[Problem]:
    if name not in known:
        yield Problem(path, f"'{name}'", f"allowed: one of {', '.join(known)}{nearest(name, known)}")


def _pairs(machine: MachineSection) -> Iterator[Problem]:
    """Yield meshes whose gears turn together."""
    names, shaft_of = [one.name for one in machine.shafts], _shaft_of(machine)
    for mesh in machine.meshes:
        if (shaft := shaft_of[mesh.driver]) == shaft_of[mesh.driven]:
            received = f"'{mesh.driven}', which stands on the shaft {names[shaft]} as {mesh.driver} does"
            yield Problem(f"machine.meshes.{mesh.name}.driven", received, "allowed: a gear on another shaft")


def _gears(machine: MachineSection) -> Iterator[Problem]:
    """Yield gears that mesh with none or with too many; two that a gear drives, or is driven in, are a branch."""
    meshes: dict[str, list[str]] = {}
    for mesh in machine.meshes:
        for name in (mesh.driver, mesh.driven):
            meshes.setdefault(name, []).append(mesh.name)
    for gear in machine.gears:
        own = meshes.get(gear.name, [])
        received = f"'{gear.name}', in {len(own)} meshes{': ' if own else ''}{', '.join(own)}"
        if len(own) not in {1, 2}:
            out = f"leave the gear out ({gear.name}: null), or let it mesh"
            more = "give each mesh a gear of its own on the shaft" if own else out
            allowed = f"allowed: one mesh, or two of an idler, which is driven in one and drives in the other; {more}"
            yield Problem(f"machine.gears.{gear.name}", received, allowed)


def _connected(machine: MachineSection) -> Iterator[Problem]:
    """Yield shafts that no mesh joins with the first one."""
    reached, first = _reached(machine, 0, machine.meshes), machine.shafts[0].name
    for index, shaft in enumerate(machine.shafts):
        if index not in reached:
            received = f"'{shaft.name}', which no mesh joins with the shaft {first}"
            yield Problem(f"machine.shafts.{shaft.name}", received, "allowed: shafts joined by meshes of their gears")


def _loops(machine: MachineSection) -> Iterator[Problem]:
    """Yield each mesh that closes a loop with those before it, and whether its shafts could turn at all."""
    shaft_of = _shaft_of(machine)
    for index, mesh in enumerate(machine.meshes):
        driving, driven = shaft_of[mesh.driver], shaft_of[mesh.driven]
        before = _reached(machine, driving, machine.meshes[:index])
        if driven in before:
            turns, ratio = before[driven].turns, _ratio(machine, mesh)
            received = f"'{mesh.name}', which closes a loop with {', '.join(before[driven].meshes)}"
            if turns != ratio:
                names = machine.shafts[driven].name, machine.shafts[driving].name
                received += (
                    f" and cannot turn: by its teeth the shaft {names[0]} makes {float(ratio):.4g} turns per turn of "
                    f"{names[1]}, by theirs {float(turns):.4g}"
                )
            allowed = "allowed: one way from the motor to the load; leave one mesh of the loop out, with its gears"
            yield Problem(f"machine.meshes.{mesh.name}", received, allowed)


def _branches(machine: MachineSection) -> Iterator[Problem]:
    """Yield shafts that drive several others, or are driven by several."""
    shaft_of = _shaft_of(machine)
    for key, does in (("driver", "drives"), ("driven", "is driven in")):
        counts = Counter(shaft_of[getattr(mesh, key)] for mesh in machine.meshes)
        for shaft, count in counts.items():
            if count > 1:
                name = machine.shafts[shaft].name
                received = f"'{name}', which {does} {count} meshes"
                yield Problem(f"machine.shafts.{name}", received, "allowed: one way from the motor to the load")


def _spans(machine: MachineSection) -> Iterator[Problem]:
    inner, of_idlers = train(machine).shafts[1:-1], {_shaft_of(machine)[name] for name in idlers(machine)}
    for index, shaft in enumerate(machine.shafts):
        path, received = f"machine.shafts.{shaft.name}.span_mm", str(shaft.span_mm)
        if index in of_idlers and shaft.span_mm not in (None, IDLER):
            yield Problem(path, received, "allowed: idler or null of a shaft with one gear in two meshes")
        elif index not in inner and shaft.span_mm is not None:
            yield Problem(path, received, "allowed: null of a shaft with one gear")
        elif index not in of_idlers and shaft.span_mm == IDLER:
            yield Problem(path, received, "allowed: a number, null, or one gear in two meshes on the shaft")


def _shaft_of(machine: MachineSection) -> dict[str, int]:
    places = {shaft.name: index for index, shaft in enumerate(machine.shafts)}
    return {gear.name: places[gear.shaft] for gear in machine.gears}


def _ratio(machine: MachineSection, mesh: MachineMesh) -> Fraction:
    """Return turns of the driven gear per turn of the driver, which turns the other way."""
    teeth = {gear.name: gear.teeth for gear in machine.gears}
    return -Fraction(teeth[mesh.driver], teeth[mesh.driven])


@dataclass(frozen=True, slots=True)
class _Way:
    """Turns of a shaft per turn of another one, and the names of the meshes from that to it."""

    turns: Fraction
    meshes: tuple[str, ...]


def _reached(machine: MachineSection, first: int, meshes: Sequence[MachineMesh]) -> Mapping[int, _Way]:
    """Return shaft -> the way to it from the first one, for the shafts that meshes join with that."""
    shaft_of, ways, waiting = _shaft_of(machine), {first: _Way(Fraction(1), ())}, [first]
    while waiting:
        shaft = waiting.pop()
        for mesh in meshes:
            ends, ratio = (shaft_of[mesh.driver], shaft_of[mesh.driven]), _ratio(machine, mesh)
            for (here, there), turned in ((ends, ratio), (ends[::-1], 1 / ratio)):
                if here == shaft and there not in ways:
                    ways[there] = _Way(ways[here].turns * turned, (*ways[here].meshes, mesh.name))
                    waiting.append(there)
    return ways
