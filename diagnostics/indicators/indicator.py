"""What an indicator is: a formula, its columns, and its description, which stand together in the source.

A formula takes signals and numbers by the names of its parameters, such as `difference` or `teeth`; which names there
are, `diagnostics.indicators.channel_signals` says. Its columns follow from a template:
`sideband_ratio_{shaft}_h{harmonic}_k{ratio_sidebands}` is one column per shaft and mesh harmonic.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from string import Formatter
from typing import Any

from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.planetary_members import MEMBERS

SUFFIX = re.compile(r"(_(pinion|gear))?(_h\d+)?(_(k|lower|upper)\d+|_o\d+_\d+)?$")

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
        before = self.column.split("{", maxsplit=1)[0]
        return before if before == self.column else re.sub(r"_h?$", "", before)

    @property
    def fields(self) -> tuple[str, ...]:
        """What its columns differ by: `shaft`, `harmonic` ..."""
        return _fields(self.column)

    @property
    def is_of_mesh(self) -> bool:
        """Whether every mesh has its columns: they differ by shaft or mesh line, which a record as a whole lacks."""
        return bool(self.fields)

    def columns(self, settings: IndicatorSettings, shafts: Sequence[str]) -> Iterator[tuple[str, dict[str, Any]]]:
        """Yield the columns of a mesh with these shafts, and the fields by which they differ.

        Members of a planetary set stand at the end of their columns, as further meshes do.
        """
        if OF_WHOLE_TURNS.intersection(self.parameters) and not set(shafts).isdisjoint(MEMBERS):
            return
        for values in product(*(shafts if field == "shaft" else settings.choices(field) for field in self.fields)):
            chosen = dict(zip(self.fields, values, strict=True))
            yield _column(self.column, chosen), chosen

    @property
    def parameters(self) -> tuple[str, ...]:
        """What its formula takes; a parameter with a default only where its columns differ by it."""
        return _parameters(self.function, self.fields)


OF_SHAFT, PINION = "_{shaft}", "_pinion"
FIELD_PATTERNS = {"shaft": "(pinion|gear)", "side": "(lower|upper)", "band": r"o\d+_\d+"}
"""What the fields of columns look like; all others are numbers."""


def _column(template: str, chosen: Mapping[str, Any]) -> str:
    member = str(chosen.get("shaft", ""))
    return (
        of_mesh(template.replace(OF_SHAFT, "").format(**chosen), member)
        if member in MEMBERS
        else template.format(**chosen)
    )


@cache
def _pattern(column: str) -> str:
    """Return the pattern of the columns of the first mesh, by an indicator's template."""
    return "".join(
        re.escape(text) + (FIELD_PATTERNS.get(name, r"\d+") if name else "")
        for text, name, _, _ in Formatter().parse(column)
    )


@cache
def _with_mesh(column: str) -> tuple[re.Pattern[str], ...]:
    """Return the patterns of columns of a further mesh, and of members of a planetary set."""
    further = re.compile(f"{_pattern(column)}_(?P<mesh>[a-z][a-z0-9_]*)")
    if OF_SHAFT not in column:
        return (further,)
    return further, re.compile(f"{_pattern(column.replace(OF_SHAFT, ''))}_(?P<mesh>{'|'.join(MEMBERS)})")


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


def base_name(column: str) -> str:
    """Return the indicator's name of a column such as `fm0_pinion_h5__bearing_vertical`."""
    name, _ = without_mesh(column)
    return SUFFIX.sub("", name)


@cache
def without_mesh(column: str) -> tuple[str, str]:
    """Return a column as the first mesh has it, without channel, and the name of its mesh, empty for the first one.

    Members of a planetary set count as meshes.
    """
    name = column.split("__", maxsplit=1)[0]
    patterns = (pattern for entry in INDICATORS if entry.is_of_mesh for pattern in _with_mesh(entry.column))
    mesh = next((match["mesh"] for pattern in patterns if (match := pattern.fullmatch(name))), "")
    return name.removesuffix(of_mesh("", mesh)), mesh


def of_mesh(column: str, mesh: str) -> str:
    """Return the column of a mesh by that of the first one, whose name is empty."""
    return f"{column}_{mesh}" if mesh else column


def or_members(column: str, known: Container[str]) -> tuple[str, ...]:
    """Return a column of the pinion, or those that members of a planetary set have in its place where it is not known.

    Parameters
    ----------
    column : str
        Such as `sideband_index_pinion_h1`, without channel.
    known : container of str
        Columns that there are.
    """
    if column in known:
        return (column,)
    return tuple(name for member in MEMBERS if (name := of_mesh(column.replace(PINION, "", 1), member)) in known)
