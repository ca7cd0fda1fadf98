"""What gearboxes with further meshes cannot have, and where damage names a stage that does not exist."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any

from siggen.config.dynamics import Dynamics, RotorSection
from siggen.config.gears import GearsSection, Pair, Wheel
from siggen.config.short_form import names_in, stages_of
from siggen.config.stages import OF_BOTH_MESHES, Stage, turned_teeth
from siggen.errors import Problem
from siggen.keys.number import bounds
from siggen.keys.problems import MISSING, joined, nearest
from siggen.names import EITHER, Names


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
