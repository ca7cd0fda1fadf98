"""`siggen schema`: the JSON Schema of a configuration file."""

from __future__ import annotations

import typer


def schema() -> None:
    """Print the JSON Schema of a configuration, for editors that check YAML while it is written.

    Keys that no shipped configuration sets have `x-expert: true`: begin without them.

    Example: siggen schema > siggen.schema.json
    """
    import json

    from siggen.config.expert_keys import schema_with_experts

    draft = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    typer.echo(json.dumps(draft | schema_with_experts(), indent=2))
