"""One look for all pictures of `siggen`: colours, grid, lines and letters; `save_figure` applies it."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from siggen.errors import UsageError, how_to_install
from siggen.file_writing import write_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure


PALETTE = (
    *("#5b6b7b", "#e3a21a", "#1f6f8b", "#b01e3c", "#6a1b6e"),
    *("#3c7d3e", "#d9622b", "#8a97a3", "#2c1e55", "#7fb3c8"),
)
"""C0 for what is healthy, then damage; C2 and C3 also stand for gear and pinion."""


def figure_style() -> dict[str, Any]:
    """Return the settings of matplotlib for a figure."""
    from cycler import cycler

    return {
        "font.size": 10,
        "axes.titlesize": 10,
        "axes.labelsize": 10,
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "axes.axisbelow": True,
        "axes.prop_cycle": cycler(color=PALETTE),
        "grid.color": "#dde3e8",
        "grid.linewidth": 0.6,
        "lines.linewidth": 1.0,
        "legend.frameon": False,
        "text.color": "#1c2733",
        "axes.labelcolor": "#1c2733",
        "axes.edgecolor": "#566573",
        "xtick.color": "#566573",
        "ytick.color": "#566573",
        "xtick.labelcolor": "#1c2733",
        "ytick.labelcolor": "#1c2733",
        "savefig.facecolor": "white",
    }


# A picture in a file of its own: endings that are drawn, and what is said when drawing is impossible.

PICTURE_ENDINGS = (".png", ".svg", ".pdf")


def check_picture_file(path: Path) -> Path:
    """Return the path if a picture can go there; call it before long work.

    Raises
    ------
    UsageError
        If the ending is none that is drawn.
    """
    if path.suffix.lower() not in PICTURE_ENDINGS:
        raise UsageError(f"{path}: received the ending {path.suffix!r}; allowed are {', '.join(PICTURE_ENDINGS)}")
    return path


def save_figure(draw: Callable[[], Figure], path: Path, dpi: int = 150) -> None:
    """Draw a figure into a file, in the one look of all pictures.

    Raises
    ------
    UsageError
        If matplotlib is missing, the ending is none that is drawn, or the file cannot be written.
    """
    check_picture_file(path)
    try:
        import matplotlib as mpl

        with mpl.rc_context(figure_style()):
            figure = draw()
    except ImportError:
        raise UsageError(f"drawing needs matplotlib: {how_to_install('diagnostics')}") from None
    drawn = BytesIO()
    with mpl.rc_context(figure_style()):  # letters are set when the file is written
        figure.savefig(drawn, format=path.suffix[1:].lower(), dpi=dpi)
    write_file(path, drawn.getvalue())
