"""Labels of logarithmic axes as plain text: figures parse no formulas, so that a dollar sign in a name begins none."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from matplotlib.ticker import LogFormatterMathtext, LogFormatterSciNotation

if TYPE_CHECKING:
    from matplotlib.figure import Figure

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


LABELLED = (1, 2, 4, 10)
"""Multiples of a power that have labels, where matplotlib gives some: all of its own overlap in flat panels."""


class PowerLabels(LogFormatterSciNotation):
    """Powers of ten with raised digits, at the places where matplotlib would write a formula."""

    def __call__(self, x: float, pos: int | None = None) -> str:
        """Return the label of one tick: 10⁻², 2×10³, or nothing."""
        if x > 0.0 and round(x / 10.0 ** math.floor(math.log10(x))) not in LABELLED:
            return ""
        formula = super().__call__(x, pos)
        text = re.sub(r"\^\{(-?\d+)\}", lambda power: power[1].translate(RAISED), formula)
        return re.sub(r"\\mathdefault|[${}]", "", text.replace(r"\times", "×"))


def write_powers(figure: Figure) -> None:
    """Replace the formulas that logarithmic axes are labelled with by default; labels of one's own stay."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            if isinstance(axis.get_major_formatter(), LogFormatterMathtext):
                axis.set_major_formatter(PowerLabels())
            if isinstance(axis.get_minor_formatter(), LogFormatterMathtext):
                axis.set_minor_formatter(PowerLabels(labelOnlyBase=False))
