"""Section `gears`: the gear pair, in the units of a drawing (mm, degrees, GPa)."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from siggen.config.number import Number, Within
from siggen.config.section import Section, Whole


class Wheel(Section):
    """One of the two gears."""

    teeth: Annotated[Whole, Field(ge=5, le=1000)] = Field(description="number of teeth")
    profile_shift: Annotated[Number, Within(least=-1, most=1.5)] = Field(
        default=0.0, description="profile shift in modules, positive away from the centre"
    )
    bore_radius_mm: Annotated[Number, Within(least=0.01, most=10_000)] = Field(
        description="radius of the bore (the shaft's radius)"
    )


class Gears(Section):
    """The pair: common tooth form, material, and the two wheels. The pinion drives."""

    module_mm: Annotated[Number, Within(above=0)] = Field(description="normal module")
    pressure_angle_deg: Annotated[Number, Within(least=10, most=35)] = Field(
        default=20.0, description="generating pressure angle"
    )
    face_width_mm: Annotated[Number, Within(above=0)] = Field(description="width of the teeth in contact")
    youngs_modulus_gpa: Annotated[Number, Within(above=0)] = Field(
        default=206.0, description="Young's modulus of both gears"
    )
    poisson_ratio: Annotated[Number, Within(least=0, below=0.5)] = Field(default=0.3, description="Poisson's ratio")
    addendum_coefficient: Annotated[Number, Within(above=0, most=2)] = Field(
        default=1.0, description="addendum in modules"
    )
    clearance_coefficient: Annotated[Number, Within(above=0, most=1)] = Field(
        default=0.25, description="tip clearance in modules"
    )
    centre_distance_mm: Annotated[Number | None, Within(above=0, words=(None,))] = Field(
        default=None, description="null: the one at which the profile shifts mesh without backlash"
    )
    pinion: Wheel = Field(description="the driving gear")
    gear: Wheel = Field(description="the driven gear")
