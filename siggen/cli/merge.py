"""`siggen merge`: the parts of a set put together."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.echo import echo


def merge(
    parts: Annotated[
        list[Path], typer.Argument(help="Folders that `siggen generate --part i/N` wrote.", metavar="PART...")
    ],
    out: Annotated[
        Path,
        typer.Option("--out", help="Folder or s3://... of the set: new, empty, or begun before."),
    ],
) -> None:
    """Put the parts of a set together, every file as if it had been generated at once; the parts are only read.

    Exit codes: 0 done, 2 parts of different sets or shards that are missing, 3 done but some records failed.

    Example: siggen merge parts/1 parts/2 parts/3 --out runs/quickstart
    """
    from siggen.cli.generate import report
    from siggen.cli.run_display import run_shown
    from siggen.errors import EXIT_RECORDS_FAILED
    from siggen.sets.parts import merge as merge_parts

    with run_shown() as shown:
        generation = merge_parts(parts, out, shown.progress)
    report(generation)
    echo(str(generation.path))
    if generation.failures:
        raise typer.Exit(EXIT_RECORDS_FAILED)
