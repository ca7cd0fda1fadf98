"""Section of a ball bearing's numbers, as its spall and the stiffness of its shaft's support have them."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from siggen.drivetrain.bearings import BallBearing
from siggen.keys.number import Number, Within, constant
from siggen.keys.section import Section, Whole
from siggen.keys.usual import Usual

DIAMETERS = "of a ball; of the circle of the balls' centres"


class BallGeometry(Section):
    """Numbers of a ball bearing: those of a 6205, with the clearance of its normal class (memory: ISO 5753-1)."""

    balls: Annotated[Whole, Field(ge=3, le=100)] = Field(default=9, description="number of balls")
    ball_diameter_mm: Annotated[Number, Within(above=0), Usual(0.5, 150)] = Field(default=7.94, description=DIAMETERS)
    pitch_diameter_mm: Annotated[Number, Within(above=0), Usual(3, 1500)] = Field(default=39.04, description=DIAMETERS)
    clearance_um: Annotated[Number, Within(least=-100, most=1000), Usual(-20, 200)] = Field(
        default=10.0,
        description="radial play in running, which narrows the zone of load; below 0: preload",
    )

    def bearing(self) -> BallBearing:
        """Return drawn numbers in SI."""
        return BallBearing(
            self.balls,
            1e-3 * constant(self.ball_diameter_mm),
            1e-3 * constant(self.pitch_diameter_mm),
            clearance_m=1e-6 * constant(self.clearance_um),
        )
