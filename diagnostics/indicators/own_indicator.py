"""A user's own indicator: a function of signal, pulse times and gears that stands in the same tables.

Columns of the user's own indicators over the records of a set.
"""

from __future__ import annotations

import importlib
import inspect
import math
import pickle
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.indicators.line_levels import LEVELS
from diagnostics.indicators.registry import BY_NAME, indicator_columns
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.indicators.workers import mapped
from diagnostics.records.recording import Recording, recordings
from diagnostics.records.usable_records import RecordProblem
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError, counted

Found = tuple[dict[str, float], list[RecordProblem]]


def named_once(own: Sequence[OwnIndicator]) -> tuple[OwnIndicator, ...]:
    """Return these indicators.

    Raises
    ------
    UsageError
        If two have one name.
    """
    names = [indicator.name for indicator in own]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise UsageError(f"indicators: the names {twice} came twice; rename one function of each pair")
    return tuple(own)


def own_columns(
    dataset: Dataset,
    own: Sequence[OwnIndicator],
    pulses_s: Sequence[np.ndarray],
    refused: Sequence[Sequence[tuple[str, str]]],
    *,
    workers: int = 1,
    advance: Callable[[], None] | None = None,
) -> tuple[dict[str, np.ndarray], list[RecordProblem]]:
    """Return the user's indicators by column, (records,) each, undefined where they fail, and how they failed.

    Parameters
    ----------
    dataset : siggen Dataset
        The set.
    own : sequence of OwnIndicator
        All of them, each name once.
    pulses_s : sequence of (k,) float64
        Pulse times of every record.
    refused : sequence of sequence of (str, str)
        What cannot be used of every record: channel (empty: all of them) and why.
    workers : int
        Processes.
    advance : callable, optional
        Called after every record.

    Raises
    ------
    UsageError
        If one fails on every record.
    """
    if not own:
        return {}, []
    if workers > 1:
        _check_sendable(own)
    rows, problems = [], []
    for values, lost in mapped(_usable(dataset, pulses_s, refused), partial(own_values, tuple(own)), workers):
        rows.append(values)
        problems += lost
        if advance:
            advance()
    names = [f"{indicator.name}__{channel.name}" for channel in dataset.channels for indicator in own]
    for indicator in own:
        failed = [problem for problem in problems if problem.text.startswith(indicator.failure)]
        if failed and len(failed) == sum(name.startswith(f"{indicator.name}__") for row in rows for name in row):
            records = counted(len({problem.record_id for problem in failed}), "record")
            raise UsageError(f"{dataset.path}: on all {records} {failed[0].text} Mend the function, or leave it out.")
    return {name: np.array([row.get(name, math.nan) for row in rows]) for name in names}, problems


def _usable(
    dataset: Dataset, pulses_s: Sequence[np.ndarray], refused: Sequence[Sequence[tuple[str, str]]]
) -> Iterator[Recording]:
    """Yield the records with the channels that can be used and the pulses that their angles come from."""
    for record, pulses, parts in zip(recordings(dataset), pulses_s, refused, strict=True):
        lost = {channel for channel, _ in parts}
        kept = {} if "" in lost else {name: s for name, s in record.channels.items() if name not in lost}
        yield replace(record, channels=kept, tacho_s=pulses)


def own_values(own: Sequence[OwnIndicator], record: Recording) -> Found:
    """Return the user's indicators of one record by column, and how they failed."""
    values: dict[str, float] = {}
    failed: list[RecordProblem] = []
    for channel, signal in record.channels.items():
        for indicator in own:
            name = f"{indicator.name}__{channel}"
            try:
                values[name] = indicator.value(np.asarray(signal, np.float64), record.tacho_s, _gears(record))
            except UsageError as error:
                values[name] = math.nan
                failed.append(RecordProblem(int(record.labels["record_id"]), channel, str(error)))
    return values, failed


def _gears(record: Recording) -> GearFacts:
    labels = record.labels
    return GearFacts(*record.teeth, record.fs_hz, float(labels["speed_hz"]), float(labels["torque_nm"]))


def _check_sendable(own: Sequence[OwnIndicator]) -> None:
    """Check that other processes can take the user's functions: they go there by module and name."""
    for indicator in own:
        try:
            pickle.dumps(indicator)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            raise UsageError(
                f"indicator {indicator.name!r} cannot go to other processes ({error}). Define it with `def` at the top "
                "of its module, or take one worker."
            ) from error


@dataclass(frozen=True, slots=True)
class GearFacts:
    """What an own indicator is told besides signal and pulses: tooth numbers, sampling rate, operating point."""

    teeth_pinion: int
    teeth_gear: int
    fs_hz: float
    speed_hz: float
    torque_nm: float


IndicatorFunction = Callable[[np.ndarray, np.ndarray, GearFacts], float]


@dataclass(frozen=True, slots=True)
class OwnIndicator:
    """A named function `(signal (n,), tacho (k,) [s], gears) -> float`; NaN means undefined."""

    name: str
    function: IndicatorFunction

    @property
    def failure(self) -> str:
        """How the message of a failure begins."""
        return f"indicator {self.name!r} failed: "

    def value(self, signal: np.ndarray, tacho_s: np.ndarray, gears: GearFacts) -> float:
        """Return the value for one channel of a record.

        The function gets copies, so that it cannot change what the next indicator sees.

        Raises
        ------
        UsageError
            If the function fails or returns no finite number and no nan; the message names the indicator.
        """
        try:
            return _one_number(self.function(signal.copy(), tacho_s.copy(), gears))
        except Exception as error:
            said = " ".join(f"{type(error).__name__}: {error}".split())
            raise UsageError(
                f"{self.failure}{said}. It is called as function(signal, tacho, gears) and has to return one float "
                "(nan: undefined)."
            ) from error


def _one_number(found: Any) -> float:
    """Return a number or numpy scalar as float."""
    if isinstance(found, str | bytes) or np.ndim(found) != 0:
        raise TypeError(f"returned {type(found).__name__} {np.shape(found)}, not one number")
    number = float(found)
    if math.isinf(number):
        raise ValueError("returned an infinite number; nan stands for undefined")
    return number


def load_indicators(references: Sequence[str] | None) -> tuple[OwnIndicator, ...]:
    """Return the indicators named as `package.module:function`; see `load_indicator`."""
    return tuple(load_indicator(reference) for reference in references or ())


def load_indicator(reference: str) -> OwnIndicator:
    """Return the indicator named as `package.module:function`; its columns carry the function's name.

    Modules in the current folder are found too.

    Raises
    ------
    UsageError
        If the reference has no colon, the module cannot be imported, it has no such function, or the function does not
        take three arguments.
    """
    module_name, colon, attribute = reference.partition(":")
    if not colon or not module_name or not attribute:
        raise UsageError(f"indicator: received {reference!r}; allowed is package.module:function")
    here = str(Path.cwd())
    if here not in sys.path:  # an installed command does not look into the folder it is called from
        sys.path.append(here)
    try:
        module = importlib.import_module(module_name)
    except (Exception, SystemExit) as error:  # a user's module may fail in any way while it is read
        raise UsageError(
            f"indicator {reference}: {type(error).__name__}: {error}. The module must be importable: put it into "
            "this folder, install its package, or set PYTHONPATH to its folder."
        ) from error
    if not hasattr(module, attribute):
        place = getattr(module, "__file__", "the interpreter itself")
        raise UsageError(
            f"indicator {reference}: module {module_name!r} has no attribute {attribute!r}; it was found at {place}. "
            "If another file of that name was meant, rename it."
        )
    function = getattr(module, attribute)
    _check_function(function, reference, attribute)
    _check_name(attribute)
    return OwnIndicator(attribute, function)


def _check_function(function: object, reference: str, attribute: str) -> None:
    if not callable(function):
        raise UsageError(f"indicator {reference}: {attribute} is a {type(function).__name__}, not a function")
    try:
        inspect.signature(function).bind(None, None, None)
    except ValueError:  # compiled functions may have no signature: the first record tells
        return
    except TypeError as error:
        raise UsageError(
            f"indicator {reference}: {error}. It is called as function(signal, tacho, gears): signal (n,) in the "
            "unit of the channel, pulse times (k,) [s], tooth numbers and rates."
        ) from error


def _check_name(name: str) -> None:
    if not re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", name):
        raise UsageError(
            f"indicator name: received {name!r}; allowed are lower case letters, digits and single underscores"
        )
    if name in BY_NAME or name in LEVELS or name in indicator_columns(IndicatorSettings()):
        raise UsageError(f"indicator name: {name!r} is one of the package's own; choose another")
