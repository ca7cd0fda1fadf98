"""A toy kind of damage, as somebody would add one: a soft root as a hinge, on neighbouring teeth of a gear."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.fault import Fault
from siggen.damage.flank_place import MM, AnyGear, Length
from siggen.damage.growth import Growth
from siggen.damage.part import Part, Parts, Refusal
from siggen.damage.sham import Sham
from siggen.errors import Problem
from siggen.gears.gear_pair import GearPair
from siggen.gears.spur_gear import SpurGear
from siggen.keys.drawing import draw
from siggen.keys.number import bounds, constant
from siggen.keys.teeth import Teeth

SPRING_NM_PER_RAD, SHALLOWEST_MM = 2e4, 0.1


@dataclass(frozen=True, slots=True)
class Hinge:
    """A torsional spring in the root: at the lever u of a contact it adds u²/k to the compliance."""

    gear: str
    tooth: int
    depth_m: float
    spring_nm_per_rad: float
    kind: str = "hinge"
    outline: None = None

    def rows(self) -> list[tuple[float, ...]]:
        return []

    def tooth_compliance_m_per_n(self, pair: GearPair, roll_rad: FloatArray, sound_m_per_n: FloatArray) -> FloatArray:
        gear = pair.member(self.gear)
        slant = roll_rad - gear.base_half_angle_rad
        lever = gear.height_m(roll_rad) * np.cos(slant) - gear.half_thickness_m(roll_rad) * np.sin(slant)
        return np.asarray(lever**2 / self.spring_nm_per_rad)

    def profile_arc_m(self, gear: SpurGear) -> float:
        return 0.0

    def hides(self, other: Part) -> bool:
        return isinstance(other, Hinge) and (other.gear, other.tooth) == (self.gear, self.tooth)

    def sham(self) -> Sham:
        return Sham(self)

    def own_problems(self) -> Iterator[Refusal]:
        if self.depth_m <= 0.0:
            yield Refusal("depth_m", f"depth_m {self.depth_m!r} m", "above 0")

    def place_problems(self, pair: GearPair) -> Iterator[Refusal]:
        if not 0 <= self.tooth < pair.member(self.gear).teeth:
            yield Refusal("tooth", f"tooth {self.tooth!r}", "a tooth of the gear")

    def table_row(self) -> dict[str, object]:
        lengths = ("height_mm", "face_mm", "semi_axis_face_mm", "semi_axis_profile_mm")
        names = {"gear": self.gear, "tooth": self.tooth, "kind": self.kind, "shape": "none", "depth_law": "none"}
        return {
            **names,
            **dict.fromkeys(lengths, 0.0),
            "depth_mm": 1e3 * self.depth_m,
            "polygon_face_mm": [],
            "polygon_height_mm": [],
        }


class ToyHinge(Fault):
    """What a user writes about it."""

    words: ClassVar[tuple[str, ...]] = ("hinge",)
    acts: ClassVar[str] = "Toy hinges soften their teeth by a hinge in the root."

    kind: Literal["toy_hinge"] = "toy_hinge"
    gear: AnyGear = "pinion"
    teeth: Teeth = 1
    depth_mm: Length

    def drawn(self, growth: Growth) -> Parts:
        one = draw(self, growth.place(self.gear, ToyHinge), f"toy_hinge.{self.gear}")
        depth_m = MM * constant(one.depth_mm)
        spring = SPRING_NM_PER_RAD * (1e-3 / depth_m) ** 2
        return tuple(Hinge(self.gear, tooth, depth_m, spring) for tooth in growth.teeth(self))

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        if bounds(self.depth_mm)[0] < SHALLOWEST_MM:
            yield Problem("depth_mm", str(self.depth_mm), f"allowed: at least {SHALLOWEST_MM}")
