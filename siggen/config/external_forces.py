"""Sections `dynamics.unbalance` and `dynamics.bearing_tones`: forces that come with the rotation of the shafts."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from siggen.errors import Problem
from siggen.keys.number import Number, Within
from siggen.keys.problems import refusal
from siggen.keys.section import Real, Section


class Unbalance(Section):
    """Residual unbalance of both shafts by balance quality grade; its phase is drawn per specimen."""

    grade_mm_s: Annotated[Number, Within(least=0, most=100)] = Field(
        default=0.0, description="eccentricity times speed at the rated speed; 2.5 and 6.3 are the grades G2.5 and G6.3"
    )
    rated_speed_hz: Annotated[Number, Within(above=0)] = Field(
        default=50.0, description="speed of the pinion shaft that the grade belongs to; the gear's by the ratio"
    )


class BearingTones(Section):
    """Weak tones of healthy rolling bearings; orders of a 6205-like bearing, by the speed of its shaft."""

    level: Annotated[Number, Within(least=0, most=0.5)] = Field(
        default=0.0, description="amplitude of the strongest tone over the mean mesh force; 0.01 to 0.1 is usual"
    )
    outer_race_order: Annotated[Number, Within(above=0)] = Field(default=3.585, description="ball pass, outer race")
    inner_race_order: Annotated[Number, Within(above=0)] = Field(default=5.415, description="ball pass, inner race")
    ball_order: Annotated[Number, Within(above=0)] = Field(default=2.357, description="ball spin")
    cage_order: Annotated[Number, Within(above=0)] = Field(default=0.398, description="cage")
    cage_slip: tuple[Real, Real] = Field(
        default=(0.01, 0.02), description="[low, high] of the share by which the cage lags, uniform per record"
    )
    phase_jitter_rad: Annotated[Number, Within(least=0, most=10)] = Field(
        default=0.5, description="rms of the slow wandering of the phases (corner 1 Hz)"
    )

    @model_validator(mode="after")
    def _slip_in_order(self) -> BearingTones:
        low, high = self.cage_slip
        if not 0.0 <= low <= high < 1.0:
            allowed = "allowed: two numbers [low, high] with 0 <= low <= high < 1"
            raise refusal([Problem("cage_slip", str(list(self.cage_slip)), allowed)])
        return self
