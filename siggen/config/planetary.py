"""Section `planetary`: the pair of `gears` as sun and planets of a set whose ring is held."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from siggen.keys.number import Number, Within
from siggen.keys.section import Real, Section, Whole
from siggen.keys.usual import Usual
from siggen.keys.wording import AllowedText

ROLES = {"sun": "pinion", "planet": "gear"}
"""Name of a gear in a planetary set -> what it is in the pair of `gears`."""
RING = "ring"
"""The gear that is in no mesh of the pair of `gears`."""
NAMES = {role: name for name, role in ROLES.items()}
POSITIONS = AllowedText("a list of 3 to 5 angles in degrees, 0 first, ascending, below 360")

SUPPORTS = (
    "bearings of the sun's shaft (soft: it floats), pin and bearing of each planet, hold of the ring, bearings of the "
    "carrier"
)


class Planetary(Section):
    """A ring round sun and planets, their carrier, and what holds them.

    `gears.pinion` is the sun, which the motor drives; `gears.gear` is each planet; the carrier drives the load. The
    ring is shifted to mesh without backlash. Supports are alike in all directions; they stand on the ground, or with
    dynamics.model: casing in a `housing` (rigid or modal).
    """

    ring_teeth: Annotated[Whole, Field(ge=8, le=1000)] = Field(description="number of teeth of the ring")
    positions_deg: Annotated[tuple[Real, ...], Field(min_length=1, max_length=9), POSITIONS] = Field(
        default=(0.0, 120.0, 240.0),
        description="where the planets stand on the carrier, in its sense of turning; rounded ones count as the place "
        "nearby at which teeth fit",
    )
    pin_error_um: Annotated[Number, Within(least=0, most=200), Usual(0.1, 200)] = Field(
        default=0.0,
        description="standard deviation of the place of each planet's pin along the tangent, drawn per gearbox",
    )
    sun_stiffness_n_per_m: Annotated[Number, Within(above=0), Usual(100000, 1e09)] = Field(
        default=2e7, description=SUPPORTS
    )
    planet_stiffness_n_per_m: Annotated[Number, Within(above=0), Usual(1e06, 1e10)] = Field(
        default=2e8, description=SUPPORTS
    )
    ring_stiffness_n_per_m: Annotated[Number, Within(above=0), Usual(1e06, 2e10)] = Field(
        default=5e8, description=SUPPORTS
    )
    carrier_stiffness_n_per_m: Annotated[Number, Within(above=0), Usual(1e06, 1e10)] = Field(
        default=2e8, description=SUPPORTS
    )
    ring_mass_kg: Annotated[Number | None, Within(above=0, words=(None,))] = Field(
        default=None, description="null: steel, four modules thick behind the roots (assumed)"
    )
