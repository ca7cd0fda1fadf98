"""The options --png and --open of commands that draw: where the picture goes, and how it is shown."""

from __future__ import annotations

import tempfile
import webbrowser
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.echo import echo


@dataclass(frozen=True, slots=True)
class PictureOptions:
    """A picture."""

    png: Annotated[Path | None, typer.Option("--png", help="Picture to draw.")] = None
    show: Annotated[
        bool, typer.Option("--open", help="Draw the picture and open it; without --png in a temporary file.")
    ] = False

    def place(self, command: str) -> Path | None:
        """Return where the picture goes, None where none is wanted; checked, since what follows may take long.

        Raises
        ------
        UsageError
            If the ending of --png is none that is drawn.
        """
        from siggen.views.pictures import check_picture_file

        if self.png is None and not self.show:
            return None
        return check_picture_file(self.png or Path(tempfile.mkdtemp(prefix="siggen_")) / f"{command}.png")

    def drawn(self, png: Path, *, err: bool = False) -> None:
        """Say where the picture is, and open it if asked for."""
        echo(str(png), err=err)
        if self.show and not webbrowser.open(png.resolve().as_uri()):
            echo(f"note: no program was found to show it; open {png} yourself", err=True)
