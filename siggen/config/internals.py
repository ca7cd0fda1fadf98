"""Section `internals`: which quantities that no sensor sees a set stores beside its records."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from siggen.keys.section import Section
from siggen.keys.wording import AllowedText

ALL = "all"
NAMES = AllowedText("[all], or a list of names such as mesh_force_n")


class Internals(Section):
    """A second table of the set, `internals/`, joined by `record_id`; series at the rate of the signals, as float32."""

    quantities: Annotated[tuple[str, ...], Field(min_length=1), NAMES] = Field(
        default=(ALL,), description="columns of `siggen show --internals`, or [all]"
    )

    @property
    def stores_all(self) -> bool:
        """Whether all quantities of the model are stored."""
        return ALL in self.quantities

    @property
    def named(self) -> tuple[tuple[int, str], ...]:
        """Place in the list and name of every quantity asked for by its name."""
        return tuple((place, name) for place, name in enumerate(self.quantities) if name != ALL)
