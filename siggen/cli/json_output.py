"""`--json`: what a command would print as text or tables, as one JSON object on standard output and nothing else."""

from __future__ import annotations

from typing import Annotated

import typer

from siggen.cli.echo import echo
from siggen.plain_json import plain

AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object instead of text.")]


def echo_json(content: object) -> None:
    """Print mappings, sequences, texts and numbers, numpy's too, as JSON; what is not finite becomes null."""
    import json

    echo(json.dumps(plain(content), indent=2, allow_nan=False))
