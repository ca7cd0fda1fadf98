"""Section `dynamics.unbalance`: forces that come with the rotation of the shafts."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from siggen.keys.number import Number, Within
from siggen.keys.section import Section


class Unbalance(Section):
    """Residual unbalance of both shafts by balance quality grade; its phase is drawn per specimen."""

    grade_mm_s: Annotated[Number, Within(least=0, most=100)] = Field(
        default=0.0,
        description="eccentricity times speed at 50 Hz of the pinion shaft; 2.5 and 6.3 are the grades G2.5 and G6.3",
    )
