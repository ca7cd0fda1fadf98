"""Section `stiffness`: how the mesh stiffness is computed."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from siggen.errors import Problem
from siggen.keys.problems import refusal
from siggen.keys.section import Real, Section, Whole


class Stiffness(Section):
    """Models of the tooth, of the gear body below it and of the contact."""

    beam: Literal["base_circle", "root_circle", "rack_trochoid", "calibrated"] = Field(
        default="calibrated",
        description="where the tooth's cantilever begins (base_circle is the choice of paper A), or calibrated: "
        "rack_trochoid and its gear body, scaled to finite elements",
    )
    foundation: Literal["sainsot", "none"] = Field(default="sainsot", description="compliance of the gear body")
    foundation_angle: Literal["auto", "profile", "rack"] = Field(
        default="auto",
        description="reading of the tooth's root angle; auto: rack for rack_trochoid and calibrated, profile otherwise",
    )
    hertz: Literal["linear", "weber_banaschek", "power_law"] = Field(
        default="linear", description="compliance of the contact; the last two depend on hertz_force_n"
    )
    hertz_force_n: Annotated[Real, Field(gt=0)] | None = Field(
        default=None,
        description="normal force of a tooth pair at which a load-dependent contact is taken, such as torque over the "
        "pinion's base radius; needed by weber_banaschek and power_law, null otherwise",
    )
    table_points: Annotated[Whole, Field(ge=65, le=1_000_000)] = Field(
        default=2049, description="points of a stiffness table over one path of contact"
    )
    coupling: Literal["none", "body", "auto"] = Field(
        default="auto",
        description="whether neighbouring teeth in contact deflect each other through the gear body; none: the mesh is "
        "the plain sum of its pairs (paper A); auto: body for calibrated, none otherwise",
    )

    @property
    def coupled_by(self) -> str:
        """The coupling that `coupling` stands for: body or none."""
        return self._brought_along if self.coupling == "auto" else self.coupling

    @property
    def _brought_along(self) -> str:
        return "body" if self.beam == "calibrated" and self.foundation == "sainsot" else "none"

    def identity_value(self, key: str) -> Any:
        """Return what the value of a key stands for: a coupling that a beam brings along is the same when named."""
        same = key == "coupling" and self.coupling == self._brought_along
        return "auto" if same else super().identity_value(key)

    @model_validator(mode="after")
    def _goes_together(self) -> Stiffness:
        problems = [
            *self._uncalibrated("foundation", self.foundation, ("sainsot",)),
            *self._uncalibrated("foundation_angle", self.foundation_angle, ("auto", "rack")),
        ]
        if self.coupling == "body" and self.foundation == "none":
            problems.append(Problem("coupling", "'body'", "allowed: none with foundation: none"))
        if self.hertz == "linear" and self.hertz_force_n is not None:
            allowed = "allowed: null with hertz: linear, which does not depend on a force"
            problems.append(Problem("hertz_force_n", repr(self.hertz_force_n), allowed))
        if self.hertz != "linear" and self.hertz_force_n is None:
            problems.append(Problem("hertz_force_n", "null", f"allowed: a number above 0 with hertz: {self.hertz}"))
        if problems:
            raise refusal(problems)
        return self

    def _uncalibrated(self, key: str, value: str, allowed: tuple[str, ...]) -> list[Problem]:
        if self.beam != "calibrated" or value in allowed:
            return []
        return [Problem(key, f"'{value}'", f"allowed: {' or '.join(allowed)} with beam: calibrated")]
