"""`siggen publish`: a finished set as a folder that is ready to be uploaded."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.working import working


def publish(
    folder: Annotated[Path, typer.Argument(help="Folder or s3://... of a finished set.", metavar="DIR")],
    to: Annotated[Path, typer.Option("--to", help="New or empty folder to write.", metavar="PATH")],
    facts: Annotated[
        Path | None,
        typer.Option("--facts", help="YAML file with licence, authors, citation; without it a template is printed."),
    ] = None,
    audit: Annotated[
        Path | None, typer.Option("--audit", help="Folder of the audit to quote. Default: DIR_audit, if it is there.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Make a folder for the Hugging Face hub and Zenodo; nothing is uploaded.

    The folder holds the set's files, a card with class labels, what physics is on and where every number comes from,
    croissant.json and previews. It opens and verifies like the set.

    Exit codes: 0 done, 2 no finished set, a licence that is unset, or a folder that is not empty.

    Example: siggen publish runs/quickstart --to upload --facts publication.yaml
    """
    from siggen.errors import counted
    from siggen.publication.publish import publish as publish_set

    with working("reading the set", compiles=False):
        made = publish_set(folder, to, facts, audit)
    if as_json:
        made_now = {name: len(content) for name, content in made.texts.items()}
        audit_name = None if made.audit is None else str(made.audit)
        echo_json({"path": str(to), "copied": made.copied, "bytes": made.bytes, "made": made_now, "audit": audit_name})
        return
    echo(f"{counted(len(made.copied), 'file')} of the set, {made.bytes / 1e6:.1f} MB, unchanged", err=True)
    for name, content in made.texts.items():
        echo(f"{name}: {len(content)} bytes, made for publication", err=True)
    quoted = f"quotes {made.audit}" if made.audit else "says that there is no audit (siggen-diagnostics audit)"
    echo(f"the card {quoted}", err=True)
    echo(str(to))
