"""Section `machine`: the drivetrain as shafts, gears and meshes, each with a name of the user's own."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Annotated, Any, ClassVar, Literal, TypeAlias

from pydantic import ConfigDict, Field, model_validator

from siggen.config.dynamics import Dynamics, RotorSection
from siggen.config.gears import GearsSection, Pair, ToothForm, Wheel
from siggen.config.inheritance import REPLACED
from siggen.errors import Problem
from siggen.keys.by_name import NamedParts, without_key_field
from siggen.keys.number import Number, Within, bounds
from siggen.keys.problems import MISSING, joined, nearest, received_text, refusal
from siggen.keys.section import Section
from siggen.keys.user_name import PartName
from siggen.keys.usual import Usual
from siggen.names import (
    EITHER,
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

IDLER = "idler"
Span: TypeAlias = Annotated[
    Number | Literal["idler"] | None, Within(above=0, most=2000, words=(IDLER, None)), Usual(5, 3000)
]
Direction: TypeAlias = Annotated[Number, Within(least=-180, most=180)]


class NamedPart(Section):
    """What has a name, for places of sensors, damage, columns, messages and pages."""

    key_field: ClassVar[str] = "name"
    model_config = ConfigDict(json_schema_extra=lambda schema: without_key_field(schema, "name"))

    name: PartName


class MachineShaft(NamedPart, RotorSection):
    """A shaft on two bearings; masses are those of the gear that the shaft in front drives, of the first its own."""

    span_mm: Span = Field(
        default=None,
        description="between bearings of a shaft with two gears; idler: one gear in two meshes; null: twice "
        "both face widths (assumed)",
    )

    @model_validator(mode="after")
    def _bearings_are_given(self) -> MachineShaft:
        if nulls := self.bearing.nulls:
            allowed = "allowed: a number; null follows from a rated torque, which a machine does not read"
            raise refusal([Problem(f"bearing.{key}", "null", allowed) for key in nulls])
        return self


class MachineGear(NamedPart, Wheel):
    """A gear on a shaft."""

    shaft: str = Field(description="name of the shaft that it stands on")


OF_MESH = "name of the gear that drives, or is driven"


class MachineMesh(NamedPart, ToothForm):
    """A gear that drives another one."""

    driver: str = Field(description=OF_MESH)
    driven: str = Field(description=OF_MESH)
    direction_deg: Direction = Field(
        default=0.0,
        description="of the line of centres against that of the first mesh, as the first shaft turns",
    )


class MachineSection(Section):
    """Shafts, gears and meshes in any order; takes the place of `gears`.

    The motor drives the shaft whose gear none drives, the load hangs on the shaft whose gear drives none.
    """

    shafts: Annotated[
        tuple[MachineShaft, ...],
        Field(min_length=2, max_length=100),
        NamedParts("{input: {}, output: {mass_kg: 6}}, 2 to 100"),
    ] = Field(description="its shafts")
    gears: Annotated[
        tuple[MachineGear, ...],
        Field(min_length=2, max_length=200),
        NamedParts("{ida: {teeth: 18, bore_radius_mm: 12, shaft: input}, otto: {...}}, 2 to 200"),
    ] = Field(description="its gears")
    meshes: Annotated[
        tuple[MachineMesh, ...],
        Field(min_length=1, max_length=100),
        NamedParts("{fast: {driver: ida, driven: otto, module_mm: 2, face_width_mm: 20}}, 1 to 100"),
    ] = Field(description="its meshes")


# What a machine cannot be as a graph: names, gears, meshes and shafts that do not fit together; and its order.

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


# Further meshes behind the first one, in the order of power: what the sections of a machine say of each.


class Stage(Section):
    """One further mesh: its pinion stands on the shaft of the gear in front or is that, its gear on a shaft of its own.

    Both gears on one shaft stand at a third and at two thirds between its bearings, which are those of the gear in
    front. The last gear drives the load. `gear` is its gear with that gear's shaft; its pinion is a solid steel disc.
    """

    name: str
    gears: Pair
    gear: RotorSection
    span_mm: Span
    direction_deg: Direction

    @property
    def idler(self) -> bool:
        """Whether its pinion is the gear in front itself."""
        return self.span_mm == IDLER


OF_BOTH_MESHES = ("module_mm", "pressure_angle_deg")
"""Numbers of a gear that the section of its mesh holds; both meshes of an idler have them alike."""


def with_idlers(gears: Pair, stages: Iterable[Stage]) -> Iterator[Stage]:
    """Yield drawn stages; one whose pinion is the gear in front has the numbers that were drawn for that."""
    front = gears
    for stage in stages:
        pair = stage.gears
        if stage.idler:
            alike = {key: getattr(front, key) for key in OF_BOTH_MESHES}
            pair = pair.model_copy(update={**alike, "pinion": front.gear})
        front = pair
        yield stage.model_copy(update={"gears": pair}) if stage.idler else stage


def turned_teeth(gears: Pair, stages: tuple[Stage, ...]) -> tuple[Fraction, ...]:
    """Return the teeth of every further stage that mesh per turn of the first pinion."""
    return tuple(turns * stage.gears.pinion.teeth for turns, stage in zip(turned(gears, stages), stages, strict=False))


def turned(gears: Pair, stages: tuple[Stage, ...]) -> Iterator[Fraction]:
    """Yield the turns of each shaft behind the first one, per turn of that."""
    turns = Fraction(1)
    for pair in (gears, *(stage.gears for stage in stages)):
        turns *= Fraction(pair.pinion.teeth, pair.gear.teeth)
        yield turns


def shaft_orders(ratio: Fraction, stages: tuple[Stage, ...]) -> list[float]:
    """Return the turns of every shaft per turn of the first one, whose gear turns the second one by `ratio`."""
    orders = [Fraction(1), ratio]
    for stage in stages:
        orders.append(orders[-1] * Fraction(stage.gears.pinion.teeth, stage.gears.gear.teeth))
    return [float(order) for order in orders]


# A machine as the pairs that all code reads, and back: its names are those of pinions and gears.
#
# The first mesh is `gears`, with a pinion and a gear; further meshes are `stages`. The shaft of the pinion is
# `dynamics.pinion`, that of the gear `dynamics.gear`, those behind are `stages[].gear`.


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


# What gearboxes with further meshes cannot have, and where damage names a stage that does not exist.


def stage_problems(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    """Yield what is wrong about further meshes between the valid sections of a configuration."""
    yield from _beside(sections)
    names = names_in(sections["machine"], planetary=sections.get("planetary") is not None)
    yield from _idlers(sections, names)
    yield from _named(sections, names)


def most_teeth_per_turn(sections: Mapping[str, Any]) -> float:
    """Return the teeth of the fastest mesh per turn of the first pinion."""
    behind = turned_teeth(sections["gears"], stages_of(sections["machine"]))
    return float(max(*sections["gears"].teeth_of("pinion"), 0, *behind))


def pair_of(sections: Mapping[str, Any], mesh: str) -> Pair:
    """Return the section `gears` of a mesh."""
    found: Pair = next((one.gears for one in stages_of(sections["machine"]) if one.name == mesh), sections["gears"])
    return found


BESIDE = "with several meshes"


def _beside(sections: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield what gearboxes with further meshes cannot have."""
    if not (stages := stages_of(sections["machine"])):
        return
    if "dynamics" in sections:
        yield from _of_dynamics(sections["dynamics"], sections.get("housing"))
    for index, stage in enumerate(stages):
        at, allowed = f"stages.{index}.gear", "allowed: none on a shaft behind the second"
        if (value := stage.gear.eccentricity_um) != RotorSection.model_fields["eccentricity_um"].default:
            yield Problem(f"{at}.eccentricity_um", str(value), allowed)
        if stage.gear.bearing.geometry is not None:
            yield Problem(f"{at}.bearing.geometry", "a section", allowed)
    if "gears" in sections:
        yield from _of_gears(sections["gears"], stages)
    background = sections.get("background")
    if background is not None and background.second_stage is not None:
        yield Problem("background.second_stage", "a section", f"allowed: null {BESIDE}, which are all simulated")
    for index, point in enumerate(sections.get("operating_points", ())):
        if bounds(point.torque_nm)[0] <= 0.0:
            yield Problem(f"operating_points.{index}.torque_nm", str(point.torque_nm), f"allowed: above 0 {BESIDE}")


def _of_dynamics(dynamics: Dynamics, housing: object) -> Iterator[Problem]:
    if dynamics.model == "casing" and (kind := getattr(housing, "kind", "rigid")) not in {"rigid", "modal"}:
        allowed = f"allowed: rigid or modal {BESIDE}, or dynamics.model: 8dof"
        yield Problem("housing.kind", f"'{kind}' (plates by default)", allowed)
    if dynamics.shafts is not None:
        yield Problem("dynamics.shafts", "a section", f"allowed: null {BESIDE}")
    if dynamics.mesh.law != "pairs":
        yield Problem("dynamics.mesh.law", f"'{dynamics.mesh.law}'", f"allowed: pairs {BESIDE}")
    for which in ("pinion", "gear"):
        if getattr(dynamics, which).bearing.geometry is not None:
            yield Problem(f"dynamics.{which}.bearing.geometry", "a section", f"allowed: null {BESIDE}")


def _of_gears(gears: GearsSection, stages: tuple[Stage, ...]) -> Iterator[Problem]:
    if gears.pairs:
        yield Problem("gears.pairs", f"{len(gears.pairs)} pairs", f"allowed: none {BESIDE}")
    every: dict[str, Pair] = {"gears": gears, **{f"stages.{i}.gears": one.gears for i, one in enumerate(stages)}}
    for where, pair in every.items():
        if bounds(pair.helix_deg) != (0.0, 0.0):
            yield Problem(f"{where}.helix_deg", str(pair.helix_deg), f"allowed: 0 {BESIDE}")


def _idlers(sections: Mapping[str, Any], names: Names) -> Iterator[Problem]:
    """Yield numbers of an idler that it cannot have in both of its meshes, and damage that takes both of its flanks."""
    stages = stages_of(sections["machine"])
    if "gears" not in sections:
        return
    front: Pair = sections["gears"]
    for index, stage in enumerate(stages):
        if stage.idler:
            shared = {f"gears.{key}": (getattr(stage.gears, key), getattr(front, key)) for key in OF_BOTH_MESHES}
            pinions = ((f"gears.pinion.{key}", key) for key in Wheel.model_fields)
            shared |= {path: (getattr(stage.gears.pinion, key), getattr(front.gear, key)) for path, key in pinions}
            for key, (own, there) in shared.items():
                if own != there:
                    allowed = f"allowed: {there}, as in the mesh in front: an idler is one gear"
                    yield Problem(f"stages.{index}.{key}", str(own), allowed)
            meshes = names.meshes[index : index + 2]
            flanks = {meshes[0].driven.word, meshes[1].driver.word, *(f"{mesh.word}.{EITHER}" for mesh in meshes)}
            yield from _whole_teeth(sections, flanks)
        front = stage.gears


def _whole_teeth(sections: Mapping[str, Any], flanks: Collection[str]) -> Iterator[Problem]:
    """Yield damage on the teeth of an idler that is not on one flank alone."""
    for index, state in sections.get("states", {}).items():
        for where, one in state.placed(f"states.{index}"):
            if one.needs_pairs and str(getattr(one, "gear", "")) in flanks:
                allowed = "allowed: pits, spalls and cracks of an idler, whose other flank meshes elsewhere"
                yield Problem(f"{where}.kind", f"'{one.kind_word()}'", allowed)


def _named(sections: Mapping[str, Any], names: Names) -> Iterator[Problem]:
    """Yield damage on gears and bearings that a gearbox has not, and lists of damage on gears of several meshes."""
    for index, state in sections.get("states", {}).items():
        for where, one in state.placed(f"states.{index}"):
            hit = {joined(key.rpartition(".")[0], "gear"): gear for key, gear, _ in one.hit_teeth()}
            several = len(hit) > 1 or "gear" not in hit
            known = [word for word, (_, role) in names.flanks.items() if not several or role != EITHER]
            unknown = [(key, gear) for key, gear in hit.items() if gear not in known]
            for key, gear in unknown:
                allowed = f"allowed: one of {', '.join(known)}"
                if _is_written(one, key):
                    yield Problem(f"{where}.{key}", f"'{gear}'", f"{allowed}{nearest(gear, known)}")
                else:
                    yield Problem(f"{where}.{key}", MISSING, f"this key is needed where gears have names; {allowed}")
            if one.needs_bearings and one.position not in (seats := [shaft.bearing for shaft in names.shafts[:2]]):
                allowed = f"allowed: one of {', '.join(seats)}{nearest(one.position, seats)}"
                yield Problem(f"{where}.bearing", f"'{one.position}'", allowed)
            if not unknown and len({names.flanks[gear][0] for gear in hit.values()}) > 1:
                allowed = "allowed: gears of one mesh; those of further meshes in a list of damages"
                yield Problem(f"{where}.pits", ", ".join(hit.values()), allowed)


def _is_written(section: Any, key: str) -> bool:
    """Return whether a key below a section was given, not filled in."""
    *above, last = key.split(".")
    for part in above:
        section = section[int(part)] if part.isdecimal() else getattr(section, part)
    return last in section.model_fields_set
