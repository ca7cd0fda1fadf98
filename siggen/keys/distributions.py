"""Distributions a number may be drawn from, all by their inverse cumulative function of one uniform.

One uniform per number, whatever its distribution, is what keeps a draw in its place when a neighbour changes (derived).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product
from statistics import NormalDist
from typing import Annotated, Literal, TypeAlias

from pydantic import Field, model_validator

from siggen.errors import Problem
from siggen.keys.problems import refusal
from siggen.keys.section import Real, Section

LEAST_SHARE = 0.01
"""Share of a normal distribution that its bounds must enclose; less is a slip of the pen rather than a wish."""


class Uniform(Section):
    """Every value from `low` to `high` equally likely."""

    kind: Literal["uniform"] = "uniform"
    low: Real
    high: Real

    @model_validator(mode="after")
    def _ordered(self) -> Uniform:
        _require_order(self.low, self.high)
        return self

    def at(self, u: float) -> float:
        """Return the value below which the share `u` lies."""
        return min(self.low + (self.high - self.low) * u, self.high)

    def bounds(self) -> tuple[float, float]:
        """Return the smallest and the largest value."""
        return self.low, self.high

    def __str__(self) -> str:
        return f"uniform from {self.low} to {self.high}"


class LogUniform(Section):
    """Every ratio equally likely: the logarithm is uniform between those of `low` and `high`, both above 0."""

    kind: Literal["loguniform"] = "loguniform"
    low: Annotated[Real, Field(gt=0)]
    high: Annotated[Real, Field(gt=0)]

    @model_validator(mode="after")
    def _ordered(self) -> LogUniform:
        _require_order(self.low, self.high)
        return self

    def at(self, u: float) -> float:
        """Return the value below which the share `u` lies."""
        low, high = math.log(self.low), math.log(self.high)
        return min(max(math.exp(low + (high - low) * u), self.low), self.high)

    def bounds(self) -> tuple[float, float]:
        """Return the smallest and the largest value."""
        return self.low, self.high

    def __str__(self) -> str:
        return f"loguniform from {self.low} to {self.high}"


class Normal(Section):
    """Normal distribution cut off at `low` and `high` (no value is ever drawn outside)."""

    kind: Literal["normal"] = "normal"
    mean: Real
    std: Annotated[Real, Field(gt=0)]
    low: Real
    high: Real

    @model_validator(mode="after")
    def _bounds_hold_some_of_it(self) -> Normal:
        _require_order(self.low, self.high)
        least, most = self._shares()
        if most - least < LEAST_SHARE:
            received = f"{self.low} to {self.high} with mean {self.mean} and std {self.std}"
            allowed = f"allowed: bounds that enclose at least {LEAST_SHARE:.0%} of the normal distribution"
            raise refusal([Problem("low", received, allowed)])
        return self

    def _shares(self) -> tuple[float, float]:
        standard = NormalDist(self.mean, self.std)
        return standard.cdf(self.low), standard.cdf(self.high)

    def at(self, u: float) -> float:
        """Return the value below which the share `u` of the cut-off distribution lies."""
        least, most = self._shares()
        share = min(max(least + (most - least) * u, 2.0**-1022), 1.0 - 2.0**-53)
        return min(max(NormalDist(self.mean, self.std).inv_cdf(share), self.low), self.high)

    def bounds(self) -> tuple[float, float]:
        """Return the smallest and the largest value."""
        return self.low, self.high

    def __str__(self) -> str:
        return f"normal around {self.mean}, cut off at {self.low} and {self.high}"


class Choice(Section):
    """One of `values`, each entry equally likely; a value given twice is twice as likely."""

    kind: Literal["choice"] = "choice"
    values: Annotated[tuple[Real, ...], Field(min_length=1)]

    def at(self, u: float) -> float:
        """Return the value whose turn it is at the share `u`."""
        count = len(self.values)
        return self.values[min(int(u * count), count - 1)]

    def bounds(self) -> tuple[float, float]:
        """Return the smallest and the largest value."""
        return min(self.values), max(self.values)

    def __str__(self) -> str:
        return f"a choice of {', '.join(str(value) for value in self.values)}"


Distribution: TypeAlias = Uniform | LogUniform | Normal | Choice


@dataclass(frozen=True, slots=True)
class Changed:
    """`times` · a number + `add`: the same uniform gives the value of the same rank (no file can hold one).

    A factor or shift that is a distribution itself is not drawn yet: then only bounds are known.
    """

    number: float | Distribution
    times: float | Distribution = 1.0
    add: float | Distribution = 0.0

    def at(self, u: float) -> float:
        """Return the value at the uniform of the distribution.

        Raises
        ------
        TypeError
            If factor or shift have not been drawn.
        """
        if not (isinstance(self.times, float) and isinstance(self.add, float)):
            raise TypeError(f"a drawn factor and shift were expected, received {self.times} and {self.add}")
        return self.times * (self.number if isinstance(self.number, float) else self.number.at(u)) + self.add

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

KINDS: dict[str, type[Distribution]] = {
    "uniform": Uniform,
    "loguniform": LogUniform,
    "normal": Normal,
    "choice": Choice,
}


def _require_order(low: float, high: float) -> None:
    if not low < high:
        raise refusal(
            [Problem("high", repr(high), f"allowed: a number above low ({low}); for one fixed value give the number")]
        )
