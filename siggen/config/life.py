"""Section `life`: gearboxes that are run until teeth fail, and looked at on the way; it stands in place of `states`."""

from __future__ import annotations

from typing import Annotated

from pydantic import Discriminator, Field, Tag

from siggen.config.load_history import COLUMNS, LoadHistory
from siggen.keys.distributions import Uniform
from siggen.keys.number import Number, Within
from siggen.keys.problems import ONE, SEVERAL
from siggen.keys.section import Real, Section, Whole
from siggen.keys.wording import AllowedText
from siggen.life.pitting import Pitting

Hours = Annotated[Real, Field(gt=0, le=1e7)]
Block = tuple[Hours, Annotated[Real, Field(ge=0, le=100)]]
History = Annotated[
    Annotated[LoadHistory, Tag(ONE)] | Annotated[tuple[Block, ...], Tag(SEVERAL)],
    Discriminator(lambda given: SEVERAL if isinstance(given, (list, tuple)) else ONE),
    AllowedText(
        "a list of blocks [hours above 0, torque from 0 to 100 over that of the first operating point], or file: with "
        f"the columns {', '.join(COLUMNS)}"
    ),
]


NAME = "inspection_{:03d}"
JITTER = 0.15
"""Share of the interval within which an inspection comes early or late; assumed."""


class Life(Section):
    """How gearboxes wear, when they are looked at, and what ends them."""

    damage: Pitting = Field(default=Pitting(), description="law by which damage begins and grows")
    reference_torque_nm: Annotated[Real, Field(gt=0, le=1e8)] = Field(
        description="torque on the pinion shaft to which the law's turns belong"
    )
    scale: Annotated[Number, Within(above=0, most=1e6)] = Field(
        default=1.0, description="all times of the law are this much longer; drawn for each gearbox"
    )
    history: History = Field(
        default=(),
        description="blocks of load that repeat, or `file:` of a table; empty: the first operating point",
    )
    interval_h: Hours = Field(description="from one inspection to the next, the first at age 0")
    most: Annotated[Whole, Field(ge=2, le=1000)] = Field(description="inspections of a gearbox at most")
    functional_share: Annotated[Number, Within(above=0.02, most=0.6)] = Field(
        default=Uniform(low=0.2, high=0.4),
        description="share of one flank at which a gearbox fails, if there is land left across the face until then",
    )
    removed_share: Annotated[Real, Field(ge=0, le=1)] = Field(
        default=0.15,
        description="chance that a gearbox is taken out at an age drawn between 0 and the last inspection",
    )

    @staticmethod
    def name_of(inspection: int) -> str:
        """Return the name of an inspection among the states of a gearbox."""
        return NAME.format(inspection)
