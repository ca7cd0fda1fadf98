"""What gearboxes with further meshes cannot have, and where damage names a stage that does not exist."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from siggen.config.dynamics import Dynamics
from siggen.config.gears import Gears, Pair
from siggen.config.housing import RigidHousing
from siggen.config.stages import Stage, turned_teeth
from siggen.errors import Problem
from siggen.keys.number import bounds


def stage_problems(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    """Yield what is wrong about further meshes between the valid sections of a configuration."""
    yield from _names(sections)
    yield from _beside(sections)
    yield from _named(sections)


def most_teeth_per_turn(sections: Mapping[str, Any]) -> float:
    """Return the teeth of the fastest mesh per turn of the first pinion."""
    behind = turned_teeth(sections["gears"], sections.get("stages", ()))
    return float(max(*sections["gears"].teeth_of("pinion"), 0, *behind))


def pair_of(sections: Mapping[str, Any], gear: str) -> Pair | None:
    """Return the section `gears` of the mesh that a gear is in, None if there is no stage of its name."""
    name = gear.rpartition(".")[0]
    stages = {stage.name: stage.gears for stage in sections.get("stages", ())}
    return stages.get(name) if name else sections["gears"]


TAKEN = ("pinion", "gear", "either")
"""Words of the first mesh: a stage of such a name would take its places, labels and gears for its own."""


def _names(sections: Mapping[str, Any]) -> Iterator[Problem]:
    for index, stage in enumerate(sections.get("stages", ())):
        if stage.name in TAKEN:
            yield Problem(f"stages.{index}.name", f"'{stage.name}'", f"allowed: another name than {', '.join(TAKEN)}")


BESIDE = "in a set with stages"


def _beside(sections: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield what gearboxes with further meshes cannot have."""
    if not sections.get("stages"):
        return
    if "dynamics" in sections:
        yield from _of_dynamics(sections["dynamics"], sections.get("housing"))
    if "gears" in sections:
        yield from _of_gears(sections["gears"], sections["stages"])
    background = sections.get("background")
    if background is not None and background.second_stage is not None:
        yield Problem("background.second_stage", "a section", f"allowed: null {BESIDE}, which has one of its own")
    for index, point in enumerate(sections.get("operating_points", ())):
        if bounds(point.torque_nm)[0] <= 0.0:
            yield Problem(f"operating_points.{index}.torque_nm", str(point.torque_nm), f"allowed: above 0 {BESIDE}")


def _of_dynamics(dynamics: Dynamics, housing: object) -> Iterator[Problem]:
    if dynamics.model not in {"8dof", "casing"}:
        yield Problem("dynamics.model", f"'{dynamics.model}'", f"allowed: 8dof or casing {BESIDE}")
    if dynamics.model == "casing" and not isinstance(housing, RigidHousing | None):
        kind = getattr(housing, "kind", "plates")
        yield Problem(
            "housing.kind", f"'{kind}' (plates by default)", f"allowed: rigid {BESIDE}, or dynamics.model: 8dof"
        )
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


def _named(sections: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield damage on gears of stages that do not exist."""
    if "stages" not in sections or "gears" not in sections:
        return
    for index, state in sections.get("states", {}).items():
        for where, one in state.placed(f"states.{index}"):
            gear = str(getattr(one, "gear", ""))
            if pair_of(sections, gear) is None:
                names = [f"{stage.name}.{which}" for stage in sections["stages"] for which in ("pinion", "gear")]
                yield Problem(f"{where}.gear", f"'{gear}'", f"allowed: {', '.join(['pinion', 'gear', *names])}")
