"""`siggen inspect run`: where the time of the run that finished a set went."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.json_output import AsJson, echo_json


def run_report(
    folder: Annotated[Path, typer.Argument(help="Folder or s3://... of a finished set.", metavar="DIR")],
    as_json: AsJson = False,
) -> None:
    """Print how long the run that finished a set took, and what every stage had of it.

    The facts stand in run.json beside the set. It is no part of what the manifest promises: it may be left out when a
    set is passed on. A set that was interrupted has the facts of its last run alone; --log-json has those of all.

    Exit codes: 0 done, 2 no run.json.

    Example: siggen inspect run sets/quickstart
    """
    from siggen.sets.run_report import read_run, run_text

    facts = read_run(folder)
    if as_json:
        echo_json(facts)
    else:
        typer.echo(run_text(facts))
