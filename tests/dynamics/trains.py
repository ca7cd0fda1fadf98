"""Structures of machines that tests build from numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from siggen.drivetrain.gear_stage import Casing, GearStage, NextStage, PlanetaryStage, Shaft
from siggen.drivetrain.makers import Housing, planetary_train, rigid_housing, shaft_places_m, train
from siggen.drivetrain.structure import Structure, assembled
from siggen.names import PAIR, GearName, MeshName, ShaftName


def eight_dof(stage: GearStage) -> Structure:
    """Return a pair on bearings on the ground."""
    return assembled(train(stage))


def stages(first: GearStage, behind: Sequence[NextStage]) -> Structure:
    """Return meshes in a row on bearings on the ground; the only one behind the first is called slow."""
    names = ["slow"] if len(behind) == 1 else [f"mesh_{number}" for number in range(len(behind))]
    meshes = [
        MeshName(name, name, *(GearName(gear, gear, gear, gear) for gear in (f"{name}_pinion", f"{name}_gear")))
        for name in names
    ]
    shafts = [ShaftName(name, name, name) for name in names]
    own = replace(PAIR, meshes=(*PAIR.meshes, *meshes), shafts=(*PAIR.shafts, *shafts))
    return assembled(train(first, behind, names=own))


def casing_of(stage: GearStage, casing: Casing) -> Housing:
    """Return a rigid casing round a pair."""
    pinion, gear = shaft_places_m([stage], -1.0, casing.pinion_place_m)
    return rigid_housing(casing, {"pinion_bearing": pinion, "gear_bearing": gear})


def casing_structure(stage: GearStage, casing: Casing, shafts: tuple[Shaft, Shaft] | None = None) -> Structure:
    """Return a pair in a rigid casing, on shafts that bend or do not."""
    return assembled(train(stage, housing=casing_of(stage, casing), bending=shafts))


def planetary_structure(stage: PlanetaryStage, housing: Housing | None = None) -> Structure:
    """Return a planetary set on the ground, or in a housing."""
    return assembled(planetary_train(stage, housing))
