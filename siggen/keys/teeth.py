"""Which teeth of a gear are damaged, and how far: neighbours, drawn per gearbox if it is a choice, or their indices.

Stages say how far the damage of each tooth has grown, over the sizes that a state gives.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, TypeAlias

from pydantic import Field, ValidationError

from siggen.errors import Problem, counted
from siggen.keys.distributions import Choice
from siggen.keys.number import Number, Within
from siggen.keys.parser import Parser
from siggen.keys.problems import received_text, refusal, section_problems

TeethValue = int | tuple[int, ...] | Choice
DAMAGED_TEETH = (
    "number of neighbouring teeth (the first is drawn), a choice of numbers, drawn per gearbox, or a list of indices"
)


class TeethParser(Parser):
    """Parser of `teeth`: a whole number from 1, a choice of such numbers, or a list of different indices from 0."""

    allowed_text = (
        "how many neighbouring teeth (a whole number from 1, or kind: choice of such numbers), or a list of different "
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

    def _choice(self, value: object) -> Choice:
        if not isinstance(value, Choice) and (not isinstance(value, Mapping) or value.get("kind") != "choice"):
            raise refusal([Problem("", received_text(value), f"allowed: {self.allowed_text}")])
        try:
            choice = Choice.model_validate(value)
        except ValidationError as error:
            raise refusal(section_problems(Choice, error.errors())) from None
        if not all(number >= 1.0 and number.is_integer() for number in choice.values):
            raise refusal([Problem("values", str(choice), "allowed: whole numbers from 1")])
        return choice


def most_teeth(teeth: TeethValue) -> int | tuple[int, ...]:
    """Return the largest number of teeth that may be hit, or their indices."""
    return round(max(teeth.values)) if isinstance(teeth, Choice) else teeth


def drawn_teeth(teeth: TeethValue, u: float) -> int | tuple[int, ...]:
    """Return the number of teeth at one uniform, or their indices."""
    return round(teeth.at(u)) if isinstance(teeth, Choice) else teeth


Teeth = Annotated[TeethValue, TeethParser()]

Stages: TypeAlias = Annotated[Number | tuple[Number, ...], Within(above=0, most=1, many=True)]

STAGES = "lengths and depth of a tooth's spall over those given here, drawn for each tooth, or a list with one for each"


def stage_of(stages: Number | tuple[Number, ...], index: int) -> Number:
    """Return the stage of the damaged tooth of this index, from 0."""
    return stages[index] if isinstance(stages, tuple) else stages


def refuse_stages(stages: Number | tuple[Number, ...], teeth: TeethValue) -> None:
    """Raise a refusal of a list that has not one stage for each damaged tooth."""
    if isinstance(teeth, Choice):
        if isinstance(stages, tuple):
            allowed = "allowed: one number or distribution where the number of teeth is drawn (teeth)"
            raise refusal([Problem("stages", f"a list of {len(stages)}", allowed)])
        return
    count = teeth if isinstance(teeth, int) else len(teeth)
    if isinstance(stages, tuple) and len(stages) != count:
        hit = counted(count, "damaged tooth", "damaged teeth")
        allowed = f"allowed: one for each of the {hit} (teeth), or one number"
        raise refusal([Problem("stages", f"a list of {len(stages)}", allowed)])
