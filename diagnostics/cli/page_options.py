"""Options of commands that write pages: what is written beside them, and opening them in the browser."""

from __future__ import annotations

import webbrowser
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

EXPLORER = "explorer.html"
Open = Annotated[bool, typer.Option("--open", help="Open the page in your browser.")]


@dataclass(frozen=True, slots=True)
class PageOptions:
    """Further pages."""

    explore: Annotated[
        bool,
        typer.Option("--explore", help=f"Also write {EXPLORER}, to which records and numbers of the page then lead."),
    ] = False
    show: Open = False


def opened(target: Path | str) -> None:
    """Open a file or an address; where there is no browser, say so and leave it at that."""
    address = target if isinstance(target, str) else target.resolve().as_uri()
    if not webbrowser.open(address):
        typer.echo(f"note: no browser was found; open {target} yourself", err=True)
