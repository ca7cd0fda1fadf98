"""`siggen schema`: the JSON Schema of a configuration file."""

from __future__ import annotations

import typer


def schema() -> None:
    """Print the JSON Schema of a configuration, for editors that check YAML while it is written.

    Example: siggen schema > siggen.schema.json
    """
    import json

    from siggen.config import Config

    draft = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    typer.echo(json.dumps(draft | Config.model_json_schema(mode="validation"), indent=2))
