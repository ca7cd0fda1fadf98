"""The option --open of commands that draw: where the picture goes, and how it is shown."""

from __future__ import annotations

import tempfile
import webbrowser
from pathlib import Path
from typing import Annotated

import typer

Open = Annotated[bool, typer.Option("--open", help="Draw the picture and open it; without --png in a temporary file.")]


def picture_place(png: Path | None, show: bool, command: str) -> Path | None:
    """Return where the picture goes, None where none is wanted; checked, since what follows may take long.

    Raises
    ------
    UsageError
        If the ending of --png is none that is drawn.
    """
    from siggen.views.picture_file import check_picture_file

    if png is None and not show:
        return None
    return check_picture_file(png or Path(tempfile.mkdtemp(prefix="siggen_")) / f"{command}.png")


def check_wanted(out: Path | None, png: Path | None, command: str) -> None:
    """Check that a command has something to do.

    Raises
    ------
    UsageError
        If neither a table nor a picture is wanted, or no table can go there.
    """
    from siggen.dataset.table_file import check_table_file
    from siggen.errors import UsageError

    if out is not None:
        check_table_file(out)
    elif png is None:
        raise UsageError(
            f"siggen {command}: nothing to write; give --out {command}.csv for the table, --png {command}.png for the "
            "picture, or --open to see it"
        )


def drawn(png: Path, show: bool) -> None:
    """Say where the picture is, and open it if asked for."""
    typer.echo(str(png))
    if show and not webbrowser.open(png.resolve().as_uri()):
        typer.echo(f"note: no program was found to show it; open {png} yourself", err=True)
