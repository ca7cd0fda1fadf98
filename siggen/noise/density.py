"""A density of noise over frequency, as a table of knots or as the file that holds one."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from siggen.errors import Problem
from siggen.keys.problems import refusal
from siggen.keys.section import Real, Section


class Density(Section):
    """A one-sided density over frequency, straight between its knots in log-log, constant beyond them.

    In a file `file: NAME.csv` stands for both lists: its columns are frequency_hz and density. Its numbers become part
    of the configuration when it is loaded, so that the set needs no file.
    """

    frequency_hz: Annotated[tuple[Real, ...], Field(min_length=2)] = Field(description="knots, ascending, above 0")
    density: Annotated[tuple[Real, ...], Field(min_length=2)] = Field(description="one above 0 for each knot")

    @model_validator(mode="after")
    def _knots(self) -> Density:
        if len(self.frequency_hz) != len(self.density):
            received = f"{len(self.frequency_hz)} frequencies, {len(self.density)} densities"
            raise refusal([Problem("density", received, "allowed: as many as frequencies")])
        rising = all(a < b for a, b in zip(self.frequency_hz, self.frequency_hz[1:], strict=False))
        if not rising or self.frequency_hz[0] <= 0.0:
            raise refusal([Problem("frequency_hz", str(list(self.frequency_hz)), "allowed: ascending, above 0")])
        if min(self.density) <= 0.0:
            raise refusal([Problem("density", f"{min(self.density):g}", "allowed: numbers above 0")])
        return self
