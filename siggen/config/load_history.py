"""Load between inspections: torque and speed over hours, as a recorder gives them."""

from __future__ import annotations

from itertools import pairwise
from math import isfinite
from typing import Annotated, NamedTuple

from pydantic import Field, model_validator

from siggen.errors import Problem
from siggen.keys.problems import refusal
from siggen.keys.section import Real, Section
from siggen.life.clock import Block

UNTIL, TORQUE, SPEED = "until_h", "torque_nm", "speed_hz"
COLUMNS = (UNTIL, TORQUE, SPEED)
MOST_ROWS = 10_000
MOST_H, MOST_TORQUE_NM, MOST_SPEED_HZ = 1e7, 1e8, 1e5


class WrongRow(NamedTuple):
    """What is wrong with one number of a history: the row, from 0, its column, what came, and what is allowed."""

    row: int
    column: str
    received: str
    allowed: str


class LoadHistory(Section):
    """Rows of constant load, each from the row before it until its hour; after the last row they begin again.

    In a file `file: NAME.csv` (or .parquet) stands for the lists, which are its columns. Its numbers become part of the
    configuration when it is loaded, so that the set needs no file.
    """

    until_h: Annotated[tuple[Real, ...], Field(min_length=1)] = Field(description="hours, ascending, above 0")
    torque_nm: Annotated[tuple[Real, ...], Field(min_length=1)] = Field(
        description="torque on the pinion shaft for each hour, 0 or more"
    )
    speed_hz: Annotated[tuple[Real, ...], Field(min_length=1)] = Field(
        description="rotation of the pinion shaft for each hour, 0 or more"
    )

    @model_validator(mode="after")
    def _rows(self) -> LoadHistory:
        for key, values in ((TORQUE, self.torque_nm), (SPEED, self.speed_hz)):
            if len(values) != len(self.until_h):
                received = f"{len(values)} numbers beside {len(self.until_h)} hours"
                raise refusal([Problem(key, received, "allowed: as many as hours")])
        wrong = wrong_row(self.until_h, self.torque_nm, self.speed_hz)
        if wrong is not None:
            raise refusal([Problem(f"{wrong.column}.{wrong.row}", wrong.received, wrong.allowed)])
        if not self.wears:
            raise refusal(
                [Problem("", "no row with torque and speed above 0", "allowed: one at least, or teeth never fail")]
            )
        return self

    @property
    def wears(self) -> bool:
        """Whether any row turns gears under load."""
        return any(torque > 0.0 < speed for torque, speed in zip(self.torque_nm, self.speed_hz, strict=True))

    def blocks(self, reference_torque_nm: float) -> tuple[Block, ...]:
        """Return the rows as a clock counts them."""
        hours = (self.until_h[0], *(b - a for a, b in pairwise(self.until_h)))
        ratios = (torque / reference_torque_nm for torque in self.torque_nm)
        return tuple(map(Block, hours, self.speed_hz, ratios))


def wrong_row(until_h: tuple[float, ...], torque_nm: tuple[float, ...], speed_hz: tuple[float, ...]) -> WrongRow | None:
    """Return the first number that no history may have; the lists are of one length."""
    before = 0.0
    for row, (until, torque, speed) in enumerate(zip(until_h, torque_nm, speed_hz, strict=True)):
        if not (isfinite(until) and before < until <= MOST_H):
            beyond = f"above {before:g}, the hour before: a row lasts until its hour" if row else "above 0"
            return WrongRow(row, UNTIL, f"{until:g}", f"allowed: {beyond}; at most {MOST_H:g}")
        for column, value, most in ((TORQUE, torque, MOST_TORQUE_NM), (SPEED, speed, MOST_SPEED_HZ)):
            if not (isfinite(value) and 0.0 <= value <= most):
                return WrongRow(row, column, f"{value:g}", f"allowed: from 0 to {most:g}")
        before = until
    return None
