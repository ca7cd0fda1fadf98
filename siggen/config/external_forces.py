"""Sections `dynamics.unbalance` and `dynamics.bearing_tones`: forces that come with the rotation of the shafts."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from siggen.keys.number import Number, Within
from siggen.keys.section import Real, Section

Order = Annotated[Real, Field(gt=0)]


class Unbalance(Section):
    """Residual unbalance of both shafts by balance quality grade; its phase is drawn per specimen."""

    grade_mm_s: Annotated[Number, Within(least=0, most=100)] = Field(
        default=0.0,
        description="eccentricity times speed at 50 Hz of the pinion shaft; 2.5 and 6.3 are the grades G2.5 and G6.3",
    )


class BearingTones(Section):
    """Weak tones of healthy rolling bearings."""

    level: Annotated[Number, Within(least=0, most=0.5)] = Field(
        default=0.0, description="amplitude of the strongest tone over the mean mesh force; 0.01 to 0.1 is usual"
    )
    orders: tuple[Order, Order, Order, Order] = Field(
        default=(3.585, 5.415, 2.357, 0.398),
        description="[ball pass of the outer race, of the inner race, ball spin, cage], by turns of the shaft; of a "
        "6205-like bearing",
    )
