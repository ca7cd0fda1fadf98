"""Physical numbers of a configuration: a constant or a distribution, within a range."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import Annotated, Any, Literal, TypeAlias, Union

from pydantic import Field
from pydantic_core import PydanticCustomError

from siggen.errors import Problem
from siggen.keys.distributions import DRAWN, FORMS, Changed, Distribution, distribution, is_finite
from siggen.keys.parser import Parser
from siggen.keys.problems import joined, received_text, refusal, refused_problems
from siggen.keys.section import Section
from siggen.keys.wording import range_text

Number: TypeAlias = float | Distribution | Changed
"""A physical number as the YAML file gives it, or as a state changes it."""


LEFT_OUT = "a number that follows from others was not sized"
LOW, MIDDLE, HIGH = -inf, 0.5, inf
"""Ends of a number in place of a uniform, and the uniform that half of all values lie below."""


def at(number: Number, u: float) -> float:
    """Return the value of a number at one uniform or end; a constant is the same at every one."""
    if isinstance(number, float):
        return number
    return number.at(u) if LOW < u < HIGH else number.bounds()[u == HIGH]


def bounds(number: Number | Each | None) -> tuple[float, float]:
    """Return the smallest and the largest value that a number, or one of several, may take.

    Raises
    ------
    TypeError
        If it is left out.
    """
    if number is None:
        raise TypeError(LEFT_OUT)
    if isinstance(number, Each):
        lows, highs = zip(*map(bounds, number.each), strict=True)
        return min(lows), max(highs)
    return (number, number) if isinstance(number, float) else number.bounds()


def constant(number: Number | None) -> float:
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


class Each(Section):
    """A number for each of several things, such as the axes of a sensor: `{each: [1.0, [0.9, 1.1]]}`."""

    each: Annotated[tuple[float | Distribution, ...], Field(min_length=1)] = Field(description="in their order")

    def __str__(self) -> str:
        """Return it as a file writes it."""
        return f"{{each: [{', '.join(map(number_text, self.each))}]}}"


def each_of(numbers: Number | Each | None, count: int) -> tuple[Number | None, ...]:
    """Return the number of each of so many things."""
    return numbers.each if isinstance(numbers, Each) else (numbers,) * count


@dataclass(frozen=True, slots=True)
class Within(Parser):
    """Range of a physical number, and the parser of every field of this kind.

    Parameters
    ----------
    above, least, most, below
        Limits; `above` and `below` are excluded, `least` and `most` included.
    words
        Values other than numbers that are taken as they are (`None`, "pitch").
    each
        Whether a number for each of several things is taken too, as `Each`; two numbers in a list stay a range.
    count
        Of how many things, where that is always the same: then each draws a number of its own, of one law too.
    size
        Numbers of a list that the field holds, as a tuple, such as the two of a place; 0: it holds one number.
    """

    above: float | None = None
    least: float | None = None
    most: float | None = None
    below: float | None = None
    words: tuple[str | None, ...] = ()
    each: bool = False
    count: int = 0
    size: int = 0

    @property
    def range_text(self) -> str:
        """What a plain number must satisfy."""
        return f"a number {range_text(self.above, self.least, self.below, self.most)}".strip()

    @property
    def allowed_text(self) -> str:
        """What the field may hold, distributions and words included."""
        number = f"a list of {self.size}, each {self._number_text}" if self.size else self._number_text
        each = "; {each: [a, b]} gives one for each" if self.each else ""
        words = "".join(f", or {'null' if word is None else word}" for word in self.words)
        return f"{number}{each}{words}"

    @property
    def _number_text(self) -> str:
        return f"{self.range_text}, or a range of such: {', '.join(FORMS[:-1])} or {FORMS[-1]}"

    def parse(self, value: object) -> Number | Each | tuple[Number, ...] | str | None:
        """Return the number, numbers or word that `value` stands for, or raise a refusal."""
        if value is None or isinstance(value, str):
            return self._word(value)
        if self.size:
            if not isinstance(value, (list, tuple)) or len(value) != self.size:
                raise self._refused(value)
            return self._numbers(value)
        if self.each and isinstance(value, Each):
            return Each.model_construct(each=self._numbers(value.each))
        if self.each and isinstance(value, Mapping) and [*value] == ["each"]:
            listed = value["each"]
            if not isinstance(listed, (list, tuple)) or not listed or (self.count and len(listed) != self.count):
                raise self._refused(value)
            return Each(each=self._numbers(value["each"], "each"))  # type: ignore[arg-type]
        return self._number(value)

    def _refused(self, value: object) -> PydanticCustomError:
        return refusal([Problem("", received_text(value), f"allowed: {self.allowed_text}")])

    def _numbers(self, values: Sequence[object], below: str = "") -> tuple[Number, ...]:
        numbers, problems = [], []
        for index, value in enumerate(values):
            try:
                numbers.append(self._number(value))
            except PydanticCustomError as error:
                problems += refused_problems(error, joined(below, index))
        if problems:
            raise refusal(problems)
        return tuple(numbers)

    def _word(self, value: str | None) -> str | None:
        if value not in self.words:
            raise self._refused(value)
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
        if self.each and isinstance(value, (list, tuple)) and len(value) != 2:
            raise self._refused(value)
        if isinstance(value, (Mapping, list, tuple)):
            return distribution(value)
        if not is_finite(value):
            allowed = self._number_text if self.size else self.allowed_text
            raise refusal([Problem("", received_text(value), f"allowed: {allowed}")])
        return float(value)  # type: ignore[arg-type]

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
        number: Any = Annotated[float, limits] | Distribution
        if self.size:
            number = Annotated[list[number], Field(min_length=self.size, max_length=self.size)]
        either = number | Each if self.each else number
        return Union[either, *(word if word is None else Literal[word] for word in self.words)]
