"""What an indicator is, in words: signal, formula, values on known signals, source, and when it is undefined."""

from __future__ import annotations

import re
from dataclasses import dataclass

SUFFIX = re.compile(r"(_(pinion|gear))?(_h\d+)?(_k\d+)?$")


@dataclass(frozen=True, slots=True)
class Definition:
    """One indicator.

    Attributes
    ----------
    name : str
        What its columns start with; `_pinion` or `_gear`, `_h<mesh harmonic(s)>` and `_k<sideband(s)>` may follow.
    title : str
        What people call it.
    signal : str
        What it is taken from.
    formula : str
        Its value.
    unit : str
        Empty for ratios.
    known : str
        Its value on signals where that follows from the formula.
    undefined : str
        When it has no value.
    source : str
        Where it comes from; with MATLAB's convention where there is one.
    """

    name: str
    title: str
    signal: str
    formula: str
    unit: str
    known: str
    undefined: str
    source: str


def base_name(column: str) -> str:
    """Return the indicator's name of a column such as `fm0_pinion_h5__bearing_vertical`."""
    return SUFFIX.sub("", column.split("__", maxsplit=1)[0])
