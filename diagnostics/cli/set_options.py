"""Options that several commands on sets share: classes, seeds, indicators of the user, how a page is opened."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.echo import echo

Open = Annotated[bool, typer.Option("--open", help="Open the page in your browser.")]
Seed = Annotated[int, typer.Option("--seed", min=0, help="Seed of the bootstrap, the permutations and the networks.")]
OwnIndicators = Annotated[
    list[str] | None,
    typer.Option(
        "--indicator",
        metavar="MODULE:FUNCTION",
        help="Your own indicator: function(signal, tacho, gears) -> float. May be given several times. "
        "The module is imported and its code runs with your rights: name only code that you trust.",
        show_default=False,
    ),
]


def opened(target: Path | str) -> None:
    """Open a file or an address; where there is no browser, say so and leave it at that."""
    address = target if isinstance(target, str) else target.resolve().as_uri()
    if not webbrowser.open(address):
        echo(f"note: no browser was found; open {target} yourself", err=True)
