"""Axes to draw on, in the look of all pictures of siggen."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from siggen.errors import UsageError, how_to_install
from siggen.uncollected import uncollected
from siggen.views.pictures import figure_style


@contextmanager
def drawing() -> Iterator[Any]:
    """Give matplotlib's pyplot with that look.

    Raises
    ------
    UsageError
        If matplotlib is missing.
    """
    try:
        with uncollected():
            import matplotlib.pyplot as plt
    except ImportError:
        raise UsageError(f"drawing needs matplotlib: {how_to_install('diagnostics')}") from None
    with plt.rc_context(figure_style()):
        yield plt


def new_axes(plt: Any, size: tuple[float, float] = (8.0, 3.2), rows: int = 1) -> Any:
    """Return the axes of a new figure, or those of all rows, which share their abscissa."""
    return plt.subplots(rows, 1, figsize=(size[0], size[1] * (0.4 + 0.6 * rows)), sharex=True, layout="constrained")[1]


def legend_above(ax: Any) -> None:
    """Put a legend above axes, where it hides no line."""
    ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4, fontsize=8, borderaxespad=0.2)
