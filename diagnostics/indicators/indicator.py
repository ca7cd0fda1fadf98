"""What an indicator is: a formula, its columns, and its description, which stand together in the source.

A formula takes signals and numbers by the names of its parameters, such as `difference` or `teeth`; which names there
are, `diagnostics.indicators.channel_signals` says. Its columns follow from a template:
`sideband_ratio_{shaft}_h{harmonic}_k{ratio_sidebands}` is one column per shaft and mesh harmonic.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from string import Formatter
from typing import Any

from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.gear_train import MeshNames, in_column

STILL = "the signal does not vary (standard deviation below 1e-9 of its rms)"
NO_LINE = "the mesh line is below 1e-9 of the strongest line, or a sideband is unresolved or outside the band"
BOOK = "standard literature"
CONDITION_METRICS = "MATLAB gearConditionMetrics"
OF_CHANNEL = "that of the channel"
"""Unit of an indicator that grows with the signal."""
OF_WHOLE_TURNS = frozenset({"revolutions", "shaft_lines"})
"""What members of a planetary set lack: turns of theirs differ by where the planets stand."""
OF_A_HISTORY = "_variances"
"""How names end that hold one value per record of a history."""

Formula = Callable[..., float]


@dataclass(frozen=True, slots=True)
class Indicator:
    """One indicator.

    Attributes
    ----------
    column : str
        Template of its columns.
    function : callable
        Its formula.
    title : str
        What people call it.
    signal : str
        What it is taken from.
    formula : str
        Its value.
    unit : str
        Empty for ratios; `OF_CHANNEL` for levels and amplitudes.
    known : str
        Its value on signals where that follows from the formula.
    undefined : str
        When it has no value.
    source : str
        Where it comes from; with MATLAB's convention where there is one.
    quantities : tuple of str
        What a channel has to hold for it, in the words of the set's files; empty: anything.
    """

    column: str
    function: Formula
    title: str
    signal: str
    formula: str
    unit: str
    known: str
    undefined: str
    source: str
    quantities: tuple[str, ...] = ()

    def is_taken_of(self, quantity: str) -> bool:
        """Return whether channels that hold this have its columns."""
        return not self.quantities or quantity in self.quantities

    @property
    def history(self) -> bool:
        """Whether it needs other records of the same specimen: its formula takes their variances."""
        return any(name.endswith(OF_A_HISTORY) for name in self.parameters)

    @property
    def name(self) -> str:
        """What its columns start with."""
        before, opened, _ = self.column.partition("{")
        return before.removesuffix("h").removesuffix("_") if opened else before

    @property
    def fields(self) -> tuple[str, ...]:
        """What its columns differ by: `shaft`, `harmonic` ..."""
        return _fields(self.column)

    @property
    def is_of_mesh(self) -> bool:
        """Whether every mesh has its columns: they differ by shaft or mesh line, which a record as a whole lacks."""
        return bool(self.fields)

    def columns(self, settings: IndicatorSettings, mesh: MeshNames) -> Iterator[tuple[str, dict[str, Any]]]:
        """Yield the columns of a mesh, and the fields by which they differ; `shaft` is the gear on it.

        What is of a mesh but of none of its gears ends in the mesh's name, where it has one.
        """
        if OF_WHOLE_TURNS.intersection(self.parameters) and mesh.planetary:
            return
        end = f"_{mesh.name}" if mesh.name and self.is_of_mesh and "shaft" not in self.fields else ""
        for values in product(*(mesh.gears if field == "shaft" else settings.choices(field) for field in self.fields)):
            chosen = dict(zip(self.fields, values, strict=True))
            named = {**chosen, "shaft": in_column(str(chosen.get("shaft", "")))}
            yield self.column.format(**named) + end, chosen

    @property
    def parameters(self) -> tuple[str, ...]:
        """What its formula takes; a parameter with a default only where its columns differ by it."""
        return _parameters(self.function, self.fields)


@cache  # asked for at every value of every record
def _fields(column: str) -> tuple[str, ...]:
    return tuple(name for _, name, _, _ in Formatter().parse(column) if name)


@cache
def _parameters(function: Callable[..., float], fields: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(
        name
        for name, parameter in inspect.signature(function).parameters.items()
        if parameter.default is parameter.empty or name in fields
    )


INDICATORS: list[Indicator] = []
"""Those whose file has been imported, in its order; `diagnostics.indicators.registry` has all of them."""


def indicator(
    column: str,
    title: str,
    *,
    signal: str,
    formula: str,
    known: str,
    undefined: str,
    source: str,
    unit: str = "",
) -> Callable[[Formula], Formula]:
    """Return a decorator that puts a formula among the indicators; the arguments are those of `Indicator`."""

    def keep(function: Formula) -> Formula:
        INDICATORS.append(Indicator(column, function, title, signal, formula, unit, known, undefined, source))
        return function

    return keep


def only_of(*quantities: str) -> Callable[[Formula], Formula]:
    """Return a decorator, above that of an indicator, that leaves it to channels that hold one of the quantities."""

    def keep(function: Formula) -> Formula:
        place = next(k for k, entry in enumerate(INDICATORS) if entry.function is function)
        INDICATORS[place] = replace(INDICATORS[place], quantities=quantities)
        return function

    return keep
