"""What a user gave to a function of the library, refused in words: the argument, what came, what is allowed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import isfinite
from numbers import Real
from typing import Any, TypeVar

from siggen.errors import ConfigError, UsageError
from siggen.keys.problems import nearest_word

__all__ = ["finite", "named", "of_kind", "one_of", "refused", "saying"]


Kind = TypeVar("Kind")
ARGUMENTS = {"edges_mm": "outline_mm", "bearing": "on", "floor": "dish"}
"""Key of a damage in a file -> argument of its class, where they differ."""


def refused(argument: str, received: object, allowed: str) -> UsageError:
    """Return the error to raise."""
    return UsageError(f"{argument}: received {received}; allowed: {allowed}")


def finite(argument: str, value: Any, allowed: str, least: float | None = None, most: float | None = None) -> float:
    """Return a number that is finite and within bounds, ends included.

    Raises
    ------
    UsageError
        If it is none.
    """
    number = float(value) if isinstance(value, Real) and not isinstance(value, bool) else float("nan")
    if not isfinite(number) or (least is not None and number < least) or (most is not None and number > most):
        raise refused(argument, repr(value), allowed)
    return number


def one_of(argument: str, value: object, known: Sequence[str]) -> str:
    """Return a name that is known.

    Raises
    ------
    UsageError
        If it is not; names the nearest one.
    """
    if isinstance(value, str) and value in known:
        return value
    raise refused(argument, repr(value), f"{', '.join(known) or 'none'}{nearest_word(value, known)}")


def named(argument: str, values: object, known: Sequence[str]) -> tuple[str, ...]:
    """Return names that are all known, of a sequence or a single name.

    Raises
    ------
    UsageError
        If one is not.
    """
    listed: Sequence[object] = [values] if isinstance(values, str) else values  # type: ignore[assignment]
    return tuple(one_of(argument, value, known) for value in listed)


def of_kind(argument: str, value: object, kind: type[Kind], allowed: str) -> Kind:
    """Return an object of a class.

    Raises
    ------
    UsageError
        If it is none.
    """
    if not isinstance(value, kind):
        raise refused(argument, repr(value), allowed)
    return value


@contextmanager
def saying(arguments: Mapping[str, str]) -> Iterator[None]:
    """Turn refusals that name keys of a file or options of a command into refusals that name arguments.

    Parameters
    ----------
    arguments : mapping
        Beginning of a key or option -> argument.

    Raises
    ------
    UsageError
        For every refusal within.
    """
    try:
        yield
    except ConfigError as error:
        problems = (f"{_argument(one.path)}: received {one.received}; {one.allowed}" for one in error.problems)
        lines = [_said(problem, arguments) for problem in problems]
        raise UsageError("\n".join(dict.fromkeys(lines))) from None
    except UsageError as error:
        raise UsageError(_said(str(error), arguments)) from None


def _argument(path: str) -> str:
    """Return a key of a section as the argument that gives it: both semi-axes are one."""
    section, _, key = path.rpartition(".")
    return f"{section}.{'semi_axes_mm' if key.startswith('semi_axis_') else ARGUMENTS.get(key, key)}".lstrip(".")


def _said(text: str, arguments: Mapping[str, str]) -> str:
    for beginning in sorted(arguments, key=len, reverse=True):
        if text.startswith(beginning):
            return arguments[beginning] + text.removeprefix(beginning)
    return text
