"""Opening what a command wrote in the browser of this machine."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import Annotated

import typer

Open = Annotated[bool, typer.Option("--open", help="Open the page in your browser.")]


def opened(target: Path | str) -> None:
    """Open a file or an address; where there is no browser, say so and leave it at that."""
    address = target if isinstance(target, str) else target.resolve().as_uri()
    if not webbrowser.open(address):
        typer.echo(f"note: no browser was found; open {target} yourself", err=True)
