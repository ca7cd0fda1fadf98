"""Numbers and lists as a sentence says them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence

from diagnostics.statistics.evaluation import Interval


def counted(number: int, noun: str) -> str:
    """Return a number with its noun, in the plural unless there is one."""
    several = f"{noun[:-1]}ies" if noun.endswith("y") else f"{noun}es" if noun.endswith(("x", "ss")) else f"{noun}s"
    return f"{number}\N{NO-BREAK SPACE}{noun if number == 1 else several}"


def joined(parts: Sequence[str]) -> str:
    """Return a list as text: a, b and c."""
    return " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)


def capitalised(text: str) -> str:
    """Return a text with a capital first letter, the rest as it is."""
    return text[:1].upper() + text[1:]


def percent(value: float) -> str:
    """Return a share as whole percent."""
    return f"{100.0 * value:.0f}\N{NO-BREAK SPACE}%" if math.isfinite(value) else "undefined"


def decimal(value: float) -> str:
    """Return a number with two decimals."""
    return f"{value:.2f}" if math.isfinite(value) else "undefined"


def rounded(value: float) -> str:
    """Return a positive number with two significant digits, never as a power of ten: 0.35, 2.1, 16, 160."""
    return f"{float(f'{value:.2g}'):g}" if math.isfinite(value) else "undefined"


def signed(value: float) -> str:
    """Return a difference with two decimals and its sign; none before zero."""
    text = f"{value:+.2f}"
    return text[1:] if text[1:] == "0.00" else text.replace("-", "\N{MINUS SIGN}")


def limits(interval: Interval) -> str:
    """Return the limits of a value, or why there are none."""
    return _limits(interval, decimal)


def signed_limits(interval: Interval) -> str:
    """Return the limits of a difference, or why there are none."""
    return _limits(interval, signed)


def percent_limits(interval: Interval) -> str:
    """Return the limits of a share, or why there are none."""
    return _limits(interval, percent)


def _limits(interval: Interval, written: Callable[[float], str]) -> str:
    if math.isnan(interval.low):
        return "no interval from so few gearboxes"
    return f"{written(interval.low)} to {written(interval.high)}"


def minus(text: str) -> str:
    """Return text with a true minus sign before numbers, and none before a zero."""
    plain = re.sub(r"(?<![\w.])[-+](0(?:\.0+)?)(?![\d.])", r"\1", text)
    return re.sub(r"(?<![\w.,)])-(?=\d)", "\N{MINUS SIGN}", plain)
