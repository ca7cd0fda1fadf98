"""A user's own indicator: a function of signal, pulse times and gears that stands in the same tables."""

from __future__ import annotations

import importlib
import inspect
import math
import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.indicators.indicator import base_name
from diagnostics.indicators.line_levels import LEVELS
from diagnostics.indicators.registry import BY_NAME
from siggen.errors import UsageError


@dataclass(frozen=True, slots=True)
class Gears:
    """What an own indicator is told besides signal and pulses: tooth numbers, sampling rate, operating point."""

    teeth_pinion: int
    teeth_gear: int
    fs_hz: float
    speed_hz: float
    torque_nm: float


IndicatorFunction = Callable[[np.ndarray, np.ndarray, Gears], float]
_REGISTERED: dict[str, OwnIndicator] = {}


@dataclass(frozen=True, slots=True)
class OwnIndicator:
    """A named function `(signal (n,) [m/s²], tacho (k,) [s], gears) -> float`; NaN means undefined."""

    name: str
    function: IndicatorFunction

    def value(self, signal: np.ndarray, tacho_s: np.ndarray, gears: Gears) -> float:
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
            raise UsageError(
                f"indicator {self.name!r} failed: {type(error).__name__}: {error}. It is called as "
                "function(signal, tacho, gears) and has to return one float (nan: undefined)."
            ) from error


def _one_number(found: Any) -> float:
    """Return a number or numpy scalar as float."""
    if isinstance(found, str | bytes) or np.ndim(found) != 0:
        raise TypeError(f"returned {type(found).__name__} {np.shape(found)}, not one number")
    number = float(found)
    if math.isinf(number):
        raise ValueError("returned an infinite number; nan stands for undefined")
    return number


def register(name: str) -> Callable[[IndicatorFunction], IndicatorFunction]:
    """Return a decorator that puts a function among the indicators of this process.

    Parameters
    ----------
    name : str
        Name of its columns: lower case letters, digits and single underscores; no name that the package has.

    Raises
    ------
    UsageError
        If the name cannot be used, or another function has it; the same function defined again replaces itself.
    """
    _check_name(name)

    def keep(function: IndicatorFunction) -> IndicatorFunction:
        before = _REGISTERED.get(name)
        if before is not None and _defined_as(before.function) != _defined_as(function):
            raise UsageError(
                f"indicator name: {name!r} is registered for {'.'.join(_defined_as(before.function))} already; choose "
                f"another name, or call unregister({name!r}) first"
            )
        _REGISTERED[name] = OwnIndicator(name, function)
        return function

    return keep


def _defined_as(function: IndicatorFunction) -> tuple[str, str]:
    """Return module and qualified name: a notebook's cell that runs again defines the same function anew."""
    kind = type(function)
    return (
        str(getattr(function, "__module__", kind.__module__)),
        str(getattr(function, "__qualname__", f"{kind.__qualname__} at {id(function):#x}")),
    )


def registered() -> tuple[OwnIndicator, ...]:
    """Return the registered indicators in the order of their registration."""
    return tuple(_REGISTERED.values())


def unregister(name: str) -> None:
    """Take an indicator out of the registry; unknown names are ignored."""
    _REGISTERED.pop(name, None)


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
        raise UsageError(f"--indicator: received {reference!r}; allowed is package.module:function")
    here = str(Path.cwd())
    if here not in sys.path:  # an installed command does not look into the folder it is called from
        sys.path.append(here)
    try:
        module = importlib.import_module(module_name)
    except (Exception, SystemExit) as error:  # a user's module may fail in any way while it is read
        raise UsageError(
            f"--indicator {reference}: {type(error).__name__}: {error}. The module must be importable: put it into "
            "this folder, install its package, or set PYTHONPATH to its folder."
        ) from error
    if not hasattr(module, attribute):
        place = getattr(module, "__file__", "the interpreter itself")
        raise UsageError(
            f"--indicator {reference}: module {module_name!r} has no attribute {attribute!r}; it was found at {place}. "
            "If another file of that name was meant, rename it."
        )
    function = getattr(module, attribute)
    _check_function(function, reference, attribute)
    _check_name(attribute)
    return OwnIndicator(attribute, function)


def _check_function(function: object, reference: str, attribute: str) -> None:
    if not callable(function):
        raise UsageError(f"--indicator {reference}: {attribute} is a {type(function).__name__}, not a function")
    try:
        inspect.signature(function).bind(None, None, None)
    except ValueError:  # compiled functions may have no signature: the first record tells
        return
    except TypeError as error:
        raise UsageError(
            f"--indicator {reference}: {error}. It is called as function(signal, tacho, gears): signal (n,) [m/s²], "
            "pulse times (k,) [s], tooth numbers and rates."
        ) from error


def _check_name(name: str) -> None:
    if not re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", name) or base_name(name) != name:
        raise UsageError(
            f"indicator name: received {name!r}; allowed are lower case letters, digits and single underscores, "
            "without an ending such as _pinion, _h1 or _k1"
        )
    if name in BY_NAME or name in LEVELS:
        raise UsageError(f"indicator name: {name!r} is one of the package's own; choose another")
