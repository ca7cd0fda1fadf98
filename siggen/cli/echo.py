"""What commands print: every sentence may hold names of strangers' files, so it is made printable on the way."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from siggen.printable import printable

if TYPE_CHECKING:
    from rich.text import Text


def echo(text: object = "", *, err: bool = False, nl: bool = True) -> None:
    """Print a text, on stderr where told."""
    typer.echo(printable(text, lines=True), err=err, nl=nl)


def cell(text: object) -> Text:
    """Return a text for a table of rich, which neither a terminal nor rich's markup obeys."""
    from rich.text import Text

    return Text(printable(text))
