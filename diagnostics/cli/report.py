"""`siggen-diagnostics report`: features, training and figures of a set on one page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def report(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a finished set.", show_default=False)],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", metavar="DIR2", help="Folder for the report; default DIR_report.", show_default=False
        ),
    ] = None,
    cnn: Annotated[bool, typer.Option("--cnn/--no-cnn", help="Train the network too.")] = True,
    seed: Annotated[int, typer.Option(min=0, help="Seed of bootstrap, permutations and network.")] = 0,
) -> None:
    """Run everything and write report.html, metrics.json, tables, figures and models.

    Example: siggen-diagnostics report data/quickstart
    """
    from diagnostics.cli.progress import terminal_stage
    from diagnostics.report.report import write_report
    from siggen.dataset.reading import open as open_set

    dataset = open_set(directory)
    folder = out or directory.resolve().with_name(f"{directory.resolve().name}_report")
    typer.echo(str(write_report(dataset, folder, seed, cnn=cnn, stage=terminal_stage)))
