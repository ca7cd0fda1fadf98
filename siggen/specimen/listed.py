"""Pits and spalls that are listed one by one: drawn, and what cannot be."""

from __future__ import annotations

from collections.abc import Iterator

from siggen.config import ListedPits
from siggen.errors import Problem
from siggen.gears.damage.pit import Pit
from siggen.gears.damage.spall import Spall
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.drawing import draw
from siggen.keys.number import at, bounds
from siggen.seeding import Stage, named_uniforms
from siggen.specimen.damage_kind import DamageKind, heights_m
from siggen.specimen.growth import MM, Growth
from siggen.specimen.single_pits import PitPlace, drawn_height_m, drawn_pit, largest_pit, pit_place_problems
from siggen.specimen.spalls import largest_spall, spall_on_tooth, spall_problems


def _listed(model: ListedPits, growth: Growth) -> Damage:
    return (*_listed_pits(model, growth), *_listed_spalls(model, growth))


def _listed_pits(model: ListedPits, growth: Growth) -> Iterator[Pit]:
    for index, pit in enumerate(model.pits):
        rng = growth.rng(f"list.pit{index}")
        height = drawn_height_m(pit.height_mm, model.height_reading, growth.pair, pit.gear, rng.random())
        yield drawn_pit(pit, growth.pair, pit.tooth, height, MM * at(pit.face_mm, rng.random()), rng)


def _listed_spalls(model: ListedPits, growth: Growth) -> Iterator[Spall]:
    uniform = named_uniforms(growth.config.seed, Stage.DAMAGE, growth.specimen_id, growth.state_id)
    for index, spall in enumerate(model.spalls):
        drawn = draw(spall, uniform, f"list.spall{index}")
        yield spall_on_tooth(growth.pair, drawn, model.height_reading, spall.tooth)


def _problems(pair: GearPair, damage: ListedPits) -> Iterator[Problem]:
    for index, pit in enumerate(damage.pits):
        keys = (f"pits.{index}.height_mm", f"pits.{index}.face_mm", f"pits.{index}.depth_mm")
        for height_m in heights_m(pair, pit.gear, pit.height_mm, damage.height_reading):
            for face_mm in bounds(pit.face_mm):
                yield from pit_place_problems(pair, PitPlace(pit.gear, height_m, face_mm / 1e3, pit, *keys))
    for index, spall in enumerate(damage.spalls):
        yield from spall_problems(pair, spall, damage.height_reading, f"spalls.{index}.")


def _widest(pair: GearPair, damage: ListedPits) -> Damage:
    # Teeth that there are not are refused by name elsewhere.
    pits = tuple(
        largest_pit(
            pit.gear,
            pit.tooth,
            heights_m(pair, pit.gear, pit.height_mm, damage.height_reading)[0],
            bounds(pit.face_mm)[0] / 1e3,
            pit,
        )
        for pit in damage.pits
        if pit.tooth < pair.member(pit.gear).teeth
    )
    spalls = [s for s in damage.spalls if s.tooth < pair.member(s.gear).teeth]
    return (*pits, *(largest_spall(pair, s, damage.height_reading, s.tooth) for s in spalls))


LISTED = DamageKind(_listed, _problems, _widest)
