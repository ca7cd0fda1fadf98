"""Which teeth of a gear are damaged: neighbours, drawn per gearbox if it is a choice, or their indices."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field

from siggen.errors import Problem
from siggen.keys.distributions import Choice, distribution
from siggen.keys.parser import Parser
from siggen.keys.problems import received_text, refusal

TeethValue = int | tuple[int, ...] | Choice
DAMAGED_TEETH = "number of neighbouring teeth, the first drawn; a choice of numbers (drawn); or a list of indices"


class TeethParser(Parser):
    """Parser of `teeth`: a whole number from 1, a choice of such numbers, or a list of different indices from 0."""

    allowed_text = (
        "how many neighbouring teeth (a whole number from 1, or {one_of: [a, b]} of such), or a list of different "
        "tooth indices such as [0, 1]"
    )
    documented: Any = Annotated[int, Field(ge=1)] | list[Annotated[int, Field(ge=0)]] | Choice

    def parse(self, value: object) -> TeethValue:
        """Return the number of teeth, a choice of it, or their indices, or raise a refusal."""
        if isinstance(value, (Mapping, Choice)):
            return self._choice(value)
        if isinstance(value, (list, tuple)):
            return self._indices(value)
        if isinstance(value, int) and not isinstance(value, bool) and value >= 1:
            return value
        raise refusal([Problem("", received_text(value), f"allowed: {self.allowed_text}")])

    def _indices(self, value: list[object] | tuple[object, ...]) -> tuple[int, ...]:
        whole = [item for item in value if isinstance(item, int) and not isinstance(item, bool) and item >= 0]
        if whole and len(whole) == len(value) == len(set(whole)):
            return tuple(whole)
        listed = ", ".join(received_text(item) for item in value)
        raise refusal([Problem("", f"[{listed}]", f"allowed: {self.allowed_text}")])

    def _choice(self, value: Mapping[Any, Any] | Choice) -> Choice:
        choice = value if isinstance(value, Choice) else distribution(value)
        if not isinstance(choice, Choice):
            raise refusal([Problem("", str(choice), f"allowed: {self.allowed_text}")])
        if not all(number >= 1.0 and number.is_integer() for number in choice.values):
            raise refusal([Problem("", str(choice), "allowed: whole numbers from 1")])
        return choice


def most_teeth(teeth: TeethValue) -> int | tuple[int, ...]:
    """Return the largest number of teeth that may be hit, or their indices."""
    return round(max(teeth.values)) if isinstance(teeth, Choice) else teeth


def drawn_teeth(teeth: TeethValue, u: float) -> int | tuple[int, ...]:
    """Return the number of teeth at one uniform, or their indices."""
    return round(teeth.at(u)) if isinstance(teeth, Choice) else teeth


Teeth = Annotated[TeethValue, TeethParser()]
