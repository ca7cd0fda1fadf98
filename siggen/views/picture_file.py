"""A picture in a file of its own: endings that are drawn, and what is said when drawing is impossible."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

from siggen.errors import UsageError, how_to_install
from siggen.file_writing import write_file
from siggen.views.figure_style import figure_style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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
