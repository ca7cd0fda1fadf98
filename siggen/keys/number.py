"""Physical numbers of a configuration: a constant or a distribution, within a range."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypeAlias, Union

from pydantic import Field, ValidationError
from pydantic_core import PydanticCustomError

from siggen.errors import Problem
from siggen.keys.distributions import DRAWN, KINDS, Changed, Distribution
from siggen.keys.parser import Parser
from siggen.keys.problems import MISSING, nearest, received_text, refusal, refused_problems, section_problems
from siggen.keys.wording import range_text

Number: TypeAlias = float | Distribution | Changed
"""A physical number as the YAML file gives it, or as a state changes it."""


def at(number: Number, u: float) -> float:
    """Return the value of a number at one uniform; a constant is the same at every one."""
    return number if isinstance(number, float) else number.at(u)


def bounds(number: Number) -> tuple[float, float]:
    """Return the smallest and the largest value that a number may take."""
    return (number, number) if isinstance(number, float) else number.bounds()


def constant(number: Number) -> float:
    """Return the value of a number that has been drawn.

    Raises
    ------
    TypeError
        If the number is still a distribution.
    """
    if not isinstance(number, float):
        raise TypeError(f"a drawn value was expected, received {number}")
    return number


def number_text(number: Number) -> str:
    """Return a number as a message shows it."""
    return f"{number:g}" if isinstance(number, float) else str(number)


@dataclass(frozen=True, slots=True)
class Within(Parser):
    """Range of a physical number, and the parser of every field of this kind.

    Parameters
    ----------
    above, least, most, below
        Limits; `above` and `below` are excluded, `least` and `most` included.
    words
        Values other than numbers that are taken as they are (`None`, "pitch").
    many
        Whether a list of numbers is taken too; the field is a tuple then.
    """

    above: float | None = None
    least: float | None = None
    most: float | None = None
    below: float | None = None
    words: tuple[str | None, ...] = ()
    many: bool = False

    @property
    def range_text(self) -> str:
        """What a plain number must satisfy."""
        return f"a number {range_text(self.above, self.least, self.below, self.most)}".strip()

    @property
    def allowed_text(self) -> str:
        """What the field may hold, distributions and words included."""
        words = "".join(f", or {'null' if word is None else word}" for word in self.words)
        return f"{self.range_text}, or a distribution (kind: {', '.join(KINDS)}) in that range{words}"

    def parse(self, value: object) -> Number | tuple[Number, ...] | str | None:
        """Return the number, tuple of numbers or word that `value` stands for, or raise a refusal."""
        if self.many and isinstance(value, (list, tuple)):
            return self._numbers(value)
        if value is None or isinstance(value, str):
            return self._word(value)
        return self._number(value)

    def _numbers(self, values: list[object] | tuple[object, ...]) -> tuple[Number, ...]:
        found, problems = [], []
        for index, value in enumerate(values):
            try:
                found.append(self._number(value))
            except PydanticCustomError as error:
                problems += refused_problems(error, index)
        if problems:
            raise refusal(problems)
        return tuple(found)

    def _word(self, value: str | None) -> str | None:
        if value not in self.words:
            raise refusal([Problem("", received_text(value), f"allowed: {self.allowed_text}")])
        return value

    def _number(self, value: object) -> Number:
        number = self._unbounded(value)
        low, high = bounds(number)
        if not (self._contains(low) and self._contains(high)):
            raise refusal([Problem("", str(number), f"allowed: {self.range_text}")])
        return number

    def _unbounded(self, value: object) -> Number:
        if isinstance(value, DRAWN):
            return value
        if isinstance(value, Mapping):
            return _distribution(value)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not _is_finite(value):
            raise refusal([Problem("", received_text(value), f"allowed: {self.allowed_text}")])
        return float(value)

    def _contains(self, value: float) -> bool:
        return (
            (self.above is None or value > self.above)
            and (self.least is None or value >= self.least)
            and (self.below is None or value < self.below)
            and (self.most is None or value <= self.most)
        )

    @property
    def documented(self) -> Any:
        """A number, a distribution, a list of them and the words."""
        limits = Field(gt=self.above, ge=self.least, lt=self.below, le=self.most)
        number: Any = Annotated[float, limits] | Annotated[Distribution, Field(discriminator="kind")]
        either = number | list[number] if self.many else number
        return Union[either, *(word if word is None else Literal[word] for word in self.words)]


def _distribution(value: Mapping[object, object]) -> Distribution:
    kind = value.get("kind", MISSING)
    model = KINDS.get(kind) if isinstance(kind, str) else None
    if model is None:
        received = MISSING if kind == MISSING else received_text(kind)
        raise refusal(
            [Problem("kind", received, f"allowed: one of {', '.join(KINDS)}{nearest(str(kind), list(KINDS))}")]
        )
    try:
        return model.model_validate(value)
    except ValidationError as error:
        raise refusal(section_problems(model, error.errors())) from None


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(float(value))
    except OverflowError:
        return False
