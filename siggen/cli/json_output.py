"""`--json`: what a command would print as text or tables, as one JSON object on standard output and nothing else."""

from __future__ import annotations

from math import isfinite
from typing import Annotated, Any

import typer

from siggen.cli.echo import echo

AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object instead of text.")]


def echo_json(content: object) -> None:
    """Print mappings, sequences, texts and numbers, numpy's too, as JSON; what is not finite becomes null."""
    import json

    echo(json.dumps(_plain(content), indent=2, allow_nan=False))


def _plain(content: Any) -> Any:
    """Return the same in what JSON knows."""
    if isinstance(content, dict):
        return {str(name): _plain(value) for name, value in content.items()}
    if isinstance(content, (list, tuple)):
        return [_plain(value) for value in content]
    if hasattr(content, "tolist"):
        return _plain(content.tolist())
    return None if isinstance(content, float) and not isfinite(content) else content
