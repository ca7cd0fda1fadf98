"""What gearboxes with further meshes cannot have, and where damage names a stage that does not exist."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any

from siggen.config.dynamics import Dynamics, Rotor
from siggen.config.gears import Gears, Pair, Wheel
from siggen.config.planetary import RING, ROLES
from siggen.config.stages import OF_BOTH_MESHES, Stage, turned_teeth
from siggen.errors import Problem
from siggen.keys.number import bounds
from siggen.keys.problems import received_text


def stage_problems(sections: Mapping[str, Any], raw: Mapping[str, object]) -> Iterator[Problem]:
    """Yield what is wrong about further meshes between the valid sections of a configuration."""
    yield from _beside(sections)
    yield from _idlers(sections)
    yield from _named(sections, raw)


def most_teeth_per_turn(sections: Mapping[str, Any]) -> float:
    """Return the teeth of the fastest mesh per turn of the first pinion."""
    behind = turned_teeth(sections["gears"], sections.get("stages", ()))
    return float(max(*sections["gears"].teeth_of("pinion"), 0, *behind))


def pair_of(sections: Mapping[str, Any], gear: str) -> Pair | None:
    """Return the section `gears` of the mesh that a gear is in, None if there is no stage of its name."""
    name = gear.rpartition(".")[0]
    stages = {stage.name: stage.gears for stage in sections.get("stages", ())}
    return stages.get(name) if name else sections["gears"]


BESIDE = "with several meshes"


def _beside(sections: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield what gearboxes with further meshes cannot have."""
    if not sections.get("stages"):
        return
    if "dynamics" in sections:
        yield from _of_dynamics(sections["dynamics"], sections.get("housing"))
    for index, stage in enumerate(sections["stages"]):
        for key in ("bearing", "eccentricity_um"):
            if (value := getattr(stage.gear, key)) != Rotor.model_fields[key].default:
                received = received_text(value)
                yield Problem(f"stages.{index}.gear.{key}", received, "allowed: none on a shaft behind the second")
    if "gears" in sections:
        yield from _of_gears(sections["gears"], sections["stages"])
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
        if getattr(dynamics, which).bearing is not None:
            yield Problem(f"dynamics.{which}.bearing", "a section", f"allowed: null {BESIDE}")


def _of_gears(gears: Gears, stages: tuple[Stage, ...]) -> Iterator[Problem]:
    if gears.pairs:
        yield Problem("gears.pairs", f"{len(gears.pairs)} pairs", f"allowed: none {BESIDE}")
    every: dict[str, Pair] = {"gears": gears, **{f"stages.{i}.gears": one.gears for i, one in enumerate(stages)}}
    for where, pair in every.items():
        if bounds(pair.helix_deg) != (0.0, 0.0):
            yield Problem(f"{where}.helix_deg", str(pair.helix_deg), f"allowed: 0 {BESIDE}")


def _idlers(sections: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield numbers of an idler that it cannot have in both of its meshes, and damage that takes both of its flanks."""
    stages: tuple[Stage, ...] = sections.get("stages", ())
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
            yield from _whole_teeth(sections, {_gear_in_front(stages, index), f"{stage.name}.pinion"})
        front = stage.gears


def _gear_in_front(stages: tuple[Stage, ...], index: int) -> str:
    return f"{stages[index - 1].name}.gear" if index else "gear"


def _whole_teeth(sections: Mapping[str, Any], flanks: Collection[str]) -> Iterator[Problem]:
    """Yield damage on the teeth of an idler that is not on one flank alone."""
    drawn = {f"{flank.removesuffix(flank.rpartition('.')[2])}either" for flank in flanks}
    for index, state in sections.get("states", {}).items():
        for where, one in state.placed(f"states.{index}"):
            if one.needs_pairs and str(getattr(one, "gear", "")) in {*flanks, *drawn}:
                allowed = "allowed: pits, spalls and cracks of an idler, whose other flank meshes elsewhere"
                yield Problem(f"{where}.kind", f"'{one.kind_word()}'", allowed)


def _named(sections: Mapping[str, Any], raw: Mapping[str, object]) -> Iterator[Problem]:
    """Yield damage on gears that a pair or a planetary set has not; words of a machine are those of its names."""
    if sections["machine"] is not None or (raw.get("planetary") and not sections.get("planetary")):
        return
    known = ("pinion", "gear", "either") if sections.get("planetary") is None else (*ROLES, RING)
    for index, state in sections.get("states", {}).items():
        for where, one in state.placed(f"states.{index}"):
            gear = str(getattr(one, "gear", known[0]))
            if gear not in known:
                yield Problem(f"{where}.gear", f"'{gear}'", f"allowed: {', '.join(known)}")
