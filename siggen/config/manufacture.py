"""Section `manufacture`: how far the teeth of both gears are from perfect."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from siggen.errors import Problem
from siggen.keys.distributions import Choice, Uniform
from siggen.keys.number import Number, Within, bounds
from siggen.keys.problems import refusal
from siggen.keys.section import Section
from siggen.keys.usual import Usual

CLASS = "of ISO 1328-1, a whole number or {one_of: [a, b]}; driven null: by the law of the driver"
CROWNING = "lead crowning, a parabola: what both ends of the face miss; driven null: by the law of the driver"


class Manufacture(Section):
    """Deviations of every tooth of both gears within ISO 1328-1:2013; needs the mesh law pairs."""

    accuracy_class: Annotated[Number, Within(least=1, most=11)] = Field(description=CLASS)
    accuracy_class_driven: Annotated[Number | None, Within(least=1, most=11, words=(None,))] = Field(
        default=None, description=CLASS
    )
    # Real gears use 30 to 70 % of their tolerance. Running in takes the peaks first, and gears at their full tolerance
    # lose contact at light loads even while they are healthy: the lower part stands for gears that have run in.
    tolerance_share: Annotated[Number, Within(least=0, most=1), Usual(0.02, 1)] = Field(
        default=Uniform(low=0.3, high=0.5), description="deviations over what the class allows, for each gear"
    )
    crowning_um: Annotated[Number, Within(least=0, most=200), Usual(0.1, 100)] = Field(
        default=0.0,
        description=CROWNING,
    )
    crowning_driven_um: Annotated[Number | None, Within(least=0, most=200, words=(None,)), Usual(0.1, 100)] = Field(
        default=None, description=CROWNING
    )
    helix: Literal["off", "iso_1328"] = Field(
        default="off",
        description="iso_1328: slope and form of each gear within tolerance_share of its class",
    )
    lead_misalignment_um: Annotated[Number | str, Within(least=0, most=500, words=("iso_1328",)), Usual(0.1, 100)] = (
        Field(
            default=0.0,
            description="gap of the flanks at either end of the face; iso_1328: by the helix slopes",
        )
    )
    flank_waves: Literal["off", "on"] = Field(
        default="off",
        description="waves over all teeth (ghosts, chuck) and forms of teeth; part of no tolerance or other label",
    )
    draw: Literal["specimen", "state"] = Field(
        default="specimen",
        description="specimen: one gear pair in all states, as on a rig; state: another pair for each",
    )

    @model_validator(mode="after")
    def _whole_classes(self) -> Manufacture:
        problems = []
        for key in ("accuracy_class", "accuracy_class_driven"):
            number = getattr(self, key)
            values = number.values if isinstance(number, Choice) else (number,)
            if any((isinstance(v, float) and not v.is_integer()) or not isinstance(v, float | None) for v in values):
                allowed = "allowed: a whole number from 1 to 11, or {one_of: [a, b]} of whole numbers"
                problems.append(Problem(key, str(number), allowed))
        if problems:
            raise refusal(problems)
        return self

    @model_validator(mode="after")
    def _slopes_once(self) -> Manufacture:
        if self.has_helix and self.lead_misalignment_um == "iso_1328":
            allowed = "allowed: a number beside helix: iso_1328, which has the helix slopes already"
            raise refusal([Problem("lead_misalignment_um", "iso_1328", allowed)])
        return self

    @property
    def crowning_of_gear(self) -> Number:
        """Crowning of the driven gear, as given or as for the pinion."""
        return self.crowning_um if self.crowning_driven_um is None else self.crowning_driven_um

    @property
    def has_crowning(self) -> bool:
        """Whether a gear may be crowned."""
        return max(bounds(self.crowning_um)[1], bounds(self.crowning_of_gear)[1]) > 0.0

    @property
    def has_helix(self) -> bool:
        """Whether helices have errors."""
        return self.helix != "off"

    @property
    def classes_text(self) -> str:
        """The classes in words, such as "6", "5, 6 or 7" or "6, gear 7"."""
        gear = self.accuracy_class_driven
        pinion = _class_text(self.accuracy_class)
        return pinion if gear is None else f"{pinion}, gear {_class_text(gear)}"

    @property
    def gear_class(self) -> Number:
        """Class of the driven gear, as given or as for the pinion."""
        return self.accuracy_class if self.accuracy_class_driven is None else self.accuracy_class_driven


def _class_text(number: Number) -> str:
    values = [f"{value:g}" for value in (number.values if isinstance(number, Choice) else bounds(number)[:1])]
    return " or ".join(part for part in (", ".join(values[:-1]), values[-1]) if part)
