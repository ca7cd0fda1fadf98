"""Section `stages`: further meshes behind the pair of `gears`, in the order of power."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from siggen.config.dynamics import Rotor
from siggen.config.gears import Gears
from siggen.errors import Problem
from siggen.keys.number import Number, Within, bounds
from siggen.keys.problems import refusal
from siggen.keys.section import Section
from siggen.keys.wording import AllowedText

STAGE_NAME = AllowedText("lower-case letters, digits and _, beginning with a letter, at most 40")


class Stage(Section):
    """One further mesh: its pinion stands on the shaft of the gear in front, its gear on a shaft of its own.

    Both gears on one shaft stand at a third and at two thirds between its bearings, which are those of the gear in
    front. The last gear drives the load.
    """

    name: Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,39}$"), STAGE_NAME] = Field(
        description="part of the names of its labels, and of its gears: NAME.pinion and NAME.gear"
    )
    gears: Gears = Field(description="its pair")
    gear: Rotor = Field(default=Rotor(), description="its gear and that gear's shaft; its pinion is a solid steel disc")
    span_mm: Annotated[Number | None, Within(above=0, most=2000, words=(None,))] = Field(
        default=None,
        description="distance of the bearings of the shaft in front, as thick as the thinner bore of its two gears; "
        "null: twice both face widths (assumed)",
    )
    direction_deg: Annotated[Number, Within(least=-180, most=180)] = Field(
        default=0.0,
        description="of the line from its pinion to its gear against that of `gears`, in the sense in which the first "
        "pinion turns",
    )

    @model_validator(mode="after")
    def _one_pair_without_bearings_by_load(self) -> Stage:
        problems = [*self._problems()]
        if problems:
            raise refusal(problems)
        return self

    def _problems(self) -> Any:
        if self.gears.pairs:
            yield Problem("gears.pairs", f"{len(self.gears.pairs)} pairs", "allowed: none in a further stage")
        if self.gear.bearing is not None:
            yield Problem("gear.bearing", "a section", "allowed: null in a set with stages")
        if bounds(self.gear.eccentricity_um)[1] > 0.0:
            yield Problem("gear.eccentricity_um", str(self.gear.eccentricity_um), "allowed: 0 in a further stage")
