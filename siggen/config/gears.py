"""Section `gears`: the gear pair, in the units of a drawing (mm, degrees, GPa)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from math import gcd
from typing import Annotated

from pydantic import BeforeValidator, Field, ValidationError, model_validator

from siggen.errors import Problem
from siggen.keys.number import Number, Within, at
from siggen.keys.problems import refusal, section_problems
from siggen.keys.section import Real, Section, Whole
from siggen.keys.usual import Usual
from siggen.keys.wording import AllowedText
from siggen.seeding import Stream, named_uniforms

# Key `gears.pairs`: the gear pairs of a set, one by one or as ranges from which a number of pairs is drawn.

SEED = 0
"""Of the pairs alone, so that another seed of the set keeps them."""
ATTEMPTS = 100
"""Draws of one pair until it is none of those before; ranges that give fewer pairs are refused."""

TEETH = "number of teeth; in `pairs` of both gears"
SHIFT = "profile shift in modules, positive away from the centre; in `pairs` of both gears"
Teeth = Annotated[Whole, Field(ge=5, le=1000)]
Shift = Annotated[Real, Field(ge=-1, le=1.5)]


class PairSection(Section):
    """One pair: what a drawing of it begins with. All else is carried over from the pair of the section `gears`."""

    teeth: Annotated[tuple[Teeth, Teeth], AllowedText("two whole numbers from 5 to 1000, [pinion, gear]")] = Field(
        description=TEETH
    )
    module_mm: Annotated[Real, Field(gt=0)] = Field(description="normal module")
    face_width_mm: Annotated[Real, Field(gt=0)] = Field(description="width of the teeth in contact")
    profile_shifts: Annotated[tuple[Shift, Shift], AllowedText("two numbers from -1 to 1.5, [pinion, gear]")] = Field(
        default=(0.0, 0.0), description=SHIFT
    )

    def __str__(self) -> str:
        """Return teeth, module and face width as a drawing has them."""
        return f"{self.teeth[0]}/{self.teeth[1]} teeth, m {self.module_mm:g}, b {self.face_width_mm:g} mm"


class DrawnPairs(Section):
    """Ranges from which pairs are drawn, all different, once for the whole set; the set's own file lists them."""

    count: Annotated[Whole, Field(ge=1, le=1000)] = Field(description="number of pairs")
    pinion_teeth: Annotated[Number, Within(least=5, most=1000)] = Field(description="rounded to a whole number")
    ratio: Annotated[Number, Within(least=0.1, most=20)] = Field(
        description="teeth of the gear over the pinion's, moved until they share no divisor"
    )
    module_mm: Annotated[Number, Within(above=0)] = Field(description="normal module")
    face_width_over_module: Annotated[Number, Within(above=0, most=100)] = Field(
        description="in modules; the width is rounded to whole mm"
    )

    def pairs(self) -> tuple[PairSection, ...]:
        """Return the pairs.

        Raises
        ------
        PydanticCustomError
            A refusal, if the ranges do not hold as many different pairs.
        """
        found: dict[PairSection, None] = {}
        for index in range(self.count):
            drawn = self._drawn(named_uniforms(SEED, Stream.PAIRS, index))
            pair = next((one for one in drawn if one not in found), None)
            if pair is None:
                received = f"{self.count}, of which {len(found)} different ones were found"
                raise refusal([Problem("count", received, "allowed: as many pairs as the ranges hold")])
            found[pair] = None
        return tuple(found)

    def _drawn(self, uniform: Callable[[str], float]) -> Iterator[PairSection]:
        for attempt in range(ATTEMPTS):
            teeth, ratio, module, width = (
                at(number, uniform(f"{name}.{attempt}"))
                for name, number in (
                    ("pinion_teeth", self.pinion_teeth),
                    ("ratio", self.ratio),
                    ("module_mm", self.module_mm),
                    ("face_width_over_module", self.face_width_over_module),
                )
            )
            pinion = round(teeth)
            gear = _gear_teeth(pinion, max(5, round(pinion * ratio)))
            yield PairSection(
                teeth=(pinion, gear), module_mm=module, face_width_mm=float(max(1, round(width * module)))
            )


def _gear_teeth(pinion: int, wanted: int) -> int:
    """Return the number of teeth nearest to the wanted one, the larger of two, that has no divisor in common."""
    tried = (wanted + sign * step for step in range(pinion) for sign in (1, -1))
    return next(z for z in tried if z >= 5 and gcd(pinion, z) == 1)


def _listed(value: object) -> object:
    """Turn ranges into the list they stand for, null into none; leave anything else to validation."""
    if value is None:
        return ()
    if not isinstance(value, Mapping):
        return value
    try:
        return DrawnPairs.model_validate(value).pairs()
    except ValidationError as error:
        raise refusal(section_problems(DrawnPairs, error.errors())) from None


PAIRS = AllowedText(
    "a list of mappings with teeth, module_mm and face_width_mm, or one mapping with count, pinion_teeth, ratio, "
    "module_mm and face_width_over_module; null for none"
)
Pairs = Annotated[
    tuple[PairSection, ...], BeforeValidator(_listed, json_schema_input_type=list[PairSection] | DrawnPairs | None)
]


class Wheel(Section):
    """One of the two gears."""

    teeth: Annotated[Whole, Field(ge=5, le=1000)] = Field(description=TEETH)
    profile_shift: Annotated[Number, Within(least=-1, most=1.5)] = Field(default=0.0, description=SHIFT)
    bore_radius_mm: Annotated[Number, Within(least=0.01, most=10_000)] = Field(
        description="radius of the bore, of the shaft"
    )


class ToothForm(Section):
    """What both gears of a mesh share: tooth form, face width, material, distance."""

    module_mm: Annotated[Number, Within(above=0)] = Field(description="normal module")
    pressure_angle_deg: Annotated[Number, Within(least=10, most=35)] = Field(
        default=20.0, description="generating pressure angle"
    )
    helix_deg: Annotated[Number, Within(least=-45, most=45), Usual(1, 45)] = Field(
        default=0.0,
        description="on the pitch cylinder, positive: right-handed driving gear; tooth sizes are those of the "
        "normal section",
    )
    face_width_mm: Annotated[Number, Within(above=0)] = Field(description="width of the teeth in contact")
    centre_distance_mm: Annotated[Number | None, Within(above=0, words=(None,))] = Field(
        default=None, description="null: where the profile shifts mesh without backlash"
    )


class Pair(ToothForm):
    """One pair: common tooth form, and the two wheels of steel. The pinion drives."""

    pinion: Wheel = Field(description="the driving gear")
    gear: Wheel = Field(description="the driven gear")

    def teeth_of(self, which: str) -> tuple[int, ...]:
        """Return the numbers of teeth that the pinion, the gear or either of them has."""
        if which == "either":
            return (*self.teeth_of("pinion"), *self.teeth_of("gear"))
        return (getattr(self, which).teeth,)


class GearsSection(Pair):
    """The first pair of a gearbox, and what other pairs gearboxes of the set may have."""

    pairs: Annotated[Pairs, PAIRS] = Field(
        default=(),
        description="one for each gearbox; other numbers are carried over from the pair above",
    )

    def teeth_of(self, which: str) -> tuple[int, ...]:
        """Return the numbers of teeth that the pinion, the gear or either of a gearbox may have."""
        if which == "either" or not self.pairs:
            return super().teeth_of(which)
        return tuple(dict.fromkeys(pair.teeth[("pinion", "gear").index(which)] for pair in self.pairs))

    @model_validator(mode="after")
    def _each_pair_once(self) -> GearsSection:
        again = [i for i, pair in enumerate(self.pairs) if pair in self.pairs[:i]]
        if again:
            problems = [Problem(f"pairs.{i}", str(self.pairs[i]), "allowed: each pair once") for i in again]
            raise refusal(problems)
        return self
