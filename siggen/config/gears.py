"""Section `gears`: the gear pair, in the units of a drawing (mm, degrees, GPa)."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from siggen.config.pairs import PAIRS, Pairs
from siggen.errors import Problem
from siggen.keys.number import Number, Within
from siggen.keys.problems import refusal
from siggen.keys.section import Section, Whole
from siggen.keys.usual import Usual


class Wheel(Section):
    """One of the two gears."""

    teeth: Annotated[Whole, Field(ge=5, le=1000)] = Field(description="number of teeth")
    profile_shift: Annotated[Number, Within(least=-1, most=1.5)] = Field(
        default=0.0, description="profile shift in modules, positive away from the centre"
    )
    bore_radius_mm: Annotated[Number, Within(least=0.01, most=10_000)] = Field(
        description="radius of the bore (the shaft's radius)"
    )


class ToothForm(Section):
    """What both gears of a mesh share: tooth form, face width, material, distance."""

    module_mm: Annotated[Number, Within(above=0)] = Field(description="normal module")
    pressure_angle_deg: Annotated[Number, Within(least=10, most=35)] = Field(
        default=20.0, description="generating pressure angle"
    )
    helix_deg: Annotated[Number, Within(least=-45, most=45), Usual(1, 45)] = Field(
        default=0.0,
        description="helix angle on the pitch cylinder, positive: right-handed driving gear; modules, coefficients and "
        "pressure angle stay those of the normal section",
    )
    face_width_mm: Annotated[Number, Within(above=0)] = Field(description="width of the teeth in contact")
    youngs_modulus_gpa: Annotated[Number, Within(above=0)] = Field(
        default=206.0, description="Young's modulus of both gears"
    )
    centre_distance_mm: Annotated[Number | None, Within(above=0, words=(None,))] = Field(
        default=None, description="null: the one at which the profile shifts mesh without backlash"
    )


class Pair(ToothForm):
    """One pair: common tooth form, material, and the two wheels. The pinion drives."""

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
        description=(
            "pairs of the set, one for each gearbox; other numbers are those of the pair above, carried over; null: "
            "no other pairs"
        ),
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
