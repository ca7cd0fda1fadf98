"""Section `life`: gearboxes that are run until teeth fail, and looked at on the way; it stands in place of `states`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, Field

from siggen.config.machine import stages_of
from siggen.errors import Problem
from siggen.keys.distributions import Uniform
from siggen.keys.number import Number, Within, bounds, number_text
from siggen.keys.problems import received_text, refusal
from siggen.keys.section import Real, Section, Whole
from siggen.keys.usual import Usual
from siggen.keys.wording import AllowedText

MOST_H = 1e7
Hours = Annotated[Real, Field(gt=0, le=MOST_H)]
MOST_RATIO, MOST_TORQUE_NM, MOST_SPEED_HZ = 100.0, 1e8, 1e5


def _block(block: tuple[float, ...]) -> tuple[float, ...]:
    """Return a block that may be, or raise a refusal."""
    most = {2: (MOST_H, MOST_RATIO), 3: (MOST_H, MOST_TORQUE_NM, MOST_SPEED_HZ)}.get(len(block), ())
    inside = len(block) == len(most) and all(0.0 <= one <= limit for one, limit in zip(block, most, strict=True))
    if not (inside and block and block[0] > 0.0):
        raise refusal([Problem("", received_text(list(block)), f"allowed: {BLOCK.allowed_text}")])
    return block


BLOCK = AllowedText(
    f"[hours above 0, torque from 0 to {MOST_RATIO:g} over that of the first operating point], or [hours, torque in "
    "N m, speed in Hz] of the input shaft, both 0 or more"
)
Block = Annotated[tuple[Real, ...], AfterValidator(_block), BLOCK]


NAME = "inspection_{:03d}"
FUNCTIONAL_SHARE = Uniform(low=0.2, high=0.4)
"""Of one flank, at which a gearbox fails if there is land left across the face until then; assumed."""
JITTER = 0.15
"""Share of the interval within which an inspection comes early or late; assumed."""


class Life(Section):
    """How gearboxes wear, when they are looked at, and what ends them."""

    reference_torque_nm: Annotated[Real, Field(gt=0, le=1e8)] = Field(
        description="torque on the input shaft to which the law's turns belong"
    )
    scale: Annotated[Number, Within(above=0, most=1e6), Usual(0.01, 20)] = Field(
        default=1.0, description="factor on all times of the law, drawn for each gearbox"
    )
    history: tuple[Block, ...] = Field(
        default=(),
        description="blocks of load that repeat; empty: the first operating point",
    )
    interval_h: Annotated[Hours, Usual(0.05, 200)] = Field(
        description="from one inspection to the next, the first at age 0"
    )
    most: Annotated[Whole, Field(ge=2, le=1000)] = Field(description="inspections of a gearbox at most")
    removed_share: Annotated[Real, Field(ge=0, le=1), Usual(0.005, 1)] = Field(
        default=0.15,
        description="chance that a gearbox is taken out at an age drawn up to the last inspection",
    )

    @property
    def follows_point(self) -> bool:
        """Whether the first operating point loads gears between inspections."""
        return not self.history or any(len(block) == 2 for block in self.history)

    @staticmethod
    def name_of(inspection: int) -> str:
        """Return the name of an inspection among the states of a gearbox."""
        return NAME.format(inspection)


# What contradicts a section `life`: states beside it, gearboxes with further meshes, torque that no flank wears by.


def life_problems(sections: Mapping[str, Any], raw: Mapping[str, object]) -> Iterator[Problem]:
    """Yield states beside a life, and what else it cannot be beside."""
    life: Life | None = sections.get("life")
    if life is None:
        return
    if raw.get("states"):
        yield Problem("states", "states beside a section life", "allowed: one of both; with life states: null")
    for beside, what in (
        (stages_of(sections["machine"]), "further meshes"),
        (sections.get("planetary"), "planets"),
    ):
        if beside:
            yield Problem("life", f"a section life with {what}", f"allowed: null, or no {what}: teeth of one pair wear")
    yield from _loads(sections, life)


def _loads(sections: Mapping[str, Any], life: Life) -> Iterator[Problem]:
    """Yield loads under which no tooth ever pits, or the back flanks would."""
    if life.history and not any(min(block) > 0.0 for block in life.history):
        received = "no block with torque and speed above 0"
        yield Problem("life.history", received, "allowed: one at least, or teeth never fail")
    points = sections.get("operating_points", ())
    if life.follows_point and points and bounds(points[0].torque_nm)[0] <= 0.0:
        received = f"{number_text(points[0].torque_nm)} with a section life"
        allowed = "allowed: above 0, the torque between inspections, by which the front flanks wear"
        yield Problem("operating_points.0.torque_nm", received, allowed)
