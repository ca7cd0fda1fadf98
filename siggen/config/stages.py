"""Stages of neighbouring teeth: how far the damage of each has grown, over the sizes that a state gives."""

from __future__ import annotations

from typing import Annotated, TypeAlias

from siggen.config.distributions import Choice
from siggen.config.number import Number, Within
from siggen.config.problems import refusal
from siggen.config.teeth import TeethValue
from siggen.errors import Problem, counted

Stages: TypeAlias = Annotated[Number | tuple[Number, ...], Within(above=0, most=1, many=True)]

STAGES = (
    "lengths and depth of a tooth's spall over those given here; a number or distribution, drawn for each tooth, or a "
    "list with one for each tooth, in the order of their indices from the first on"
)


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
