"""`siggen schema`: the JSON Schema of a configuration file."""

from __future__ import annotations

from siggen.cli.echo import echo


def schema() -> None:
    """Print the JSON Schema of a configuration, for editors that check YAML while it is written.

    `siggen init` writes it beside its file, whose first line names it. Keys that no shipped configuration sets have
    `x-expert: true`: begin without them.

    Example: siggen schema > siggen.schema.json
    """
    from siggen.config.expert_keys import schema_text

    echo(schema_text(), nl=False)
