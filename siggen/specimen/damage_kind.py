"""What the specimen must know about a kind of damage: how it is drawn, and what cannot be at the bounds of its numbers.

Problems are found on pairs at the bounds of the gears' distributions, at the bounds of the damage's own, so that no
specimen can turn out impossible; their paths count from the state's damage.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from siggen.errors import Problem
from siggen.gears.damage.flank_damage import damage_problems
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import Number, bounds
from siggen.specimen.gears import pit_height_m
from siggen.specimen.growth import Growth

PROBE_M = 1e-9
"""Size of a damage that is checked for its place alone."""

GO_ON = {"contact": ", or dynamics.mesh.law: pairs with dynamics.mesh.damage: all or geometry"}
"""What else to do about a problem, by its name."""


@dataclass(frozen=True, slots=True)
class DamageKind:
    """One kind of damage; its section is the first argument of `draw` and the second of the others.

    Attributes
    ----------
    draw
        (section, growth) -> what this state adds.
    problems
        (pair, section) -> problems of single damages.
    widest
        (pair, section) -> the damage that may together take the whole width of contact, as large as it may be and
        without depth to speak of; nothing where that is known only when it is drawn.
    """

    draw: Callable[[Any, Growth], Damage]
    problems: Callable[[GearPair, Any], Iterator[Problem]]
    widest: Callable[[GearPair, Any], Damage]


def in_mm(text: str) -> str:
    """Return a text with its lengths in mm, the unit of the configuration."""
    text = re.sub(r"\b([a-z_]+)_m (?=[-\d])", r"\1 ", text)
    return re.sub(r"(-?\d[\d.]*(?:e[-+]?\d+)?) m\b", lambda found: f"{float(found[1]) * 1e3:.6g} mm", text)


def allowed_text(text: str) -> str:
    """Return what is allowed, in mm and with the word before it."""
    return "allowed: " + in_mm(text.removeprefix("allowed: "))


def found_problems(pair: GearPair, damage: Damage, path: str, remark: str = "") -> list[Problem]:
    """Return what is wrong with a damage as problems of one key."""
    return [
        Problem(path, f"{remark}{in_mm(problem.received)}", allowed_text(problem.allowed) + GO_ON.get(problem.name, ""))
        for problem in damage_problems(pair, damage)
    ]


def heights_m(pair: GearPair, gear: str, height_mm: Number | str, reading: str) -> list[float]:
    """Return the axial heights [m] at the bounds of a height as the configuration gives it."""
    if isinstance(height_mm, str):
        return [pit_height_m(pair, gear, height_mm, reading)]
    return [pit_height_m(pair, gear, value, reading) for value in dict.fromkeys(bounds(height_mm))]
