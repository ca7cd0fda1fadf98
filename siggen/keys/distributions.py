"""Distributions a number may be drawn from, all by their inverse cumulative function of one uniform.

One uniform per number, whatever its distribution, is what keeps a draw in its place when a neighbour changes (derived).
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from statistics import NormalDist
from typing import Annotated, Any, ClassVar, TypeAlias

from pydantic import Field, GetJsonSchemaHandler, ValidationError, model_serializer, model_validator
from pydantic_core import CoreSchema

from siggen.errors import Problem
from siggen.keys.problems import nearest, received_text, refusal, section_problems
from siggen.keys.section import Real, Section

LEAST_SHARE = 0.01
"""Share of a normal distribution that its bounds must enclose; less is a slip of the pen rather than a wish."""
TWO = {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}


class _Written(Section):
    """A distribution, which a file writes in a form of its own."""

    form: ClassVar[str]
    """How a file writes it."""
    schema_of_form: ClassVar[Mapping[str, Any]]

    @abstractmethod
    def written(self) -> Any:
        """Return what a file holds."""

    @model_serializer
    def _serialized(self) -> Any:
        return self.written()

    def __str__(self) -> str:
        return written_text(self.written())

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return the form, for editors."""
        return {"title": cls.__name__, "description": cls.__doc__, **cls.schema_of_form}

    def _refuse_disorder(self, low: float, high: float) -> None:
        if not low < high:
            allowed = "allowed: the low number first, then the high one; for one fixed value give the number"
            raise refusal([Problem("", str(self), allowed)])


def _mapping_schema(**properties: Mapping[str, Any]) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": [*properties], "additionalProperties": False}


class Uniform(_Written):
    """Every value from `low` to `high` equally likely."""

    form: ClassVar[str] = "[low, high]"
    schema_of_form: ClassVar[Mapping[str, Any]] = TWO

    low: Real
    high: Real

    @model_validator(mode="after")
    def _ordered(self) -> Uniform:
        self._refuse_disorder(self.low, self.high)
        return self

    def written(self) -> Any:
        """Return what a file holds."""
        return [self.low, self.high]

    def at(self, u: float) -> float:
        """Return the value below which the share `u` lies."""
        return min(self.low + (self.high - self.low) * u, self.high)

    def bounds(self) -> tuple[float, float]:
        """Return the smallest and the largest value."""
        return self.low, self.high


class LogUniform(_Written):
    """Every ratio equally likely: the logarithm is uniform; `low` is above 0."""

    form: ClassVar[str] = "{log: [low, high]}"
    schema_of_form: ClassVar[Mapping[str, Any]] = _mapping_schema(log=TWO)

    low: Real
    high: Real

    @model_validator(mode="after")
    def _ordered(self) -> LogUniform:
        if self.low <= 0.0:
            raise refusal([Problem("", str(self), "allowed: two numbers above 0")])
        self._refuse_disorder(self.low, self.high)
        return self

    def written(self) -> Any:
        """Return what a file holds."""
        return {"log": [self.low, self.high]}

    def at(self, u: float) -> float:
        """Return the value below which the share `u` lies."""
        low, high = math.log(self.low), math.log(self.high)
        return min(max(math.exp(low + (high - low) * u), self.low), self.high)

    def bounds(self) -> tuple[float, float]:
        """Return the smallest and the largest value."""
        return self.low, self.high


class Normal(_Written):
    """Normal distribution, cut off at `low` and `high`."""

    form: ClassVar[str] = "{normal: [mean, std], within: [low, high]}"
    schema_of_form: ClassVar[Mapping[str, Any]] = _mapping_schema(normal=TWO, within=TWO)

    mean: Real
    std: Real
    low: Real
    high: Real

    @model_validator(mode="after")
    def _bounds_hold_some_of_it(self) -> Normal:
        if self.std <= 0.0:
            raise refusal([Problem("", str(self), "allowed: a standard deviation above 0")])
        self._refuse_disorder(self.low, self.high)
        least, most = self._shares()
        if most - least < LEAST_SHARE:
            allowed = f"allowed: bounds that enclose at least {LEAST_SHARE:.0%} of the normal distribution"
            raise refusal([Problem("", str(self), allowed)])
        return self

    def _shares(self) -> tuple[float, float]:
        standard = NormalDist(self.mean, self.std)
        return standard.cdf(self.low), standard.cdf(self.high)

    def written(self) -> Any:
        """Return what a file holds."""
        return {"normal": [self.mean, self.std], "within": [self.low, self.high]}

    def at(self, u: float) -> float:
        """Return the value below which the share `u` of the cut-off distribution lies."""
        least, most = self._shares()
        share = min(max(least + (most - least) * u, 2.0**-1022), 1.0 - 2.0**-53)
        return min(max(NormalDist(self.mean, self.std).inv_cdf(share), self.low), self.high)

    def bounds(self) -> tuple[float, float]:
        """Return the smallest and the largest value."""
        return self.low, self.high


class Choice(_Written):
    """One of the numbers, each equally likely; one given twice is twice as likely."""

    form: ClassVar[str] = "{one_of: [a, b]}"
    schema_of_form: ClassVar[Mapping[str, Any]] = _mapping_schema(
        one_of={"type": "array", "items": {"type": "number"}, "minItems": 1}
    )

    values: Annotated[tuple[Real, ...], Field(min_length=1)]

    def written(self) -> Any:
        """Return what a file holds."""
        return {"one_of": [*self.values]}

    def at(self, u: float) -> float:
        """Return the value whose turn it is at the share `u`."""
        count = len(self.values)
        return self.values[min(int(u * count), count - 1)]

    def bounds(self) -> tuple[float, float]:
        """Return the smallest and the largest value."""
        return min(self.values), max(self.values)


Distribution: TypeAlias = Uniform | LogUniform | Normal | Choice


@dataclass(frozen=True, slots=True)
class Changed:
    """`times` · a number + `add`: the same uniform gives the value of the same rank (no file can hold one).

    A gearbox has its factor and shift drawn by `Change.drawn`; checks of a set see them as distributions, of the same
    rank as the number.
    """

    number: float | Distribution
    times: float | Distribution = 1.0
    add: float | Distribution = 0.0

    def at(self, u: float) -> float:
        """Return the value at the uniform of the distribution."""
        times, number, add = (
            one if isinstance(one, float) else one.at(u) for one in (self.times, self.number, self.add)
        )
        return times * number + add

    def bounds(self) -> tuple[float, float]:
        """Return the smallest and the largest value of all combinations."""
        return changed_bounds(self.number, self.times, self.add)

    def __str__(self) -> str:
        return "from {:g} to {:g}".format(*self.bounds())


def changed_bounds(
    number: float | Distribution, times: float | Distribution, add: float | Distribution
) -> tuple[float, float]:
    """Return the smallest and the largest value of `times` · `number` + `add`."""
    ends = [(one, one) if isinstance(one, float) else one.bounds() for one in (number, times, add)]
    every = [a * b + c for a, b, c in product(*ends)]
    return min(every), max(every)


DRAWN = (Uniform, LogUniform, Normal, Choice, Changed)
"""Everything that is drawn."""

FORMS = (Uniform.form, LogUniform.form, Choice.form, Normal.form)
WORDS = ("log", "one_of", "normal", "within", "each")
"""Keys that make a mapping a number, or several: a file that extends another one replaces such a mapping as a whole."""
BY_WORDS: Mapping[tuple[str, ...], tuple[type[Distribution], tuple[str, ...]]] = {
    ("log",): (LogUniform, ("low", "high")),
    ("one_of",): (Choice, ()),
    ("normal", "within"): (Normal, ("mean", "std", "low", "high")),
}
"""Keys of a mapping -> distribution and its fields, in the order of the numbers."""


def is_written_number(value: object) -> bool:
    """Tell whether a value of a file is a mapping that stands for a number."""
    return isinstance(value, Mapping) and any(word in value for word in WORDS)


def distribution(value: Mapping[Any, Any] | Sequence[Any]) -> Distribution:
    """Return the distribution that a file writes as a list of two numbers or as a mapping, or raise a refusal."""
    if not isinstance(value, Mapping):
        return _made(Uniform, ("low", "high"), [value], "", Uniform.form)
    words = tuple(sorted(str(key) for key in value))
    if words in BY_WORDS:
        model, fields = BY_WORDS[words]
        return _made(model, fields, [value[word] for word in words], words[0], model.form)
    known = next((model.form for keys, (model, _) in BY_WORDS.items() if keys[0] in words), ", ".join(FORMS))
    near = next((hint for word in words if word not in WORDS and (hint := nearest(word, WORDS))), "")
    raise refusal([Problem("", written_text(value), f"allowed: {known}{near}")])


def _made(model: type[Distribution], fields: Sequence[str], lists: Sequence[Any], word: str, form: str) -> Distribution:
    """Return a distribution of the numbers in lists: one list for every two fields, or for all values."""
    for numbers in lists:
        fits = isinstance(numbers, (list, tuple)) and (len(numbers) == 2 if fields else len(numbers) > 0)
        if not fits or not all(map(is_finite, numbers)):
            raise refusal([Problem(word if len(lists) == 1 else "", _received(numbers), f"allowed: {form}")])
    flat = [float(number) for numbers in lists for number in numbers]
    try:
        return model.model_validate(dict(zip(fields, flat, strict=True)) if fields else {"values": tuple(flat)})
    except ValidationError as error:
        raise refusal(section_problems(model, error.errors())) from None


def is_finite(value: object) -> bool:
    """Tell whether a value of a file is a finite number."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    try:
        return math.isfinite(float(value))
    except OverflowError:
        return False


def _received(numbers: object) -> str:
    return received_text(numbers) if not isinstance(numbers, (list, tuple)) else written_text(numbers)


def written_text(value: Any) -> str:
    """Return a value of a file on one line, as one would write it; long ones are cut."""
    text = _flow(value)
    return text if len(text) <= 120 else f"{text[:117]}..."


def _flow(value: Any) -> str:
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{key}: {_flow(item)}' for key, item in value.items())}}}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_flow, value))}]"
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    return f"{value:.12g}" if isinstance(value, float) else str(value)
